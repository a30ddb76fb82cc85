// Cells that the picture of a chart does not show whole.
#pragma once

#include <cstdint>
#include <span>

#include <atlas/brick_grid.hpp>
#include <atlas/charts.hpp>

#include <hexhex/types.hpp>

#include <map/prepare.hpp>

namespace hexhex {

/// A face that is not glued may meet the open interior of a cell.
struct Crossing {
  HalfFace halfFace;    ///< as seen from the chart
  std::uint16_t place;  ///< of the cell in its brick
};

/// All crossings, by brick, then place.
struct Crossings {
  Array<Crossing> list;
  std::uint64_t cutFaces = 0;

  template <class Id>
  [[nodiscard]] std::span<const Crossing> of(const Brick<Id>& brick) const noexcept {
    return std::span(list).subspan(brick.crossingBegin, brick.crossingEnd - brick.crossingBegin);
  }
};

/// Marks, on both sides of every face that is not glued, the cells whose open interior the face may
/// meet. (Cells without a brick need no mark: they are found irregular without.) Faces of the
/// boundary lie in grid planes and meet no open cell.
template <class Id>
[[nodiscard]] Crossings markCutCells(const PreparedMap& map, const Charts& charts,
                                     BrickGrid<Id>& grid, Stage& stage);

}  // namespace hexhex
