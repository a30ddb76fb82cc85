// Planes and lines of a seamless map that only noise separates, as in symmetric objects.
#pragma once

#include <span>
#include <vector>

#include <quantize/seamless/seamless_conditions.hpp>

namespace hexhex::quantization {

/// Equations for coordinates fixed at nearly the same value of the common charts, as in symmetric
/// objects.
/// @param extent  of coordinates in all charts; on the lattice, like noise and values
/// @return none if all of them are the same
[[nodiscard]] std::vector<IntegerForm> coincidences(const CutGraph& graph,
                                                    const SharedUnknowns& unknowns,
                                                    const std::vector<VertexConditions>& conditions,
                                                    std::span<const std::int64_t> values,
                                                    double noise, double extent);

}  // namespace hexhex::quantization
