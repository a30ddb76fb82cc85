// Removes unnecessary walls of a motorcycle complex.
#pragma once

#include <quantize/complex/motorcycle_complex.hpp>

namespace hexhex::quantization {

/// Removes walls between two blocks that together are one box: arcs that nothing needs would only
/// demand hexahedra (the reduced complex of Brückler et al.). Thin blocks go first, and no block
/// twice; afterwards blocks, arcs and patches must be found again.
/// @return whether any wall was removed
bool removeNeedlessWalls(MotorcycleComplex& complex);

}  // namespace hexhex::quantization
