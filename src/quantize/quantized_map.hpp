// A bent map as the caller gets it: with features and regions of the map that it came from, and
// checked.
#pragma once

#include <quantize/bend.hpp>
#include <quantize/seamless_map.hpp>

#include <hexhex/quantize.hpp>

namespace hexhex {

/// @param seamless  what was bent; it is used up, as checks need its memory
/// @param given  whose features and regions come along
/// @param report  as far as it is known
/// @throws Error Internal if the map does not pass the exact check, or has other singular edges
[[nodiscard]] QuantizedMap finishQuantization(SeamlessMap seamless, const TetMapView& given,
                                              BentMap bent, const QuantizeReport& report,
                                              Context& context);

}  // namespace hexhex
