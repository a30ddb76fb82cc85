#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <base/vector3.hpp>
#include <improve/vertex_energy.hpp>
#include <improve/vertex_mover.hpp>

namespace hexhex::improvement {

double ChordError::at(Index vertex, double enough) const {
  const ReferenceSurface& surface = places.surface;
  double error = 0;
  const auto add = [&error](const Vec3& point, const SurfacePlace& nearest) {
    error = std::max(error, length(minus(point, nearest.point)));
  };
  for (const Index cell : around(vertex)) {
    for (std::size_t face = 0; face < adjacency::kHexFaces.size(); ++face) {
      if ((boundary[cell] >> face & 1U) == 0) continue;
      const Quad quad = adjacency::faceVertices(mesh.cells[cell], face);
      const auto at =
          static_cast<std::size_t>(std::find(quad.begin(), quad.end(), vertex) - quad.begin());
      if (at == quad.size()) continue;
      Vec3 centre{};
      for (const Index v : quad) centre = plus(centre, times(0.25, mesh.points[v]));
      const auto* const start = std::find_if(
          quad.begin(), quad.end(), [&](Index v) { return places.freedom[v] == Freedom::OnPatch; });
      if (start != quad.end()) add(centre, places.nearest(*start, centre, enough));
      if (places.freedom[vertex] != Freedom::OnCurve) continue;
      for (const Index other : {quad[(at + 1) % 4], quad[(at + 3) % 4]}) {
        // Other edges lead away from the curve.
        const Vec3& end = mesh.points[other];
        const SurfacePlace place = surface.onCurve(end, places.simplex[vertex]);
        if (length(minus(place.point, end)) > chord) continue;
        const Vec3 middle = times(0.5, plus(end, mesh.points[vertex]));
        add(middle, surface.onCurve(middle, place.simplex));
      }
    }
  }
  return error;
}

namespace {

/// Weight of the term that keeps cells from shrinking during untangling.
constexpr double kVolume = 0.1;
/// Regularization of determinants, which are 1 in the ideal cell: if all are positive, and as a
/// fraction of the least one otherwise.
constexpr double kLeastEpsilon = 1e-4;
constexpr double kRegularization = 0.2;

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
  if (!hasSlack(point)) return places_.directionsAt(point, directions);
  directions = kAxes;
  return directions.size();
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

void VertexMover::collect(Index vertex, bool bezier) {
  terms_.clear();
  all_.cells.addTerms(all_.mesh.points, points_.around(vertex), vertex, all_.boxes, bezier,
                      scratch_, terms_);
}

double VertexMover::sizeAt(Index vertex) const {
  double size = std::numeric_limits<double>::infinity();
  for (const Index cell : points_.around(vertex)) {
    for (const float edge : all_.boxes[cell]) size = std::min<double>(size, edge);
  }
  return size;
}

bool VertexMover::isGoodAround(Index vertex, double least, const Exchange& exchange) {
  measured_.clear();
  const double floor = exchange.floor;
  const double lowest = std::min(least, floor);
  const auto leastOf = [&](Index cell) {
    return all_.qualities[cell] < floor || exchange.belowFloor ? lowest : floor;
  };
  const bool areGood = all_.cells.forQualities(all_.mesh.points, points_.around(vertex), scratch_,
                                               [&](Index cell, double quality) {
                                                 measured_.emplace_back(cell, quality);
                                                 return quality >= leastOf(cell);
                                               });
  if (!areGood) return false;
  double gained = 0;
  double lost = 0;
  for (const auto& [cell, quality] : measured_) {
    const double old = all_.qualities[cell];
    gained += std::min(quality, floor) - std::min(old, floor);
    lost += std::max(old, floor) - std::max(quality, floor);
  }
  return exchange.price == 0 || lost <= 0 || lost <= exchange.price * gained;
}

double VertexMover::untangle(Index vertex) {
  if (!mover_.canMove(vertex)) return 0;
  collect(vertex, true);
  return mover_.descend(vertex, terms_, PointMover::untangling(terms_), [] { return true; }) /
         sizeAt(vertex);
}

double VertexMover::leastQualityAt(Index vertex) const {
  double least = 1;
  for (const Index cell : points_.around(vertex)) {
    least = std::min(least, all_.qualities[cell]);
  }
  return least;
}

void VertexMover::keepMeasured() {
  for (const auto& [cell, quality] : measured_) all_.qualities[cell] = quality;
}

double VertexMover::smooth(Index vertex, int power, const Exchange& exchange) {
  if (!mover_.canMove(vertex)) return 0;
  const double before = leastQualityAt(vertex);
  if (!isCertified(before)) return 0;
  collect(vertex, false);
  const bool bounded = all_.places.freedom[vertex] != Freedom::Free;
  const double farthest = bounded ? farthestAt(vertex) : 0;
  const double moved = mover_.descend(vertex, terms_, EnergyKind{power, 0, 0}, [&] {
    return isGoodAround(vertex, before, exchange) &&
           (!bounded || all_.chordError.at(vertex, farthest) <= farthest);
  });
  if (moved == 0) return 0;
  keepMeasured();
  return moved / sizeAt(vertex);
}

double VertexMover::farthestAt(Index vertex) const {
  const double chord = all_.chordError.chord;
  return std::max(chord, all_.chordError.at(vertex, chord));
}

void VertexMover::moveTo(Index vertex, const SurfacePlace& place, bool isPulled, double floor,
                         double farthest) {
  const double least = leastQualityAt(vertex);
  if (!isCertified(least)) return;
  const auto isGood = [&] {
    return isGoodAround(vertex, least, {floor}) &&
           (std::isinf(farthest) || all_.chordError.at(vertex, farthest) <= farthest);
  };
  if (mover_.moveTo(vertex, place, isPulled, isGood)) keepMeasured();
}

}  // namespace hexhex::improvement
