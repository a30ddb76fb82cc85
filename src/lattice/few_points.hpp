// Lattice points and cell centres in the tets of a coarse map: which of the few points of the
// bounding box are inside, by a floating-point filter with a proven bound, and by exact predicates
// where it cannot tell.
//
// A special case beside TetRasterizer. With lines alone, whole extractions of maps with 0.1 cells
// per tet take 7 % (sphere_blocks_low) to 12 % (s17c_sphere_r0.1) longer (docs/ablation.md).
#pragma once

#include <cstdint>
#include <vector>

#include <lattice/tet_rasterizer.hpp>

namespace hexhex {

/// Appends the lines of lattice points and of cell centres, the same as TetRasterizer's, if there
/// are few of either in the bounding box.
/// @param unit  a power of two, at least 2
/// @return false, and nothing is appended, if there are more, or if the tet is so far away that
///         doubles do not hold its corners
[[nodiscard]] bool sweepFewPoints(const LatticeTet& corners, std::int64_t unit,
                                  std::vector<SweptLine>& vertices,
                                  std::vector<SweptLine>& centers);

}  // namespace hexhex
