// Makes cells positive: moves points around uncertified cells until there are none.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <hexhex/types.hpp>

#include <improve/improved_cells.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// The operations that differ between straight and curved cells.
struct UntanglingMoves {
  /// Moves each point once; untagged ones may leave the surface by up to `slack`.
  std::function<void(std::span<const Index> points, double slack)> sweep;
  /// The cells of a list that are not certified.
  std::function<std::vector<Index>(std::span<const Index> cells)> badAmong;
};

/// Finds rings of cells and their points.
class Neighbourhoods {
 public:
  /// @param mesh  its lists must outlive this
  explicit Neighbourhoods(const CellPoints& mesh)
      : mesh_(mesh), isPoint_(mesh.pointCount, 0), isCell_(mesh.cellCount(), 0) {}

  /// The points of cells and of so many rings of cells around them, each once.
  /// @param[in,out] cells  extended to all cells at these points
  [[nodiscard]] std::vector<Index> pointsOf(int rings, std::vector<Index>& cells);

 private:
  CellPoints mesh_;
  std::vector<std::uint8_t> isPoint_;  ///< found so far; 0 between calls
  std::vector<std::uint8_t> isCell_;
};

/// @param bad    cells that are not certified
/// @param slack  maximum distance by which untagged points may leave the surface, as a last resort
/// @return cells that are still not certified
[[nodiscard]] std::vector<Index> untangleCells(Neighbourhoods& near, const VertexPlaces& places,
                                               const UntanglingMoves& moves, double slack,
                                               std::vector<Index> bad);

/// Restores all points that moved together with those of some cells: a connected set of moved
/// points is restored as a whole.
/// @param before, placesBefore  of all points
void putBack(const CellPoints& mesh, std::span<const Index> cells, const Array<Vec3>& before,
             const Array<Index>& placesBefore, Array<Vec3>& points, VertexPlaces& places);

}  // namespace hexhex::improvement
