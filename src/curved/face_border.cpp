#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <curved/face_border.hpp>
#include <curved/simplex_point.hpp>

namespace hexhex::curved {

void failToCut(Index tet, const char* what) {
  throw Error(ErrorCode::Internal,
              std::string("Cutting a hex face failed: ") + what +
                  ". The map passed all checks, so this is a bug; please report it with the map.",
              {PlaceKind::Tet, tet});
}

namespace {

/// The ends of an edge, the smaller first; for a vertex, twice that vertex.
std::pair<Index, Index> endsOf(const Tet& tet, lattice::CornerMask simplex) noexcept {
  return std::minmax({tet[lattice::firstCorner(simplex)], tet[lattice::lastCorner(simplex)]});
}

/// Compares a simplex of fewer than four corners with others that are given by their owners.
class SimplexMatcher {
 public:
  SimplexMatcher(const adjacency::TetTopology& topology, Index tet, lattice::CornerMask simplex)
      : topology_(topology), dimension_(lattice::dimension(simplex)) {
    // The owner of an edge is found only by walking around it, so edges are identified by their
    // ends.
    if (dimension_ == 2) {
      face_ = ownedFace(topology, tet, lattice::oppositeCorner(simplex));
    } else {
      ends_ = endsOf(topology.tets[tet], simplex);
    }
  }

  [[nodiscard]] bool operator()(const OwnedSimplex& other) const {
    if (dimension_ == 2) return other.tet == face_.tet && other.corners == face_.corners;
    return lattice::dimension(other.corners) == dimension_ &&
           endsOf(topology_.tets[other.tet], other.corners) == ends_;
  }

 private:
  const adjacency::TetTopology& topology_;
  int dimension_;
  OwnedSimplex face_{};
  std::pair<Index, Index> ends_{};
};

/// Corners of the square, counter-clockwise.
constexpr std::array<lattice::GridPoint, 4> kSquareCorners = {
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};

/// Rounded coordinate, along a side of the square, of a slice's corner on that side.
double placeOnSide(const lattice::LatticeTet& seen, const SliceCorner& corner, std::size_t side,
                   std::int64_t unit) {
  const std::size_t across = axisAcross(side);
  const std::size_t along = 1 - across;
  lattice::LatticeTet moved = seen;
  if (boundsAtOne(side)) {
    for (lattice::LatticePoint& p : moved) p[across] -= unit;
  }
  SimplexPoint point = SimplexPoint::corner(lattice::firstCorner(corner.simplex));
  if (lattice::dimension(corner.simplex) == 2) {
    point = intersectionWithFace(moved, lattice::oppositeCorner(corner.simplex), along);
  } else if (lattice::dimension(corner.simplex) == 1) {
    const std::size_t i = lattice::firstCorner(corner.simplex);
    const std::size_t j = lattice::lastCorner(corner.simplex);
    const std::size_t axis = moved[i][across] != moved[j][across] ? across : 2;
    point = SimplexPoint::between(i, j, moved[i][axis], moved[j][axis]);
  }
  return coordinate(point.normalized(), seen, along) / static_cast<double>(unit);
}

/// The simplex of a tet that holds the origin, or kNoSimplex.
lattice::CornerMask simplexOfOrigin(const lattice::LatticeTet& corners) {
  std::array<std::array<double, 3>, 4> c;
  std::array<double, 3> reach{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      c[i][k] = static_cast<double>(corners[i][k]);
      reach[k] = std::max(reach[k], std::abs(c[i][k]));
    }
  }
  // Each volume is a sum of six products with at most eight roundings each: an error below 6 * 8.1
  // * 2^-53 < 2^-47 times the largest product. 2^-46 leaves a factor of two.
  const double error = 0x1p-46 * reach[0] * reach[1] * reach[2];
  lattice::CornerMask simplex = lattice::kNoSimplex;
  for (int face = 0; face < 4; ++face) {
    const std::array<int, 3>& f = lattice::kFaceCorners[static_cast<std::size_t>(face)];
    const auto i = static_cast<std::size_t>(f[0]);
    const auto j = static_cast<std::size_t>(f[1]);
    const auto k = static_cast<std::size_t>(f[2]);
    const double outside = c[i][2] * (c[j][0] * c[k][1] - c[j][1] * c[k][0]) +
                           c[j][2] * (c[k][0] * c[i][1] - c[k][1] * c[i][0]) +
                           c[k][2] * (c[i][0] * c[j][1] - c[i][1] * c[j][0]);
    const int side = std::abs(outside) > error
                         ? (outside < 0 ? 1 : -1)
                         : lattice::sideOfFace(corners, static_cast<std::size_t>(face), {0, 0, 0});
    if (side < 0) return lattice::kNoSimplex;
    if (side > 0) simplex = static_cast<lattice::CornerMask>(simplex | lattice::cornerBit(face));
  }
  return simplex;
}

}  // namespace

