// Changes matchings where a hexahedral mesh cannot follow the field.
//
// Singular curves of a field of frames come in bundles: charts turn about a diagonal of the grid,
// where two curves run in one edge, or a curve of valence 3 becomes one of valence 5. Nearly
// always, other rotations across a few triangles near there make proper curves of them. A local
// search finds these: it changes one triangle at a time, lowers a cost in lengths of edges, and
// takes changes for the worse in its first sweeps.
//
// After Y. Li, Y. Liu, W. Xu, W. Wang, B. Guo, "All-Hex Meshing Using Singularity-Restricted
// Field", and T. Jiang, J. Huang, Y. Wang, Y. Tong, H. Bao, "Frame Field Singularity Correction
// for Automatic Hexahedralization", both of which move curves by other rules.
#pragma once

#include <cstdint>

#include <shape/frames_matching.hpp>

namespace hexhex::shape {

/// @param seed  of its random numbers
void rematchFrames(FrameTets& tets, const EdgeWalks& walks, std::uint64_t seed, Stage& stage);

/// Makes frames smooth again where rotations across triangles are not the nearest ones any more.
/// Those of the boundary and of features stay.
void smoothFrames(FrameTets& tets, Stage& stage);

}  // namespace hexhex::shape
