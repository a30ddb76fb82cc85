// Labels of a boundary: which way each triangle is to face in a polycube.
#pragma once

#include <cstdint>

#include <shape/label_search.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

/// The best that are found: valid ones, if there are any, that deform the object the least.
///
/// From cuts of the whole boundary with several degrees of compactness, the best go on by changes
/// in small places, each with random numbers of its own: the same for any number of threads.
/// @param[in,out] workLeft  as of quantization::mapFromLabels()
[[nodiscard]] CheckedLabels labelsOf(const Surface& surface, const LabelCosts& costs,
                                     std::uint64_t seed, double& workLeft, Stage& stage);

}  // namespace hexhex::shape
