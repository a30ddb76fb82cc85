// Moves one vertex at a time, within what its place allows, for the better of the cells around it.
#pragma once

#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <improve/cell_points.hpp>
#include <improve/chord_error.hpp>
#include <improve/curved_cells.hpp>
#include <improve/point_mover.hpp>
#include <improve/vertex_energy.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// What movers work on; all of it outlives them.
struct MovingMesh {
  HexMesh& mesh;                 ///< whose points move
  const CurvedCells* curved;     ///< in place of its cells, or null
  const CellPoints& cells;       ///< of one or the other
  const Array<IdealBox>& boxes;  ///< per cell
  VertexPlaces& places;
  const ChordError& chordError;
  Array<double>& qualities;  ///< per cell: certifiedQuality(), while vertices are smoothed
};

/// What cells give so that others around the same vertex gain.
struct Exchange {
  double floor;             ///< cells below it gain
  bool belowFloor = false;  ///< whether others may fall below it, too
  /// So many times what those below the floor gain may those above it lose; 0: as much as it takes.
  double price = 0;
};

/// A vertex with all that a step of it takes. One per thread.
class VertexMover {
 public:
  /// Vertices of one cell must not move at the same time.
  /// @param slack  so far may vertices leave patches and curves without tags
  VertexMover(const MovingMesh& all, double slack)
      : all_(all), mover_(all.mesh.points, all.places, slack) {}

  /// Brings all Bezier coefficients of the cells nearer to being positive.
  /// @return the share of the cells' size that it moved by
  double untangle(Index vertex);

  /// Lowers the energy at corners, if all cells around are certified and stay so. No scaled
  /// Jacobian that is not below the floor falls below it, unless that is said, and none below the
  /// least around; nor does the boundary leave the surface.
  /// @param power  of EnergyKind
  /// @return as untangle()
  double smooth(Index vertex, int power, const Exchange& exchange);

  /// Moves a vertex of the boundary towards a place where it was, if the cells around stay as good
  /// as smooth() would leave them.
  void moveBack(Index vertex, const SurfacePlace& place, double floor);

 private:
  void collect(Index vertex, bool bezier);
  [[nodiscard]] MovingCell straightCell(Index vertex, Index cell) const;
  [[nodiscard]] double leastQualityAt(Index vertex) const;
  void keepMeasured();
  /// Takes the qualities of the cells around a vertex that has moved.
  /// @param least  scaled Jacobian that was around
  /// @return whether they are as good as they must be
  bool isGoodAround(Index vertex, double least, const Exchange& exchange);
  [[nodiscard]] double sizeAt(Index vertex) const;

  MovingMesh all_;
  PointMover mover_;
  EnergyTerms terms_;
  std::vector<MovingCell> straight_;
  std::vector<std::pair<Index, double>> measured_;  ///< by measureAround(): cells, qualities
  CurvedCells::Scratch scratch_;
};

}  // namespace hexhex::improvement
