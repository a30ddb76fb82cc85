#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

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

/// First fraction of Newton's step to try for low powers. As neighbours follow, sweeps converge
/// much faster with more than one (successive overrelaxation).
constexpr double kOverrelaxation = 1.6;
/// Maximum number of trials, each half as long as the one before; fewer for moves to a place.
constexpr int kHalvings = 8;
constexpr int kHalvingsTo = 4;
/// Required fraction of the decrease that the slope predicts.
constexpr double kDecrease = 1e-4;
/// Steps with a smaller predicted decrease, relative to the energy, are not worth their time.
constexpr double kLeastPromise = 1e-7;

/// The energy that makes determinants positive, for terms of Bezier coefficients.
EnergyKind untangling(const EnergyTerms& terms) {
  const double least = terms.leastDeterminantAt({});
  EnergyKind kind;
  kind.volume = kVolume;
  kind.epsilon =
      least > 0 ? kLeastEpsilon : std::hypot(10 * kLeastEpsilon, kRegularization * least);
  return kind;
}

}  // namespace

bool VertexMover::hasSlack(Index vertex) const {
  const Freedom freedom = all_.places.freedom[vertex];
  return slack_ > 0 && (freedom == Freedom::OnPatch || freedom == Freedom::OnCurve) &&
         !all_.places.surface.isTagged(freedom, all_.places.simplex[vertex]);
}

std::size_t VertexMover::directionsAt(Index vertex, std::array<Vec3, 3>& directions) const {
  if (!hasSlack(vertex)) return all_.places.directionsAt(vertex, directions);
  directions = kAxes;
  return directions.size();
}

VertexMover::Step VertexMover::stepBy(Index vertex, const Vec3& direction, double share) const {
  const Vec3& from = all_.mesh.points[vertex];
  const Vec3 to = plus(from, times(share, direction));
  Step step{all_.places.nearest(vertex, to), {}};
  if (hasSlack(vertex)) {
    const Vec3 off = minus(to, step.place.point);
    const double distance = length(off);
    step.place.point =
        plus(step.place.point, times(distance > slack_ ? slack_ / distance : 1, off));
  }
  step.moved = minus(step.place.point, from);
  return step;
}

void VertexMover::take(Index vertex, const SurfacePlace& place) {
  all_.mesh.points[vertex] = place.point;
  all_.places.simplex[vertex] = place.simplex;
}

/// Takes a step of Newton's method down the energy of the collected terms, halved until it is
/// accepted and lowers the energy.
/// @param isAccepted  called after the vertex has moved
/// @return the distance moved
template <class Accept>
double VertexMover::descend(Index vertex, const EnergyKind& kind, const Accept& isAccepted) {
  std::array<Vec3, 3> directions;
  const std::size_t count = directionsAt(vertex, directions);
  const EnergySlope slope = slopeOf(terms_, kind);
  const Vec3 direction = newtonStep(slope, std::span(directions).first(count));
  const double promised = dot(slope.gradient, direction);
  if (!(promised < -kLeastPromise * slope.energy)) return 0;
  const SurfacePlace old{all_.mesh.points[vertex], all_.places.simplex[vertex]};
  double share = kind.power > 2 ? 1 : kOverrelaxation;
  for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
    const Step step = stepBy(vertex, direction, share);
    take(vertex, step.place);
    // Nearly all steps lower the energy, but many make cells worse.
    const double enough = slope.energy + kDecrease * share * promised;
    if (isAccepted() && energyAt(terms_, kind, step.moved) <= enough) return length(step.moved);
    take(vertex, old);
  }
  return 0;
}

void VertexMover::collect(Index vertex, TermKind kind) {
  terms_.clear();
  all_.cells.addTerms(all_.mesh.points, points_.around(vertex), vertex, all_.boxes, kind, scratch_,
                      terms_);
}

double VertexMover::sizeAt(Index vertex) const {
  double size = std::numeric_limits<double>::infinity();
  for (const Index cell : points_.around(vertex)) {
    for (const float edge : all_.boxes[cell]) size = std::min<double>(size, edge);
  }
  return size;
}

bool VertexMover::isGoodAround(Index vertex, double least, const Exchange& exchange) {
  constexpr std::size_t kTogether = ImprovedCells::kTogether;
  const std::span<const Index> cells = points_.around(vertex);
  const double floor = exchange.floor;
  const double lowest = std::min(least, floor);
  const auto leastOf = [&](Index cell) {
    return all_.qualities[cell] < floor || exchange.belowFloor ? lowest : floor;
  };
  measured_.resize(cells.size());
  const std::size_t groups = (cells.size() + kTogether - 1) / kTogether;
  for (std::size_t i = 0; i < groups; ++i) {
    const std::size_t begin = (suspect_ / kTogether + i) % groups * kTogether;
    const auto some = cells.subspan(begin, std::min(kTogether, cells.size() - begin));
    all_.cells.measure(all_.mesh.points, some, scratch_, std::span(measured_).subspan(begin));
    for (std::size_t k = 0; k < some.size(); ++k) {
      if (measured_[begin + k] >= leastOf(some[k])) continue;
      suspect_ = begin + k;
      return false;
    }
  }
  double gained = 0;
  double lost = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double old = all_.qualities[cells[i]];
    gained += std::min(measured_[i], floor) - std::min(old, floor);
    lost += std::max(old, floor) - std::max(measured_[i], floor);
  }
  return exchange.price == 0 || lost <= 0 || lost <= exchange.price * gained;
}

void VertexMover::untangle(Index vertex) {
  collect(vertex, TermKind::Bezier);
  descend(vertex, untangling(terms_), [] { return true; });
}

double VertexMover::leastQualityAt(Index vertex) {
  double least = 1;
  const std::span<const Index> cells = points_.around(vertex);
  suspect_ = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (all_.qualities[cells[i]] >= least) continue;
    least = all_.qualities[cells[i]];
    suspect_ = i;
  }
  return least;
}

void VertexMover::keepMeasured(Index vertex) {
  const std::span<const Index> cells = points_.around(vertex);
  for (std::size_t i = 0; i < cells.size(); ++i) all_.qualities[cells[i]] = measured_[i];
}

double VertexMover::smooth(Index vertex, TermKind kind, int power, const Exchange& exchange) {
  const double before = leastQualityAt(vertex);
  if (!isCertified(before)) return 0;
  collect(vertex, kind);
  const bool bounded = all_.places.freedom[vertex] != Freedom::Free;
  const double farthest = bounded ? farthestAt(vertex) : 0;
  const double moved = descend(vertex, EnergyKind{power, 0, 0}, [&] {
    return isGoodAround(vertex, before, exchange) &&
           (!bounded || all_.chordError.at(vertex, farthest) <= farthest);
  });
  if (moved == 0) return 0;
  keepMeasured(vertex);
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
  const SurfacePlace old{all_.mesh.points[vertex], all_.places.simplex[vertex]};
  const Vec3 way = minus(place.point, old.point);
  double share = 1;
  for (int i = 0; i < kHalvingsTo; ++i, share *= 0.5) {
    const Vec3 part = plus(old.point, times(share, way));
    take(vertex, share == 1 ? place
                 : isPulled ? SurfacePlace{part, place.simplex}
                            : stepBy(vertex, way, share).place);
    if (isGoodAround(vertex, least, {floor}) &&
        (std::isinf(farthest) || all_.chordError.at(vertex, farthest) <= farthest)) {
      keepMeasured(vertex);
      return;
    }
    take(vertex, old);
  }
}

}  // namespace hexhex::improvement
