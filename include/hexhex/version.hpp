// Version of the library. HEXHEX_VERSION in version.h is the version of the headers.
#pragma once

#include <hexhex/export.h>
#include <hexhex/version.h>  // IWYU pragma: export

namespace hexhex HEXHEX_API_NAMESPACE {

/// Version of the library at run time, which should match HEXHEX_VERSION of the headers.
/// Thread-safe.
[[nodiscard]] const char* version() noexcept;

}  // namespace HEXHEX_API_NAMESPACE
