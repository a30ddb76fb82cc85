// Planes and lines of a seamless map that noise alone keeps apart, as symmetric objects have them.
#pragma once

#include <span>
#include <vector>

#include <quantize/seamless/seamless_conditions.hpp>

namespace hexhex::quantization {

/// Equations for what is fixed at nearly the same coordinate of the common charts: as symmetric
/// objects have it.
/// @param extent  of coordinates in all charts; as noise, and values, on the lattice
/// @return none if all of them are the same
[[nodiscard]] std::vector<IntegerForm> coincidences(const CutGraph& graph,
                                                    const SharedUnknowns& unknowns,
                                                    const std::vector<VertexConditions>& conditions,
                                                    std::span<const std::int64_t> values,
                                                    double noise, double extent);

}  // namespace hexhex::quantization
