// Moves vertices one at a time, within the limits of their places and of the distance between
// boundary and surface.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/types.hpp>

#include <base/vector3.hpp>
#include <improve/improved_cells.hpp>
#include <improve/vertex_energy.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// The distance of boundary quads from the surface between their vertices, which are on it. All
/// references must outlive this.
struct ChordError {
  const HexMesh& mesh;
  const VertexPlaces& places;
  const adjacency::VertexCells& around;
  const Array<std::uint8_t>& boundary;  ///< per cell: HexFaces::boundary
  double chord;                         ///< maximum distance, unless quads are farther already

  /// The largest distance from the surface of centres of boundary quads at a vertex, and from its
  /// curve of midpoints of edges along it.
  /// @param enough  distances up to this need not be exact
  [[nodiscard]] double at(Index vertex, double enough) const;
};

// Moves one vertex at a time to improve the cells around it.

/// The data that movers share; must outlive them.
struct MovingMesh {
  HexMesh& mesh;                 ///< its points move
  const ImprovedCells& cells;    ///< with the same points
  const Array<IdealBox>& boxes;  ///< per cell
  VertexPlaces& places;
  const ChordError& chordError;
  Array<double>& qualities;  ///< per cell: its quality; untangle() does not update it
};

/// How cells may lose quality so that others around the same vertex gain.
struct Exchange {
  double floor;             ///< cells below it are to gain
  bool belowFloor = false;  ///< whether others may fall below it
  /// Cells above the floor may lose at most this many times what those below it gain; 0: no limit.
  double price = 0;
};

/// Moves vertices and holds the scratch memory for that. One per thread.
class VertexMover {
 public:
  /// Vertices of one cell must not move at the same time.
  /// @param slack  maximum distance by which vertices may leave untagged patches and curves
  VertexMover(const MovingMesh& all, double slack)
      : all_(all), points_(all.cells.points()), slack_(slack) {
    assert(all.boxes.size() == points_.cellCount());
    assert(all.qualities.size() == points_.cellCount());
  }

  /// Takes a step towards positive Bezier coefficients of all cells around a vertex that is not
  /// Fixed.
  void untangle(Index vertex);

  /// Lowers the energy at corners if all cells around are certified; they remain so. No scaled
  /// Jacobian falls below the floor (unless `exchange` allows that) or, if already below it, below
  /// the least around the vertex; nor does the boundary leave the surface.
  /// @param kind   of corners
  /// @param power  EnergyKind::power
  /// @return the distance moved, relative to the size of the cells
  double smooth(Index vertex, TermKind kind, int power, const Exchange& exchange);

  /// Moves a vertex to a place, or part of the way, as far as the bounds of smooth() allow: along
  /// the surface, or straight if it is off the surface and `isPulled` onto it.
  /// @param farthest  maximum distance of the quads around it from the surface
  void moveTo(Index vertex, const SurfacePlace& place, bool isPulled, double floor,
              double farthest = std::numeric_limits<double>::infinity());

  /// Maximum distance of quads at a vertex from the surface: ChordError::chord, or their
  /// current distance if that is larger.
  [[nodiscard]] double farthestAt(Index vertex) const;

 private:
  struct Step {
    SurfacePlace place;
    Vec3 moved{};  ///< the displacement
  };
  [[nodiscard]] bool hasSlack(Index vertex) const;
  [[nodiscard]] std::size_t directionsAt(Index vertex, std::array<Vec3, 3>& directions) const;
  [[nodiscard]] Step stepBy(Index vertex, const Vec3& direction, double share) const;
  void take(Index vertex, const SurfacePlace& place);
  template <class Accept>
  double descend(Index vertex, const EnergyKind& kind, const Accept& isAccepted);

  void collect(Index vertex, TermKind kind);
  /// Suspects the worst cell to get worse.
  [[nodiscard]] double leastQualityAt(Index vertex);
  void keepMeasured(Index vertex);
  /// Measures the cells around a vertex that has moved: first those beside the suspect, which is
  /// then the first one that is not good enough. Half of all steps are refused because of one cell.
  /// @param least  least quality around it before
  /// @return whether they are good enough
  bool isGoodAround(Index vertex, double least, const Exchange& exchange);
  [[nodiscard]] double sizeAt(Index vertex) const;

  MovingMesh all_;
  CellPoints points_;
  double slack_;
  EnergyTerms terms_;
  std::vector<double> measured_;  ///< per cell around the vertex: by isGoodAround()
  std::size_t suspect_ = 0;       ///< among these cells
  ImprovedCells::Scratch scratch_;
};

}  // namespace hexhex::improvement
