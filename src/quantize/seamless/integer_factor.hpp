// Whether a seamless map is an integer-grid map in other units.
#pragma once

#include <quantize/seamless/seamless_map.hpp>

namespace hexhex::quantization {

/// The smallest number that scales the parameters to those of an integer-grid map: the inverse of
/// the largest length of which all boundary coordinates and translations are multiples. Checked in
/// the same way as extract() checks maps.
/// @return 0 if there is none
[[nodiscard]] double integerFactor(const TetMapView& map, const SeamlessMap& seamless,
                                   Context& context);

}  // namespace hexhex::quantization
