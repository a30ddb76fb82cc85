// Labels of a boundary: which way each triangle is to face in a polycube.
#pragma once

#include <cstdint>
#include <vector>

#include <shape/label_search.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

/// Valid ones first, those first that deform the object less; without repetitions. At least one.
///
/// From cuts of the whole boundary with several degrees of compactness, the best go on by changes
/// in small places, each with random numbers of its own: the same for any number of threads.
[[nodiscard]] std::vector<CheckedLabels> labelsOf(const Surface& surface, std::uint64_t seed,
                                                  Stage& stage);

}  // namespace hexhex::shape
