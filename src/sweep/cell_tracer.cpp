// Follows half diagonals from tet to tet: floating point with proven bounds, then exact predicates.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include <sweep/cell_tracer.hpp>

namespace hexhex::sweep {

namespace {

/// A face of a tet, with corners given relative to any point.
struct Face {
  const lattice::LatticePoint& p;
  const lattice::LatticePoint& q;
  const lattice::LatticePoint& r;

  Face(const lattice::LatticeTet& tet, int face) noexcept
      : p(tet[corner(face, 0)]), q(tet[corner(face, 1)]), r(tet[corner(face, 2)]) {}

  /// On which side of the face a point lies; inside is positive.
  [[nodiscard]] int side(const lattice::LatticePoint& z) const noexcept {
    return lattice::orientation(p, q, r, z);
  }
  /// Sign of the inward normal's component along a direction.
  [[nodiscard]] int dot(lattice::Direction d) const noexcept {
    return lattice::sign(lattice::crossComponent(q - p, r - p,
                                                 static_cast<std::size_t>(lattice::axisOf(d)))) *
           lattice::signOf(d);
  }
  /// Sign of the inward normal's scalar product with a vector of components +1 and -1.
  [[nodiscard]] int dot(const std::array<int, 3>& v) const noexcept {
    lattice::Int128 sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += lattice::crossComponent(q - p, r - p, k) * v[k];
    return lattice::sign(sum);
  }

 private:
  static std::size_t corner(int face, std::size_t i) noexcept {
    return static_cast<std::size_t>(lattice::kFaceCorners[static_cast<std::size_t>(face)][i]);
  }
};

}  // namespace

void CellTracer::fail(Index tet, const char* what) {
  throw Error(ErrorCode::Internal,
              std::string("Tracing a cell failed: ") + what +
                  ". The sanitized map passed all checks, so this is a bug; please report it with "
                  "the map.",
              {PlaceKind::Tet, tet});
}

void CellTracer::enter(Index tet, const lattice::GridPoint& z,
                       lattice::CornerMask generator) noexcept {
  assert(generator != lattice::kNoSimplex);
  tet_ = tet;
  z_ = z;
  generator_ = generator;
  for (std::size_t k = 0; k < 3; ++k) center_[k] = z[k] * exact_.unit + half_;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      corners_[i][k] = static_cast<double>(exact_.corners[tet][i][k] - center_[k]);
    }
  }
}

CornerPlace CellTracer::trace(const lattice::GridPoint& offset, const TiltOrder& tilts) {
  Segment segment = begin(offset, tilts);
  int face = exitFromInside(segment);
  for (std::size_t steps = 0; face != lattice::kNoExit && !endsBefore(segment, face); ++steps) {
    if (topology_.isBoundary(adjacency::halfFaceOf(segment.tet, face)))
      fail(segment.tet, "the half diagonal leaves the mesh");
    if (steps > topology_.tetCount()) fail(segment.tet, "the half diagonal does not end");
    cross(segment, face);
    face = exitAfterEntry(segment);
  }
  if (face == lattice::kNoExit) fail(segment.tet, "the half diagonal leaves a tet through no face");
  CornerPlace place{segment.tet, {}, segment.rotation};
  for (std::size_t k = 0; k < 3; ++k) {
    place.z[k] =
        static_cast<std::int32_t>((segment.center[k] + segment.along[k] * half_) >> shift_);
  }
  return place;
}

CellTracer::Segment CellTracer::begin(const lattice::GridPoint& offset, const TiltOrder& tilts) {
  Segment segment{tet_, -1, center_, {}, {}, {}, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    segment.along[k] = 2 * offset[k] - 1;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    segment.tilts[k] = lattice::direction(tilts[k], -segment.along[tilts[k]]);
  }
  if (generator_ == lattice::kWholeTet) {
    for (std::size_t i = 0; i < 4; ++i) segment.seen[i] = seenAs(segment, corners_[i]);
  } else {
    segment = startAroundCenter(segment);
    for (std::size_t i = 0; i < 4; ++i) look(segment, i);
  }
  return segment;
}

lattice::LatticePoint CellTracer::relative(const Segment& segment, int corner) const noexcept {
  return exact_.corners[segment.tet][static_cast<std::size_t>(corner)] - segment.center;
}

