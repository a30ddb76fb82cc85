// A bent map as the caller gets it: with features and regions of the map that it came from, and
// checked.
#pragma once

#include <quantize/search.hpp>

#include <hexhex/quantize.hpp>

namespace hexhex::quantization {

/// @param given  whose features and regions come along
/// @throws Error Internal if the map does not pass the exact check, or has other singular edges
[[nodiscard]] QuantizedMap finishQuantization(FoundMap found, const TetMapView& given,
                                              Context& context);

}  // namespace hexhex::quantization
