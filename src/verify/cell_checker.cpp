#include <algorithm>
#include <cmath>
#include <utility>

#include <verify/cell_checker.hpp>

namespace hexhex::verification {

namespace {

lattice::LatticePoint scaled(const lattice::GridPoint& z, std::int64_t unit) {
  return {z[0] * unit, z[1] * unit, z[2] * unit};
}

/// Manhattan distance, which is invariant under all transitions.
std::int64_t distance(const lattice::LatticePoint& a, const lattice::LatticePoint& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

/// A simplex of one tet as a simplex of another, or kNoSimplex if the other tet does not contain
/// it.
lattice::CornerMask simplexIn(const adjacency::TetTopology& topology, Index from,
                              lattice::CornerMask simplex, Index to) {
  const Tet& there = topology.tets[to];
  for (std::size_t i = 0; i < 4; ++i) {
    if (!lattice::contains(simplex, static_cast<int>(i))) continue;
    if (std::find(there.begin(), there.end(), topology.tets[from][i]) == there.end()) {
      return lattice::kNoSimplex;
    }
  }
  return topology.translated(simplex, from, to);
}

/// The edges of a tet as pairs of corners.
constexpr std::array<std::pair<std::size_t, std::size_t>, 6> kEdges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// Per face: the edges opposite its corners, in the order of kFaceCorners.
constexpr auto kFaceEdges = [] {
  std::array<std::array<std::size_t, 3>, 4> edges{};
  for (std::size_t face = 0; face < 4; ++face) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<std::size_t>(lattice::kFaceCorners[face][(k + 1) % 3]);
      const auto b = static_cast<std::size_t>(lattice::kFaceCorners[face][(k + 2) % 3]);
      for (std::size_t e = 0; e < 6; ++e) {
        if (kEdges[e] == std::pair(std::min(a, b), std::max(a, b))) edges[face][k] = e;
      }
    }
  }
  return edges;
}();

/// Per set of edges i < j with negative area: the face whose three areas are all negative, going
/// around it in the order of kFaceCorners.
constexpr auto kExits = [] {
  std::array<int, 64> exits{};
  for (unsigned negative = 0; negative < 64; ++negative) {
    exits[negative] = lattice::kNoExit;
    for (std::size_t face = 0; face < 4; ++face) {
      bool isExit = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const bool ascends =
            lattice::kFaceCorners[face][(k + 1) % 3] < lattice::kFaceCorners[face][(k + 2) % 3];
        isExit = isExit && ((negative >> kFaceEdges[face][k] & 1U) != 0) == ascends;
      }
      if (isExit) exits[negative] = static_cast<int>(face);
    }
  }
  return exits;
}();

}  // namespace

bool areSamePoint(const igm::PreparedMap& map, const LatticePlace& a, const LatticePlace& b) {
  if (a.tet == b.tet && a.z == b.z) return true;
  const int kind = lattice::dimension(a.simplex);
  if (kind == 3 || kind != lattice::dimension(b.simplex)) return false;
  const adjacency::TetTopology& topology = map.topology;
  const igm::ExactMap& exact = map.exact;
  if (kind == 2) {
    const adjacency::HalfFace face =
        adjacency::halfFaceOf(a.tet, lattice::oppositeCorner(a.simplex));
    if (topology.isBoundary(face) || adjacency::tetOf(topology.mate[face]) != b.tet) return false;
    return exact.transitions.across(face)(a.z) == b.z;
  }
  // Same vertex; or same edge, and same distances from its vertices.
  if (simplexIn(topology, a.tet, a.simplex, b.tet) != b.simplex) return false;
  const std::size_t corner = lattice::firstCorner(a.simplex);
  const Index vertex = topology.tets[a.tet][corner];
  const auto cornerThere = static_cast<std::size_t>(topology.localCorner(b.tet, vertex));
  return distance(exact.corners[a.tet][corner], scaled(a.z, exact.unit)) ==
         distance(exact.corners[b.tet][cornerThere], scaled(b.z, exact.unit));
}

bool HalfDiagonals::isAt(const LatticePlace& place, std::uint64_t point) {
  // A point in the interior of a face belongs to either of two tets.
  if (lattice::dimension(place.simplex) == 2) {
    const adjacency::HalfFace mate =
        map_.topology
            .mate[adjacency::halfFaceOf(place.tet, lattice::oppositeCorner(place.simplex))];
    owner_ = places_.owns(place.tet, point) || mate == kNone ? place.tet : adjacency::tetOf(mate);
  } else if (place.simplex == lattice::kWholeTet) {
    owner_ = place.tet;
  }
  if (!places_.owns(owner_, point)) owner_ = places_.ownerOf(point);
  return areSamePoint(map_, place, places_.placeIn(owner_, point));
}

bool HalfDiagonals::endsAt(Segment segment, int exit, std::uint64_t point) {
  // A tet is passed more than once only if the map is not what preparation claims.
  for (std::size_t steps = 0; steps <= map_.topology.tetCount(); ++steps) {
    if (exit == lattice::kNoExit) {
      const Step step = look(segment, exit);
      if (step == Step::IsUncertain) break;
      if (step == Step::EndsInside) {
        return isAt(endOf(segment, lattice::kWholeTet), point);
      }
    }
    if (!cross(segment, exit)) return false;
    // If the tet owns the lattice point, the segment reaches it within the tet.
    if (places_.owns(segment.tet, point) &&
        isAtEnd(segment, places_.placeIn(segment.tet, point).z)) {
      return true;
    }
    exit = lattice::kNoExit;
  }
  const std::optional<LatticePlace> end = followExactly(segment);
  return end && isAt(*end, point);
}

