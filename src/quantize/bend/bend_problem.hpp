// From integers on arcs to integers between the charts of a map's tets: the target of bending.
#pragma once

#include <quantize/bend/bend.hpp>
#include <quantize/integers/arc_integers.hpp>

namespace hexhex::quantization {

/// @param scale  of the seamless map, for the shapes that tets should keep
[[nodiscard]] BendProblem bendProblem(const SeamlessMap& map, const MotorcycleComplex& complex,
                                      const BlockIntegers& integers, double scale);

}  // namespace hexhex::quantization
