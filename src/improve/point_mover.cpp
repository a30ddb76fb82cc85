#include <cmath>

#include <base/vector3.hpp>
#include <improve/point_mover.hpp>

namespace hexhex::improvement {

namespace {

/// Of the term that keeps cells from shrinking while they are untangled.
constexpr double kVolume = 0.1;
/// Of determinants, which are 1 in the ideal cell: when all are positive, and for others by how
/// much the least one is not.
constexpr double kLeastEpsilon = 1e-4;
constexpr double kRegularization = 0.2;

Vec3 normalized(const Vec3& a) {
  const double size = length(a);
  return size > 0 ? times(1 / size, a) : Vec3{};
}

}  // namespace

EnergyKind PointMover::untangling(const EnergyTerms& terms) {
  const double least = terms.leastDeterminantAt({});
  EnergyKind kind;
  kind.volume = kVolume;
  kind.epsilon =
      least > 0 ? kLeastEpsilon : std::hypot(10 * kLeastEpsilon, kRegularization * least);
  return kind;
}

bool PointMover::hasSlack(Index point) const {
  const Freedom freedom = places_.freedom[point];
  return slack_ > 0 && (freedom == Freedom::OnPatch || freedom == Freedom::OnCurve) &&
         !places_.surface.isTagged(freedom, places_.simplex[point]);
}

std::size_t PointMover::directionsAt(Index point, std::array<Vec3, 3>& directions) const {
  const ReferenceSurface& surface = places_.surface;
  switch (hasSlack(point) ? Freedom::Free : places_.freedom[point]) {
    case Freedom::Free:
      directions = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
      return 3;
    case Freedom::OnPatch: {
      const std::array<Vec3, 3> t = surface.triangle(places_.simplex[point]);
      const Vec3 first = minus(t[1], t[0]);
      directions[0] = normalized(first);
      directions[1] = normalized(cross(cross(first, minus(t[2], t[0])), first));
      return 2;
    }
    case Freedom::OnCurve: {
      const std::array<Vec3, 2> s = surface.segment(places_.simplex[point]);
      directions[0] = normalized(minus(s[1], s[0]));
      return 1;
    }
    default:
      return 0;
  }
}

PointMover::Step PointMover::stepBy(Index point, const Vec3& direction, double share) const {
  const Vec3& from = points_[point];
  const Vec3 to = plus(from, times(share, direction));
  Step step{places_.nearest(point, to), {}, 0};
  if (hasSlack(point)) {
    const Vec3 off = minus(to, step.place.point);
    const double distance = length(off);
    step.place.point =
        plus(step.place.point, times(distance > slack_ ? slack_ / distance : 1, off));
  }
  step.moved = minus(step.place.point, from);
  step.length = length(step.moved);
  return step;
}

void PointMover::take(Index point, const SurfacePlace& place) {
  points_[point] = place.point;
  places_.simplex[point] = place.simplex;
}

}  // namespace hexhex::improvement