bool HalfDiagonals::isAtEnd(const Segment& segment, const lattice::GridPoint& z) const noexcept {
  const std::int64_t unit = map_.exact.unit;
  return segment.end[0] == z[0] * unit && segment.end[1] == z[1] * unit &&
         segment.end[2] == z[2] * unit;
}

/// Seen along the segment, the corners of the tet are points (x, y) of a plane with the segment at
/// the origin, each with a depth. The segment leaves through the back-facing triangle that contains
/// the origin.
HalfDiagonals::Step HalfDiagonals::look(const Segment& segment, int& exit) const noexcept {
  std::array<double, 4> x;
  std::array<double, 4> y;
  std::array<double, 4> depth;
  std::array<double, 4> size;
  const lattice::LatticeTet& tet = map_.exact.corners[segment.tet];
  std::array<double, 3> along;
  for (std::size_t k = 0; k < 3; ++k) along[k] = segment.end[k] > segment.start[k] ? 1 : -1;
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<double, 3> r;
    for (std::size_t k = 0; k < 3; ++k) {
      r[k] = along[k] * static_cast<double>(tet[i][k] - segment.start[k]);
    }
    x[i] = r[0] - r[2];
    y[i] = r[1] - r[2];
    depth[i] = r[0] + r[1] + r[2];
    size[i] = std::abs(r[0]) + std::abs(r[1]) + std::abs(r[2]);
  }
  // Twice the areas of the triangles spanned by the origin and two corners.
  std::array<double, 6> areas;
  unsigned negative = 0;
  const double mirror = along[0] * along[1] * along[2];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = kEdges[e];
    areas[e] = mirror * (x[i] * y[j] - y[i] * x[j]);
    negative |= (areas[e] < 0 ? 1U : 0U) << e;
  }
  exit = kExits[negative];
  if (exit == lattice::kNoExit) return Step::IsUncertain;
  // Each coordinate carries the rounding of a conversion and of a subtraction, so areas are off by
  // less than 12 * 2^-53 of the product of sizes. The depth of the triangle at the origin is the
  // mean of its corners' depths, weighted by the areas opposite them; each product is off by less
  // than 2^-48 of its magnitudes.
  const std::array<std::size_t, 3>& edges = kFaceEdges[static_cast<std::size_t>(exit)];
  const double end = 3 * static_cast<double>(half_);
  double beyond = 0;
  double sum = 0;
  bool isCertain = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto corner =
        static_cast<std::size_t>(lattice::kFaceCorners[static_cast<std::size_t>(exit)][k]);
    const auto [i, j] = kEdges[edges[k]];
    const double area = std::abs(areas[edges[k]]);
    isCertain = isCertain && area > 0x1p-49 * size[i] * size[j];
    beyond += area * (depth[corner] - end);
    sum += size[corner];
  }
  if (!isCertain || std::abs(beyond) <= 0x1p-47 * sum * sum * (sum + end)) {
    return Step::IsUncertain;
  }
  return beyond > 0 ? Step::EndsInside : Step::Leaves;
}

/// Moves on to the neighbour across a face, if there is one.
bool HalfDiagonals::cross(Segment& segment, int face) const noexcept {
  const adjacency::HalfFace halfFace = adjacency::halfFaceOf(segment.tet, face);
  if (map_.topology.isBoundary(halfFace)) return false;
  segment.tet = adjacency::tetOf(map_.topology.mate[halfFace]);
  const igm::ExactMap& exact = map_.exact;
  if (exact.transitions.isNonTrivial(halfFace)) {
    const lattice::Transition& transition = exact.transitions.across(halfFace);
    segment.start = transition(segment.start, exact.unit);
    segment.end = transition(segment.end, exact.unit);
  }
  return true;
}

/// Visits all tets that the segment may enter until one contains its end.
std::optional<LatticePlace> HalfDiagonals::followExactly(const Segment& segment) {
  segments_.assign(1, segment);
  for (std::size_t head = 0; head < segments_.size(); ++head) {
    const Segment here = segments_[head];
    const lattice::LatticeTet& tet = map_.exact.corners[here.tet];
    const lattice::CornerMask simplex = lattice::simplexOf(tet, here.end);
    if (simplex != lattice::kNoSimplex) return endOf(here, simplex);
    for (int face = 0; face < 4; ++face) {
      if (!crossesFirst(here, tet, face)) continue;
      Segment next = here;
      if (cross(next, face) &&
          std::none_of(segments_.begin(), segments_.end(),
                       [&](const Segment& known) { return known.tet == next.tet; })) {
        segments_.push_back(next);
      }
    }
  }
  return std::nullopt;
}

/// Whether the segment passes from the inner side of a face, or from its plane, to the outer side
/// and meets the closed triangle in one point.
bool HalfDiagonals::crossesFirst(const Segment& segment, const lattice::LatticeTet& tet, int face) {
  const auto f = static_cast<std::size_t>(face);
  if (lattice::sideOfFace(tet, f, segment.end) >= 0 ||
      lattice::sideOfFace(tet, f, segment.start) < 0)
    return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const lattice::LatticePoint& p = tet[static_cast<std::size_t>(lattice::kFaceCorners[f][i])];
    const lattice::LatticePoint& q =
        tet[static_cast<std::size_t>(lattice::kFaceCorners[f][(i + 1) % 3])];
    if (lattice::orientation(segment.start, segment.end, p, q) > 0) return false;
  }
  return true;
}

LatticePlace HalfDiagonals::endOf(const Segment& segment,
                                  lattice::CornerMask simplex) const noexcept {
  LatticePlace place{segment.tet, {}, simplex};
  for (std::size_t k = 0; k < 3; ++k) {
    place.z[k] = static_cast<std::int32_t>(segment.end[k] / map_.exact.unit);
  }
  return place;
}

}  // namespace hexhex::verification
