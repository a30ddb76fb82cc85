// Sets of cells that are connected: rings of cells around some, and all that moved together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <improve/improved_cells.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// Finds rings of cells and their points.
class Neighbourhoods {
 public:
  /// @param mesh  its lists must outlive this
  explicit Neighbourhoods(const CellPoints& mesh)
      : mesh_(mesh), isPoint_(mesh.pointCount, 0), isCell_(mesh.cellCount(), 0) {}

  /// The points of cells and of so many rings of cells around them, ascending: what is near in the
  /// mesh is near in memory.
  /// @param[in,out] cells  extended to all cells at these points, ascending
  [[nodiscard]] std::vector<Index> pointsOf(int rings, std::vector<Index>& cells);

 private:
  CellPoints mesh_;
  std::vector<std::uint8_t> isPoint_;  ///< found so far; 0 between calls
  std::vector<std::uint8_t> isCell_;
};

/// The positions of all points, and where on the surface they are.
struct Positions {
  Array<Vec3> points;
  Array<Index> simplices;  ///< VertexPlaces::simplex
};

/// Restores all points that moved together with those of some cells: a connected set of moved
/// points is restored as a whole.
void putBack(const CellPoints& mesh, std::span<const Index> cells, const Positions& before,
             Array<Vec3>& points, VertexPlaces& places);

}  // namespace hexhex::improvement
