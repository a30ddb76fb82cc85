// Tets with few grid points in their bounding boxes: which of them are inside, in floating point
// with a proven bound, and exactly where that leaves it open. That is all that most tets of a
// coarse map take.
#pragma once

#include <cstdint>
#include <vector>

#include <lattice/half_box.hpp>
#include <lattice/line_rasterizer.hpp>

namespace hexhex {

/// The grids of hex vertices, and of the centres of cells.
inline constexpr HalfGrid kVertexGrid = 0;
inline constexpr HalfGrid kCenterGrid = 7;

/// Appends the lines of both grids, as LineRasterizer has them, if there are few points of a grid
/// in the bounding box.
/// @param unit  a power of two
/// @return the grids for which it did nothing, as there may be more
[[nodiscard]] HalfGridSet appendFromSmallBoxes(const LatticeTet& corners, std::int64_t unit,
                                               std::vector<SweptLine>& vertices,
                                               std::vector<SweptLine>& centers);

}  // namespace hexhex
