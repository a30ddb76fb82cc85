// Labels of a boundary: which way each triangle is to face in a polycube.
#pragma once

#include <cstdint>

#include <shape/label_search.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

/// The best labels found: valid if possible, with the least deformation of the object.
///
/// Cuts the whole boundary with several degrees of compactness, then improves the best results by
/// local changes. Each search has its own random numbers, so that the result is the same for any
/// number of threads.
/// @param[in,out] workLeft  as of quantization::mapFromLabels()
[[nodiscard]] CheckedLabels labelsOf(const Surface& surface, const LabelCosts& costs,
                                     std::uint64_t seed, double& workLeft, Stage& stage);

}  // namespace hexhex::shape
