// What follows from a block complex about the hexahedral mesh with a given number of cells along
// each block edge.
#pragma once

#include <hexhex/samples.hpp>

#include <samples/block_complex.hpp>

namespace hexhex::samples {

/// @param cellsPerEdge  hexahedra along each block edge, at least 1
[[nodiscard]] SampleAnswer expectedAnswer(const BlockComplex& complex, std::uint64_t cellsPerEdge);

}  // namespace hexhex::samples
