// A bent map as the caller gets it: with features and regions of the map that it came from, and
// checked.
#pragma once

#include <vector>

#include <quantize/integer_search.hpp>

#include <hexhex/quantize.hpp>

namespace hexhex::quantization {

[[nodiscard]] MapDistortion distortionOf(const std::vector<Vec3>& points,
                                         const std::vector<Tet>& tets,
                                         const std::vector<TetParameters>& parameters);

/// @param given  whose features and regions come along
/// @throws Error Internal if the map does not pass the exact check, or has other singular edges
[[nodiscard]] QuantizedMap finishQuantization(FoundMap found, const TetMapView& given,
                                              Context& context);

}  // namespace hexhex::quantization
