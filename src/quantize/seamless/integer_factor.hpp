// Recognizes integer-grid maps with scaled parameters.
#pragma once

#include <quantize/seamless/seamless_map.hpp>

namespace hexhex::quantization {

/// The smallest factor that makes the map an integer-grid map: the inverse of the largest length of
/// which all boundary coordinates and translations are multiples. Validated in the same way as
/// extract() validates maps.
/// @return 0 if there is none
[[nodiscard]] double integerFactor(const TetMapView& map, const SeamlessMap& seamless,
                                   Context& context);

}  // namespace hexhex::quantization
