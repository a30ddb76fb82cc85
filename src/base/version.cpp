#include <hexhex/version.hpp>

namespace hexhex {

const char* version() noexcept { return HEXHEX_VERSION; }

}  // namespace hexhex
