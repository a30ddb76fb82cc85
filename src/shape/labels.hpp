// Searches for polycube labels of a boundary.
#pragma once

#include <cstdint>

#include <shape/label_search.hpp>

#include <base/stage.hpp>

namespace hexhex::shape {

/// The best labels found: valid if possible, with little distortion of the object.
///
/// Labels the whole boundary by cuts with several degrees of compactness, then improves the best
/// results by local changes. Each search has its own random numbers, so the result is the same for
/// any number of threads.
/// @param[in,out] workLeft  as in quantization::mapFromLabels()
[[nodiscard]] CheckedLabels labelsOf(const Surface& surface, const LabelCosts& costs,
                                     std::uint64_t seed, double& workLeft, Stage& stage);

}  // namespace hexhex::shape
