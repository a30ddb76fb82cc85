// The points of two grids in a tet: in boxes of few points, which of them are inside, in floating
// point with a proven bound, and exactly where that leaves it open. That is all that most tets of a
// coarse map take. In other boxes, lines.
#pragma once

#include <cstdint>
#include <vector>

#include <lattice/half_box.hpp>
#include <lattice/line_rasterizer.hpp>

namespace hexhex {

/// The grids of hex vertices, and of the centres of cells.
inline constexpr HalfGrid kVertexGrid = 0;
inline constexpr HalfGrid kCenterGrid = 7;

/// Appends the lines of both grids.
/// @param unit  a power of two, at least 2
void sweepBothGrids(const LatticeTet& corners, std::int64_t unit, std::vector<SweptLine>& vertices,
                    std::vector<SweptLine>& centers);

}  // namespace hexhex
