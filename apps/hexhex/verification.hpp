// What happens to a mesh that fails its verification.
#pragma once

#include <string_view>

#include <hexhex/verify.hpp>

namespace hexhex::command {

/// Throws VerificationFailed, naming what does not agree, unless all checks passed.
/// @param problem  begins the sentence: what happened
/// @param advice   ends it: what to do
void requirePassed(const VerifyReport& report, std::string_view problem, std::string_view advice);

}  // namespace hexhex::command
