// Moves vertices one at a time, within the limits of their places and of the distance between
// boundary and surface.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
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

// Moves one point at a time downhill, within the limits of its place.

class PointMover {
 public:
  /// @param points, places  of the same points; both must outlive this
  /// @param slack  maximum distance by which points may leave untagged patches and curves
  PointMover(Array<Vec3>& points, VertexPlaces& places, double slack)
      : points_(points), places_(places), slack_(slack) {}

  [[nodiscard]] bool canMove(Index point) const { return places_.freedom[point] != Freedom::Fixed; }

  /// The energy that makes determinants positive, for terms of Bezier coefficients.
  [[nodiscard]] static EnergyKind untangling(const EnergyTerms& terms);

  /// Takes a step of Newton's method, halved until it lowers the energy.
  /// @param terms       at the current point
  /// @param isAccepted  called after the point has moved; if it returns false, a shorter step is
  ///         tried
  /// @return the distance moved
  template <class Accept>
  double descend(Index point, const EnergyTerms& terms, const EnergyKind& kind,
                 const Accept& isAccepted) {
    assert(canMove(point));
    std::array<Vec3, 3> directions;
    const std::size_t count = directionsAt(point, directions);
    const EnergySlope slope = slopeOf(terms, kind);
    const Vec3 direction = newtonStep(slope, std::span(directions).first(count));
    const double promised = dot(slope.gradient, direction);
    if (!(promised < -kLeastPromise * slope.energy)) return 0;
    const SurfacePlace old{points_[point], places_.simplex[point]};
    double share = kind.power > 2 ? 1 : kOverrelaxation;
    for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
      const Step step = stepBy(point, direction, share);
      take(point, step.place);
      const double enough = slope.energy + kDecrease * share * promised;
      if (isAccepted() && energyAt(terms, kind, step.moved) <= enough) return step.length;
      take(point, old);
    }
    return 0;
  }

  /// Moves a point to a place, or part of the way: along the surface, or straight if it is off the
  /// surface and `isPulled` onto it.
  /// @param isAccepted  as for descend()
  template <class Accept>
  bool moveTo(Index point, const SurfacePlace& target, bool isPulled, const Accept& isAccepted) {
    const SurfacePlace old{points_[point], places_.simplex[point]};
    take(point, target);
    if (isAccepted()) return true;
    const Vec3 way = minus(target.point, old.point);
    for (double share = 0.5; share > 0.1; share *= 0.5) {
      take(point, old);
      take(point, isPulled ? SurfacePlace{plus(old.point, times(share, way)), target.simplex}
                           : stepBy(point, way, share).place);
      if (isAccepted()) return true;
    }
    take(point, old);
    return false;
  }

 private:
  /// First fraction of Newton's step to try for low powers. As neighbours follow, sweeps converge
  /// much faster with more than one (successive overrelaxation).
  static constexpr double kOverrelaxation = 1.6;
  /// Maximum number of trials, each half as long as the one before.
  static constexpr int kHalvings = 8;
  /// Required fraction of the decrease that the slope predicts.
  static constexpr double kDecrease = 1e-4;
  /// Steps with a smaller predicted decrease, relative to the energy, are not worth their time.
  static constexpr double kLeastPromise = 1e-7;

  struct Step {
    SurfacePlace place;
    Vec3 moved{};  ///< the displacement
    double length = 0;
  };
  [[nodiscard]] bool hasSlack(Index point) const;
  [[nodiscard]] std::size_t directionsAt(Index point, std::array<Vec3, 3>& directions) const;
  [[nodiscard]] Step stepBy(Index point, const Vec3& direction, double share) const;
  void take(Index point, const SurfacePlace& place);

  Array<Vec3>& points_;
  VertexPlaces& places_;
  double slack_;
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
      : all_(all), points_(all.cells.points()), mover_(all.mesh.points, all.places, slack) {
    assert(all.boxes.size() == points_.cellCount());
    assert(all.qualities.size() == points_.cellCount());
  }

  /// Takes a step towards positive Bezier coefficients of all cells around a vertex.
  /// @return the distance moved, relative to the size of the cells
  double untangle(Index vertex);

  /// Lowers the energy at corners if all cells around are certified; they remain so. No scaled
  /// Jacobian falls below the floor (unless `exchange` allows that) or, if already below it, below
  /// the least around the vertex; nor does the boundary leave the surface.
  /// @param power  EnergyKind::power
  /// @return as for untangle()
  double smooth(Index vertex, int power, const Exchange& exchange);

  /// Moves a boundary vertex towards a place like PointMover::moveTo(), as far as the bounds of
  /// smooth() allow.
  /// @param farthest  maximum distance of the quads around it from the surface
  void moveTo(Index vertex, const SurfacePlace& place, bool isPulled, double floor,
              double farthest = std::numeric_limits<double>::infinity());

  /// Maximum distance of quads at a vertex from the surface: ChordError::chord, or their
  /// current distance if that is larger.
  [[nodiscard]] double farthestAt(Index vertex) const;

 private:
  void collect(Index vertex, bool bezier);
  [[nodiscard]] double leastQualityAt(Index vertex) const;
  void keepMeasured();
  /// Measures the cells around a vertex that has moved.
  /// @param least  least quality around it before
  /// @return whether they are good enough
  bool isGoodAround(Index vertex, double least, const Exchange& exchange);
  [[nodiscard]] double sizeAt(Index vertex) const;

  MovingMesh all_;
  CellPoints points_;
  PointMover mover_;
  EnergyTerms terms_;
  std::vector<std::pair<Index, double>> measured_;  ///< by isGoodAround(): cells, qualities
  ImprovedCells::Scratch scratch_;
};

}  // namespace hexhex::improvement
