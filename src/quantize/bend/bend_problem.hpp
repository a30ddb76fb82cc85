// Turns integers of arcs into integer transitions between the charts of a map's tets, the target of
// bending.
#pragma once

#include <quantize/bend/bend.hpp>
#include <quantize/integers/arc_integers.hpp>

namespace hexhex::quantization {

/// @param scale  factor of the seamless map that gives the target shapes of tets
[[nodiscard]] BendProblem bendProblem(const SeamlessMap& map, const MotorcycleComplex& complex,
                                      const BlockIntegers& integers, double scale);

}  // namespace hexhex::quantization
