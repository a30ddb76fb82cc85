// Makes cells positive: around those that are not, points move until there are none.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <hexhex/types.hpp>

#include <improve/curved_cells.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// What one kind of cells does with points.
struct UntanglingMoves {
  /// Moves points once; each of them may leave the surface by `slack` unless it is tagged.
  std::function<void(std::span<const Index> points, double slack)> sweep;
  /// Those cells of a list that are not certified.
  std::function<std::vector<Index>(std::span<const Index> cells)> badAmong;
};

/// What is near some cells.
class Neighbourhoods {
 public:
  /// @param mesh  outlives this
  explicit Neighbourhoods(const CellPoints& mesh)
      : mesh_(mesh), isPoint_(mesh.pointCount, 0), isCell_(mesh.cellCount(), 0) {}

  /// The points of cells, of cells at those, and so on; each once.
  /// @param[in,out] cells  become those around the points
  [[nodiscard]] std::vector<Index> pointsOf(int rings, std::vector<Index>& cells);

 private:
  CellPoints mesh_;
  std::vector<std::uint8_t> isPoint_;  ///< found so far; 0 between calls
  std::vector<std::uint8_t> isCell_;
};

/// @param bad    cells that are not certified
/// @param slack  so far may points without tags leave the surface if nothing else helps
/// @return cells that are not certified in the end
[[nodiscard]] std::vector<Index> untangleCells(Neighbourhoods& near, const VertexPlaces& places,
                                               const UntanglingMoves& moves, double slack,
                                               std::vector<Index> bad);

/// Puts back all points that moved together with those of some cells.
/// @param before, placesBefore  of all points
void putBack(const CellPoints& mesh, std::span<const Index> cells, const Array<Vec3>& before,
             const Array<Index>& placesBefore, Array<Vec3>& points, VertexPlaces& places);

}  // namespace hexhex::improvement