lattice::LatticeTet CellTracer::relativeTet(const Segment& segment) const noexcept {
  return {relative(segment, 0), relative(segment, 1), relative(segment, 2), relative(segment, 3)};
}

/// A corner of the tet as it is seen, from its coordinates relative to the centre.
CellTracer::Seen CellTracer::seenAs(const Segment& segment,
                                    const std::array<double, 3>& r) noexcept {
  const double x = r[0] * segment.along[0];
  const double y = r[1] * segment.along[1];
  const double z = r[2] * segment.along[2];
  return {x - z, y - z, x + y + z, std::abs(x) + std::abs(y) + std::abs(z)};
}

void CellTracer::look(Segment& segment, std::size_t corner) const noexcept {
  const lattice::LatticePoint r = relative(segment, static_cast<int>(corner));
  segment.seen[corner] = seenAs(
      segment, {static_cast<double>(r[0]), static_cast<double>(r[1]), static_cast<double>(r[2])});
}

/// Twice the signed area of the triangle between two seen corners and the segment: the sign tells
/// on which side of the edge the segment passes; errors are below kAreaError times both sizes.
///
/// x and y carry a conversion and a subtraction, hence errors below 2 * 2^-53 * size; with the two
/// products and their difference, less than 12 * 2^-53 of the product of sizes.
constexpr double kAreaError = 0x1p-49;

/// Sign of det(a, b, segment) for two corners a, b relative to the centre: on which side of the
/// edge the segment passes. 0 only if the edge contains the centre.
int CellTracer::side(const Segment& segment, int i, int j) const noexcept {
  const Seen& a = segment.seen[static_cast<std::size_t>(i)];
  const Seen& b = segment.seen[static_cast<std::size_t>(j)];
  const double area = a.x * b.y - a.y * b.x;
  if (std::abs(area) <= kAreaError * a.size * b.size) return exactSide(segment, i, j);
  const int mirror = segment.along[0] * segment.along[1] * segment.along[2];
  return area > 0 ? mirror : -mirror;
}

int CellTracer::exactSide(const Segment& segment, int i, int j) const noexcept {
  const lattice::LatticePoint p = relative(segment, i);
  const lattice::LatticePoint q = relative(segment, j);
  lattice::Int128 exact = 0;
  for (std::size_t k = 0; k < 3; ++k) exact += lattice::crossComponent(p, q, k) * segment.along[k];
  if (exact != 0) return lattice::sign(exact);
  for (const lattice::Direction tilt : segment.tilts) {
    const int tilted = lattice::sign(lattice::crossComponent(
                           p, q, static_cast<std::size_t>(lattice::axisOf(tilt)))) *
                       lattice::signOf(tilt);
    if (tilted != 0) return tilted;
  }
  return 0;
}

/// The face through which the segment leaves the tet in which it begins: the one that has all three
/// edges passed on the negative side.
int CellTracer::exitFromInside(const Segment& segment) const noexcept {
  for (int face = 0; face < 4; ++face) {
    const std::array<int, 3>& f = lattice::kFaceCorners[static_cast<std::size_t>(face)];
    if (side(segment, f[0], f[1]) < 0 && side(segment, f[1], f[2]) < 0 &&
        side(segment, f[2], f[0]) < 0) {
      return face;
    }
  }
  return lattice::kNoExit;
}

/// The same for a tet that the segment entered: seen along the segment, the corners a, b, c of the
/// entry face surround the origin. Of the triangles formed by two of them and the fourth corner e,
/// the origin lies in the one that contains the direction opposite e.
int CellTracer::exitAfterEntry(const Segment& segment) const noexcept {
  const int e = segment.entered;
  const std::array<int, 3>& f = lattice::kFaceCorners[static_cast<std::size_t>(e)];
  if (side(segment, f[0], e) < 0) return side(segment, f[1], e) > 0 ? f[2] : f[0];
  return side(segment, f[2], e) < 0 ? f[1] : f[0];
}

