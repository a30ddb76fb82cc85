// Changes rotations where no hexahedral mesh can follow the field.
//
// Singular curves of a frame field often merge: charts turn about a diagonal of the grid where two
// curves share an edge, or a curve of valence 3 becomes one of valence 5. Nearly always, other
// rotations across a few triangles there separate them into proper curves. A local search finds
// these rotations by simulated annealing: it changes one triangle at a time to lower a cost in edge
// lengths, and accepts changes for the worse in its first sweeps.
//
// After Y. Li, Y. Liu, W. Xu, W. Wang, B. Guo, "All-Hex Meshing Using Singularity-Restricted Field"
// (2012), and T. Jiang, J. Huang, Y. Wang, Y. Tong, H. Bao, "Frame Field Singularity Correction for
// Automatic Hexahedralization" (2014), both of which move curves by other rules.
#pragma once

#include <cstdint>

#include <shape/frames_matching.hpp>

namespace hexhex::shape {

/// @param seed  of the random numbers
void rematchFrames(FrameTets& tets, const EdgeWalks& walks, std::uint64_t seed, Stage& stage);

/// Smooths frames where rotations across triangles are no longer the closest ones. Frames at the
/// boundary and at features are fixed.
void smoothFrames(FrameTets& tets, Stage& stage);

}  // namespace hexhex::shape
