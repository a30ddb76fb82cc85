// Planes and lines of a seamless map that only noise separates, as in symmetric objects.
#pragma once

#include <span>
#include <vector>

#include <quantize/seamless/seamless_conditions.hpp>

namespace hexhex::quantization {

/// Equations for fixed coordinates that nearly coincide in the common charts.
/// @param extent  of coordinates in all charts; in lattice units, like noise and values
/// @return empty if these coordinates coincide exactly
[[nodiscard]] std::vector<IntegerForm> coincidences(const CutGraph& graph,
                                                    const SharedUnknowns& unknowns,
                                                    const std::vector<VertexConditions>& conditions,
                                                    std::span<const std::int64_t> values,
                                                    double noise, double extent);

}  // namespace hexhex::quantization