/// Whether the segment ends before it reaches its exit face: compares the corner's depth with the
/// face's depth at the origin, which is the mean of its corners' depths, weighted by the areas of
/// the triangles opposite them.
bool CellTracer::endsBefore(const Segment& segment, int face) const noexcept {
  const std::array<int, 3>& f = lattice::kFaceCorners[static_cast<std::size_t>(face)];
  const Seen& a = segment.seen[static_cast<std::size_t>(f[0])];
  const Seen& b = segment.seen[static_cast<std::size_t>(f[1])];
  const Seen& c = segment.seen[static_cast<std::size_t>(f[2])];
  const double end = 3 * static_cast<double>(half_);
  const double atA = b.x * c.y - b.y * c.x;
  const double atB = c.x * a.y - c.y * a.x;
  const double atC = a.x * b.y - a.y * b.x;
  const double beyond = atA * (a.depth - end) + atB * (b.depth - end) + atC * (c.depth - end);
  // Areas are off by kAreaError times the product of two sizes, depths by 4 * 2^-53 times a size.
  const double size = a.size + b.size + c.size;
  if (std::abs(beyond) <= 4 * kAreaError * size * size * (size + end)) {
    return endsExactlyBefore(segment, face);
  }
  return (beyond > 0) == (atA + atB + atC > 0);
}

bool CellTracer::endsExactlyBefore(const Segment& segment, int face) const noexcept {
  lattice::LatticePoint corner{};
  for (std::size_t k = 0; k < 3; ++k) corner[k] = segment.along[k] * half_;
  const lattice::LatticeTet tet = relativeTet(segment);
  const Face plane(tet, face);
  const int side = plane.side(corner);
  if (side != 0) return side > 0;
  for (const lattice::Direction tilt : segment.tilts) {
    const int tilted = plane.dot(tilt);
    if (tilted != 0) return tilted > 0;
  }
  return true;
}

/// Continues in the neighbour across a face.
void CellTracer::cross(Segment& segment, int face) const {
  const adjacency::HalfFace halfFace = adjacency::halfFaceOf(segment.tet, face);
  const adjacency::HalfFace mate = topology_.mate[halfFace];
  assert(mate != kNone);
  const Index before = segment.tet;
  segment.tet = adjacency::tetOf(mate);
  segment.entered = adjacency::localOf(mate);
  if (exact_.transitions.isNonTrivial(halfFace)) {
    const lattice::Transition& transition = exact_.transitions.across(halfFace);
    segment.center = transition(segment.center, exact_.unit);
    segment.along = transition.rotation(segment.along);
    for (lattice::Direction& tilt : segment.tilts) tilt = transition(tilt);
    segment.rotation = transition.rotation * segment.rotation;
    for (std::size_t i = 0; i < 4; ++i) look(segment, i);
    return;
  }
  // Three corners look as before.
  const std::array<Seen, 4> seen = segment.seen;
  const Tet& next = topology_.tets[segment.tet];
  for (std::size_t i = 0; i < 4; ++i) {
    if (static_cast<int>(i) == segment.entered) {
      look(segment, i);
    } else {
      segment.seen[i] = seen[static_cast<std::size_t>(topology_.localCorner(before, next[i]))];
    }
  }
}

/// The tet around the centre into which the segment leads: the segment is outside of none of its
/// faces through the centre.
CellTracer::Segment CellTracer::startAroundCenter(const Segment& segment) {
  const auto leadsInto = [this](const Segment& candidate) {
    const lattice::LatticeTet tet = relativeTet(candidate);
    for (int face = 0; face < 4; ++face) {
      const Face plane(tet, face);
      if (plane.side({}) != 0) continue;
      int side = plane.dot(candidate.along);
      for (const lattice::Direction tilt : candidate.tilts) {
        if (side == 0) side = plane.dot(tilt);
      }
      if (side < 0) return false;
    }
    return true;
  };
  star_.assign(1, segment);
  for (std::size_t head = 0; head < star_.size(); ++head) {
    const Segment here = star_[head];
    if (leadsInto(here)) return here;
    const lattice::LatticeTet tet = relativeTet(here);
    for (int face = 0; face < 4; ++face) {
      if (Face(tet, face).side({}) != 0) continue;
      if (topology_.isBoundary(adjacency::halfFaceOf(here.tet, face))) {
        fail(here.tet, "a centre lies on the boundary");
      }
      Segment next = here;
      cross(next, face);
      const bool seen = std::any_of(star_.begin(), star_.end(),
                                    [&](const Segment& other) { return other.tet == next.tet; });
      if (!seen) star_.push_back(next);
    }
  }
  fail(segment.tet, "no tet around a centre contains the beginning of a half diagonal");
}

}  // namespace hexhex::sweep