bool FaceBorder::mayContainAll(const SeenTet& seen, std::int64_t unit) noexcept {
  for (std::size_t k = 0; k < 2; ++k) {
    std::int64_t low = seen.corners[0][k];
    std::int64_t high = low;
    for (std::size_t i = 1; i < 4; ++i) {
      low = std::min(low, seen.corners[i][k]);
      high = std::max(high, seen.corners[i][k]);
    }
    if (low > 0 || high < unit) return false;
  }
  return true;
}

lattice::CornerMask FaceBorder::setInsideOneTet(Index tet, const Frame& frame) {
  std::array<lattice::CornerMask, 4> simplices{};
  lattice::CornerMask carrier = lattice::kNoSimplex;
  for (std::size_t i = 0; i < 4; ++i) {
    const sweep::VertexTables::Found found =
        input_.vertices.find(tet, frame.toChart(kSquareCorners[i]));
    if (found.vertex == kNone) return lattice::kNoSimplex;
    vertices_[i] = found.vertex;
    simplices[i] = found.simplex;
    carrier = static_cast<lattice::CornerMask>(carrier | found.simplex);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (((found_ >> i) & 1U) != 0) continue;
    const auto middle = static_cast<lattice::CornerMask>(simplices[i] | simplices[(i + 1) % 4]);
    setArc(i, {tet, middle, frame});
  }
  return carrier;
}

void FaceBorder::findArcs(const SimplexInTet& carrier, const SeenTet& seen, const Slice& slice) {
  for (unsigned open = slice.midpoints & ~found_; open != 0; open &= open - 1) {
    setArc(static_cast<std::size_t>(std::countr_zero(open)), carrier);
  }
  for (unsigned open = slice.possibleMidpoints & ~found_; open != 0; open &= open - 1) {
    const auto side = static_cast<std::size_t>(std::countr_zero(open));
    const lattice::CornerMask simplex = simplexOfMidpoint(seen.corners, side);
    if (simplex != lattice::kNoSimplex) setArc(side, {carrier.tet, simplex, carrier.frame});
  }
}

/// The simplex of a tet that holds the midpoint of a side, or kNoSimplex.
lattice::CornerMask FaceBorder::simplexOfMidpoint(const lattice::LatticeTet& corners,
                                                  std::size_t side) const {
  const std::int64_t unit = exact_.unit;
  const std::array<lattice::LatticePoint, 4> midpoints = {
      {{unit / 2, 0, 0}, {unit, unit / 2, 0}, {unit / 2, unit, 0}, {0, unit / 2, 0}}};
  lattice::LatticeTet around = corners;
  for (lattice::LatticePoint& corner : around) corner = corner - midpoints[side];
  // Most tets along a side do not reach its midpoint.
  const std::size_t along = side % 2;
  bool before = true;
  bool behind = true;
  for (const lattice::LatticePoint& corner : around) {
    before = before && corner[along] < 0;
    behind = behind && corner[along] > 0;
  }
  if (before || behind) return lattice::kNoSimplex;
  return simplexOfOrigin(around);
}

/// Looks up an arc in the tet that owns its midpoint.
/// @param midpoint  with the face's frame
void FaceBorder::setArc(std::size_t side, const SimplexInTet& midpoint) {
  Index owner = midpoint.tet;
  Frame frame = midpoint.frame;
  if (midpoint.simplex != lattice::kWholeTet)
    owner = adjacency::ownerTet(topology_, midpoint.tet, midpoint.simplex);
  if (owner != midpoint.tet) {
    const bool found = star_.visit(midpoint, [&](const SimplexInTet& here) {
      frame = here.frame;
      return here.tet == owner;
    });
    if (!found) failToCut(midpoint.tet, "the owner of an edge was not found");
  }
  // Sides 1 and 2 are one step from the origin; sides 2 and 3 run backward.
  const lattice::Direction along = frame.axis(side % 2);
  const bool backward = lattice::signOf(along) < 0;
  lattice::GridPoint smaller = frame.origin();
  if (boundsAtOne(side)) smaller = lattice::step(smaller, frame.axis(axisAcross(side)));
  if (backward) smaller = lattice::step(smaller, along);
  const int axis = lattice::axisOf(along);
  arcs_[side] = input_.edges.find(owner, axis, smaller, lineHints_[side]);
  reversed_ = static_cast<std::uint8_t>(reversed_ | (unsigned{backward == (side < 2)} << side));
  found_ |= 1U << side;
}

