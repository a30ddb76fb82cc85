// What faces that cut a cell hide of it. Floating point with proven bounds: the answers err on the
// side of "hidden", which costs time only.
#pragma once

#include <cstdint>
#include <span>

#include <atlas/charts.hpp>
#include <atlas/cut_marks.hpp>

#include <map/prepare.hpp>

namespace hexhex {

/// A set of corners of a cell, in VTK order: bit i for corner i.
using CellCornerSet = unsigned;

/// A cell seen from the chart of a tet.
struct SeenCell {
  Index tet;
  ChartPoint smallest;  ///< its smallest corner in the chart of the atlas
  std::span<const Crossing> crossings;
};

/// The corners behind those diagonals (from the cell's centre) that may meet one of the faces: the
/// picture shows the others. Corners are named in the order of the tet's own chart.
[[nodiscard]] CellCornerSet crossedDiagonals(const PreparedMap& map, const Charts& charts,
                                             const SeenCell& cell) noexcept;

/// Whether, for each of the faces, the corners certainly lie strictly on one side of its plane:
/// then no face comes between them.
/// @param corners  in the order of the tet's own chart
[[nodiscard]] bool areTogether(const PreparedMap& map, const Charts& charts, const SeenCell& cell,
                               CellCornerSet corners) noexcept;

}  // namespace hexhex
