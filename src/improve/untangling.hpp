// Makes cells positive: around those that are not, points move until there are none.
#pragma once

#include <functional>
#include <vector>

#include <hexhex/types.hpp>

#include <improve/cell_points.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex {

/// What one kind of cells does with points.
struct UntanglingMoves {
  /// Moves points once; each of them may leave the surface by `slack` unless it is tagged.
  std::function<void(std::span<const Index> points, double slack)> sweep;
  /// Those cells of a list that are not certified.
  std::function<std::vector<Index>(std::span<const Index> cells)> badAmong;
};

/// Sorted, each once.
void makeUnique(std::vector<Index>& list);

/// The points of cells, of cells at those, and so on.
/// @param[in,out] cells  become those around the points
[[nodiscard]] std::vector<Index> pointsOf(const CellPoints& mesh, int rings,
                                          std::vector<Index>& cells);

/// @param bad    cells that are not certified
/// @param slack  so far may points without tags leave the surface if nothing else helps
/// @return cells that are not certified in the end
[[nodiscard]] std::vector<Index> untangleCells(const CellPoints& mesh, const VertexPlaces& places,
                                               const UntanglingMoves& moves, double slack,
                                               std::vector<Index> bad);

/// Puts back all points that moved together with those of some cells.
/// @param before, placesBefore  of all points
void putBack(const CellPoints& mesh, std::span<const Index> cells, const Array<Vec3>& before,
             const Array<Index>& placesBefore, Array<Vec3>& points, VertexPlaces& places);

}  // namespace hexhex