/// Arcs know their ends; those of adjacent sides must agree.
void FaceBorder::finish(Index tet) {
  if (found_ != 15U) failToCut(tet, "a side was not found");
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t before = (i + 3) % 4;
    vertices_[i] = input_.arcs.ends[arcs_[i]][isReversed(i) ? 1 : 0];
    if (vertices_[i] != input_.arcs.ends[arcs_[before]][isReversed(before) ? 0 : 1]) {
      failToCut(tet, "its sides do not close");
    }
  }
}

PatchPoint FaceBorder::arcPoint(std::size_t side, std::uint64_t point) const noexcept {
  // The parameter is reversed if exactly one of arc and side runs backward. Branch-free, since the
  // branch would be unpredictable.
  const bool isTurned = isReversed(side) != (side >= 2);
  PatchPoint result{static_cast<Index>(vertexCount_ + point), {}};
  result.parameter[side % 2] = std::abs((isTurned ? 1.0 : 0.0) - input_.arcs.parameters[point]);
  result.parameter[1 - side % 2] = boundsAtOne(side) ? 1 : 0;
  return result;
}

std::uint64_t FaceBorder::partIn(const SimplexInTet& carrier, std::size_t side) const noexcept {
  const Arcs& arcs = input_.arcs;
  const std::uint64_t arc = arcs_[side];
  const std::uint64_t firstPoint = arcs.pointBegin[arc];
  const std::uint64_t end = arcs.pointBegin[arc + 1] + arc + 1;
  std::uint64_t part = kNoPart;
  for (std::uint64_t i = firstPoint + arc; i < end; ++i) {
    if (arcs.segmentTet[i] != carrier.tet || arcs.segmentCorners[i] != carrier.simplex) continue;
    if (part != kNoPart) return kNoPart;
    part = i - arc;
  }
  return part;
}

bool FaceBorder::findEnds(const SimplexInTet& carrier, std::size_t side, const SideEnd& first,
                          const SideEnd& second, PatchPoint& firstPoint,
                          PatchPoint& secondPoint) const noexcept {
  const std::uint64_t backward = isReversed(side) ? 1 : 0;
  const std::uint64_t begin = input_.arcs.pointBegin[arcs_[side]];
  const std::uint64_t end = input_.arcs.pointBegin[arcs_[side] + 1];
  // Points of an arc are numbered along it; the ends of a part are consecutive, starting from its
  // number minus one.
  std::uint64_t part = 0;
  if (first.isSquareCorner) {
    part = backward != 0 ? end : begin;
  } else if (second.isSquareCorner) {
    part = backward != 0 ? begin : end;
  } else if (first.isKnown) {
    part = firstPoint.number - vertexCount_ + 1 - backward;
  } else if (second.isKnown) {
    part = secondPoint.number - vertexCount_ + backward;
  } else {
    part = partIn(carrier, side);
    if (part == kNoPart) return false;
  }
  if (!first.isSquareCorner && !first.isKnown) firstPoint = arcPoint(side, part + backward - 1);
  if (!second.isSquareCorner && !second.isKnown) secondPoint = arcPoint(side, part - backward);
  return true;
}

/// A point of an arc is identified by the simplex in which the arc crosses there. (An arc crosses a
/// simplex twice only through a periodic domain; then the position along the arc decides.)
PatchPoint FaceBorder::pointAt(Index tet, const SeenTet& seen, const SliceCorner& corner) const {
  const std::size_t side = corner.squareSide();
  const std::size_t arc = arcs_[side];
  const Arcs& arcs = input_.arcs;
  const std::uint64_t end = arcs.pointBegin[arc + 1];
  const SimplexMatcher matches(topology_, tet, corner.simplex);
  const auto next = [&](std::uint64_t i) {
    while (i < end && !matches({arcs.generatorTet[i], arcs.generatorCorners[i]})) ++i;
    return i;
  };
  std::uint64_t best = next(arcs.pointBegin[arc]);
  if (best == end) failToCut(tet, "a corner of a polygon is no point of its arc");
  for (std::uint64_t i = next(best + 1); i < end; i = next(i + 1)) {
    const double along = placeOnSide(seen.corners, corner, side, exact_.unit);
    const double expected = (side >= 2) == isReversed(side) ? along : 1 - along;
    if (std::abs(arcs.parameters[i] - expected) < std::abs(arcs.parameters[best] - expected)) {
      best = i;
    }
  }
  return arcPoint(side, best);
}

}  // namespace hexhex::curved
