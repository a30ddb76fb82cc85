// Cells that the picture of a chart does not show whole.
#pragma once

#include <cstdint>

#include <hexhex/types.hpp>

#include <atlas/brick_grid.hpp>
#include <atlas/charts.hpp>
#include <atlas/jumps.hpp>
#include <igm/prepare.hpp>

namespace hexhex {

/// The faces that are not glued.
struct Cuts {
  std::uint64_t faces = 0;
  Jumps jumps;
};

/// Marks, on both sides of every face that is not glued, the cells in which the face may meet the
/// way from the centre to a corner. Faces of the boundary lie in grid planes and meet no such way.
/// @param onlyJumps  whether tets that no jump separates are known to share chart and gauge
template <class Id>
[[nodiscard]] Cuts markCutCells(const PreparedMap& map, const Charts& charts, bool onlyJumps,
                                BrickGrid<Id>& grid, Stage& stage);

}  // namespace hexhex
