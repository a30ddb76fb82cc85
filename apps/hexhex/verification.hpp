// What happens to a mesh that fails its verification.
#pragma once

#include <string_view>

#include <hexhex/extract.hpp>
#include <hexhex/verify.hpp>

namespace hexhex::command {

/// Throws VerificationFailed, naming what does not agree, unless all checks passed.
/// @param problem  begins the sentence: what happened
/// @param advice   ends it: what to do
void requirePassed(const VerifyReport& report, std::string_view problem, std::string_view advice);

/// The map that an extraction took: the caller's, or what a repair made of it.
[[nodiscard]] inline TetMapView extractedMap(const TetMapView& map,
                                             const ExtractStatistics& statistics) {
  return statistics.repairedMap ? TetMapView(*statistics.repairedMap) : map;
}

}  // namespace hexhex::command
