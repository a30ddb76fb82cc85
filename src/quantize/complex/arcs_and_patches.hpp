// The arcs and patches of a motorcycle complex: rectangles where two blocks touch, and their edges.
#pragma once

#include <vector>

#include <quantize/complex/motorcycle_complex.hpp>

namespace hexhex::quantization {

/// Computes arcs, patches and feature corners, given walls and the charts of blocks.
void findArcsAndPatches(MotorcycleComplex& complex);

/// Per vertex of the complex's mesh: whether it is a node, where arcs end.
[[nodiscard]] std::vector<bool> findNodes(MotorcycleComplex& complex);

}  // namespace hexhex::quantization
