// The version of the library. That of the headers is HEXHEX_VERSION, in version.h.
#pragma once

#include <hexhex/export.h>
#include <hexhex/version.h>  // IWYU pragma: export

namespace hexhex HEXHEX_API_NAMESPACE {

/// The version of the library that runs, which HEXHEX_VERSION of the headers should agree with.
/// Thread-safe.
[[nodiscard]] const char* version() noexcept;

}  // namespace HEXHEX_API_NAMESPACE
