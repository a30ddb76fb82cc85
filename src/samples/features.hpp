// Sharp curves, corners and smooth patches of a block complex: tags for the tets of a sample, and
// how many elements of the mesh they must tag.
#pragma once

#include <hexhex/samples.hpp>

#include <samples/block_complex.hpp>
#include <samples/tet_grid.hpp>

namespace hexhex::samples {

/// Tags corners, curves and patches, and numbers the blocks as regions, as SampleOptions::features
/// says.
/// @param[out] map  with the tets of `grid` in order
void addFeatures(const TetGrid& grid, const BlockComplex& complex, TetMap& map);

/// @param cellsPerEdge  hexahedra along each block edge, at least 1
[[nodiscard]] FeatureAnswer expectedFeatures(const BlockComplex& complex,
                                             std::uint64_t cellsPerEdge);

}  // namespace hexhex::samples
