// What separates the blocks of a motorcycle complex: rectangles where two blocks touch, and the
// edges and corners of these.
#pragma once

#include <vector>

#include <quantize/complex/motorcycle_complex.hpp>

namespace hexhex::quantization {

/// Fills in arcs, patches and corners on features, given walls and the charts of blocks.
void findArcsAndPatches(MotorcycleComplex& complex);

/// Per vertex of the complex's mesh: whether arcs end there.
[[nodiscard]] std::vector<bool> findNodes(MotorcycleComplex& complex);

}  // namespace hexhex::quantization
