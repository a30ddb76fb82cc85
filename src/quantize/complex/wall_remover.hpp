// Removes unnecessary walls of a motorcycle complex (Brückler et al. 2022: the reduced complex).
#pragma once

#include <quantize/complex/motorcycle_complex.hpp>

namespace hexhex::quantization {

/// Removes walls between two blocks that together are one box, as needless arcs demand hexahedra.
/// Thin blocks come first, and each block at most once; afterwards blocks, arcs and patches must be
/// recomputed.
/// @return whether any wall was removed
bool removeNeedlessWalls(MotorcycleComplex& complex);

}  // namespace hexhex::quantization
