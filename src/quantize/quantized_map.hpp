// Turns a bent map into the result of quantization: carries features and regions over from the
// input, and validates it.
#pragma once

#include <vector>

#include <quantize/integer_search.hpp>

#include <hexhex/quantize.hpp>

namespace hexhex::quantization {

[[nodiscard]] MapDistortion distortionOf(const std::vector<Vec3>& points,
                                         const std::vector<Tet>& tets,
                                         const std::vector<TetParameters>& parameters);

/// @param given  the input, with features and regions
/// @throws Error Internal if the map fails the exact check, or its singular edges have changed
[[nodiscard]] QuantizedMap finishQuantization(FoundMap found, const TetMapView& given,
                                              Context& context);

}  // namespace hexhex::quantization
