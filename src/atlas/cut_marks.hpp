// Cells that the picture of a chart does not show whole.
#pragma once

#include <cstdint>

#include <atlas/brick_grid.hpp>
#include <atlas/charts.hpp>

#include <hexhex/types.hpp>

#include <map/prepare.hpp>

namespace hexhex {

/// Marks, on both sides of every face that is not glued, the cells whose open interior the face may
/// meet. (Cells without a brick need no mark: they are found irregular without.) Faces of the
/// boundary lie in grid planes and meet no open cell.
/// @param asBuilt  whether the charts are still those of buildCharts(), where tets that no jump
///                 separates share a chart
/// @return the number of cut faces
template <class Id>
std::uint64_t markCutCells(const PreparedMap& map, const Charts& charts, bool asBuilt,
                           BrickGrid<Id>& grid, Stage& stage);

}  // namespace hexhex
