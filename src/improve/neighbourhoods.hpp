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
      : mesh_(mesh), isPoint_(mesh.pointCount), isCell_(mesh.cellCount()) {}

  /// The points of cells and of so many rings of cells around them, ascending: what is near in the
  /// mesh is near in memory.
  /// @param[in,out] cells  extended to all cells at these points, ascending
  [[nodiscard]] std::vector<Index> pointsOf(int rings, std::vector<Index>& cells);

 private:
  CellPoints mesh_;
  std::vector<bool> isPoint_;  ///< found so far; none between calls
  std::vector<bool> isCell_;
};

/// The positions of all points, and where on the surface they are.
struct Positions {
  Positions(const Array<Vec3>& points, const VertexPlaces& places);

  /// Whether these are still the present ones.
  [[nodiscard]] bool arePresent(const Array<Vec3>& now, const VertexPlaces& places) const;
  [[nodiscard]] SurfacePlace placeOf(Index vertex) const;
  /// @param simplex  for a vertex that has one
  void setSimplex(Index vertex, Index simplex);
  void restore(Index vertex, Array<Vec3>& now, VertexPlaces& places) const;
  void restoreAll(Array<Vec3>& now, VertexPlaces& places) const;

  struct OnSurface {
    Index vertex;
    Index simplex;  ///< VertexPlaces::simplex
  };
  Array<Vec3> points;
  /// Vertices with a simplex, ascending. They are few; no other vertex ever gets one.
  std::vector<OnSurface> onSurface;
};

/// Restores all points that moved together with those of some cells: a connected set of moved
/// points is restored as a whole.
void putBack(const CellPoints& mesh, std::span<const Index> cells, const Positions& before,
             Array<Vec3>& points, VertexPlaces& places);

}  // namespace hexhex::improvement
