// How far boundary quads are from the surface between their vertices, which are on it.
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
#include <improve/curved_cells.hpp>
#include <improve/vertex_energy.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

/// All of it outlives this.
struct ChordError {
  const HexMesh& mesh;
  const VertexPlaces& places;
  const adjacency::VertexCells& around;
  const Array<std::uint8_t>& boundary;  ///< per cell: as of HexFaces
  double chord;  ///< so far may quads be from the surface, if they are not farther anyway

  /// The largest distance of centres of boundary quads at a vertex, and of edges on its curve.
  /// @param enough  where it is no larger, any number up to this
  [[nodiscard]] double at(Index vertex, double enough) const;
};

// Moves one point at a time down an energy, within what its place allows.

class PointMover {
 public:
  /// @param points, places  of the same points; both outlive this
  /// @param slack  so far may points leave patches and curves without tags
  PointMover(Array<Vec3>& points, VertexPlaces& places, double slack)
      : points_(points), places_(places), slack_(slack) {}

  [[nodiscard]] bool canMove(Index point) const { return places_.freedom[point] != Freedom::Fixed; }

  /// The energy that makes determinants positive: of terms by Bezier coefficients.
  [[nodiscard]] static EnergyKind untangling(const EnergyTerms& terms);

  /// Takes one step of Newton's method, or a part of it that lowers the energy.
  /// @param terms       where the point is
  /// @param isAccepted  called when the point has moved; if false, a shorter step is tried
  /// @return how far it moved
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
      const double energy = energyAt(terms, kind, step.moved);
      if (!(energy <= slope.energy + kDecrease * share * promised)) continue;
      take(point, step.place);
      if (isAccepted()) return step.length;
      take(point, old);
    }
    return 0;
  }

  /// Moves a point to a place, or a part of the way: along the surface or, if it is off it and is
  /// to be pulled there, straight.
  /// @param isAccepted  as above
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
  /// The first share of Newton's step that is tried with low powers. As neighbours follow, sweeps
  /// get far sooner with more than one (successive overrelaxation).
  static constexpr double kOverrelaxation = 1.6;
  /// Halvings of a step until it is given up.
  static constexpr int kHalvings = 8;
  /// Share of the decrease that the slope promises.
  static constexpr double kDecrease = 1e-4;
  /// Steps that promise a smaller share of the energy are not worth their time.
  static constexpr double kLeastPromise = 1e-7;

  struct Step {
    SurfacePlace place;
    Vec3 moved{};  ///< from where the point was
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

// Moves one vertex at a time, within what its place allows, for the better of the cells around it.

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
      : all_(all), mover_(all.mesh.points, all.places, slack) {
    assert(all.boxes.size() == all.cells.cellCount());
    assert(all.qualities.size() == all.cells.cellCount());
  }

  /// Brings all Bezier coefficients of the cells nearer to being positive.
  /// @return the share of the cells' size that it moved by
  double untangle(Index vertex);

  /// Lowers the energy at corners, if all cells around are certified and stay so. No scaled
  /// Jacobian that is not below the floor falls below it, unless that is said, and none below the
  /// least around; nor does the boundary leave the surface.
  /// @param power  of EnergyKind
  /// @return as untangle()
  double smooth(Index vertex, int power, const Exchange& exchange);

  /// Moves a vertex of the boundary towards a place, as PointMover does, if the cells around stay
  /// as good as smooth() would leave them.
  /// @param farthest  how far quads there may be from the surface
  void moveTo(Index vertex, const SurfacePlace& place, bool isPulled, double floor,
              double farthest = std::numeric_limits<double>::infinity());

  /// How far quads at a vertex may come from the surface: no farther than they are.
  [[nodiscard]] double farthestAt(Index vertex) const;

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
