// Moves one point at a time down an energy, within what its place allows.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/vector3.hpp>
#include <improve/vertex_energy.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

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

  /// Moves a point to a place where it was, or a part of the way.
  /// @param isAccepted  as above
  template <class Accept>
  bool moveBack(Index point, const SurfacePlace& target, const Accept& isAccepted) {
    const SurfacePlace old{points_[point], places_.simplex[point]};
    take(point, target);
    if (isAccepted()) return true;
    for (double share = 0.5; share > 0.1; share *= 0.5) {
      take(point, old);
      take(point, stepBy(point, minus(target.point, old.point), share).place);
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

}  // namespace hexhex::improvement
