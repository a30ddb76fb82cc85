// Walls of a motorcycle complex that nothing needs.
#pragma once

#include <quantize/complex/motorcycle_complex.hpp>

namespace hexhex::quantization {

/// Takes away walls between two blocks that are one box without it: arcs that nothing needs would
/// only demand hexahedra (the reduced complex of Brueckner et al.). Thin blocks go first, and no
/// block twice: what is to be found anew then are blocks, arcs and patches.
/// @return whether there were any
bool removeNeedlessWalls(MotorcycleComplex& complex);

}  // namespace hexhex::quantization
