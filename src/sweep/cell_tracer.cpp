#include <algorithm>
#include <string>

#include <sweep/cell_tracer.hpp>

namespace hexhex {

namespace {

/// The corners of a face of a tet.
struct Face {
  const LatticePoint& p;
  const LatticePoint& q;
  const LatticePoint& r;

  Face(const LatticeTet& tet, int face) noexcept
      : p(tet[corner(face, 0)]), q(tet[corner(face, 1)]), r(tet[corner(face, 2)]) {}

  /// On which side of the face a point lies; inside is positive.
  [[nodiscard]] int side(const LatticePoint& z) const noexcept { return orientation(p, q, r, z); }
  /// Sign of the inward normal's component along a direction.
  [[nodiscard]] int dot(Direction d) const noexcept {
    return sign(crossComponent(q - p, r - p, static_cast<std::size_t>(axisOf(d)))) * signOf(d);
  }
  /// Sign of the inward normal's product with a vector of components +1 and -1.
  [[nodiscard]] int dot(const std::array<int, 3>& v) const noexcept {
    Int128 sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += crossComponent(q - p, r - p, k) * v[k];
    return sign(sum);
  }

 private:
  static std::size_t corner(int face, std::size_t i) noexcept {
    return static_cast<std::size_t>(kFaceCorners[static_cast<std::size_t>(face)][i]);
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

CornerPlace CellTracer::trace(Index tet, const GridPoint& z, CornerMask generator,
                              const GridPoint& offset) {
  Way way{tet, {}, {}, {}, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    way.center[k] = z[k] * exact_.unit + exact_.unit / 2;
    way.along[k] = 2 * offset[k] - 1;
    way.tilts[k] = direction(static_cast<int>(k), -way.along[k]);
  }
  if (generator != kWholeTet) way = startAroundCenter(way);
  for (std::size_t steps = 0;; ++steps) {
    const int face = exitFace(way);
    if (face == kNoExit) fail(way.tet, "the way leaves a tet nowhere");
    LatticePoint corner = way.center;
    for (std::size_t k = 0; k < 3; ++k) corner[k] += way.along[k] * (exact_.unit / 2);
    if (endsBefore(way, face, corner)) {
      CornerPlace place{way.tet, {}, way.rotation};
      for (std::size_t k = 0; k < 3; ++k) {
        place.z[k] = static_cast<std::int32_t>(corner[k] / exact_.unit);
      }
      return place;
    }
    if (topology_.isBoundary(halfFaceOf(way.tet, face))) fail(way.tet, "the way leaves the mesh");
    if (steps > topology_.tetCount()) fail(way.tet, "the way does not end");
    way = across(way, face);
  }
}

CellTracer::Way CellTracer::across(const Way& way, int face) const {
  const HalfFace halfFace = halfFaceOf(way.tet, face);
  Way next = way;
  next.tet = tetOf(topology_.mate[halfFace]);
  if (!exact_.transitions.isJump(halfFace)) return next;
  const Transition& transition = exact_.transitions.across(halfFace);
  next.center = transition(way.center, exact_.unit);
  next.along = transition.rotation(way.along);
  for (Direction& tilt : next.tilts) tilt = transition(tilt);
  next.rotation = transition.rotation * way.rotation;
  return next;
}

/// The face through which the way leaves the tet: seen along the way, the tet's corners are points
/// of a plane, and a face is crossed outward if the way runs on the negative side of its three
/// edges.
int CellTracer::exitFace(const Way& way) const {
  const LatticeTet& c = exact_.corners[way.tet];
  const std::array<int, 3>& d = way.along;
  const int orientation = d[0] * d[1] * d[2];
  LatticeTet relative{};
  std::array<std::array<std::int64_t, 2>, 4> projected{};
  for (std::size_t i = 0; i < 4; ++i) {
    relative[i] = c[i] - way.center;
    const LatticePoint& r = relative[i];
    projected[i] = {r[0] * d[0] - r[2] * d[2], r[1] * d[1] - r[2] * d[2]};
  }
  // Sign of det(a, b, way) for two corners relative to the centre.
  const auto side = [&](std::size_t i, std::size_t j) {
    const auto& a = projected[i];
    const auto& b = projected[j];
    const int untilted =
        sign(static_cast<Int128>(a[0]) * b[1] - static_cast<Int128>(a[1]) * b[0]) * orientation;
    if (untilted != 0) return untilted;
    for (const Direction tilt : way.tilts) {
      const int tilted =
          sign(crossComponent(relative[i], relative[j], static_cast<std::size_t>(axisOf(tilt)))) *
          signOf(tilt);
      if (tilted != 0) return tilted;
    }
    return 0;  // the edge contains the centre
  };
  constexpr int kUnknown = 2;
  std::array<std::array<int, 4>, 4> known{};
  for (auto& row : known) row.fill(kUnknown);
  const auto isNegative = [&](int i, int j) {
    const auto a = static_cast<std::size_t>(i);
    const auto b = static_cast<std::size_t>(j);
    if (known[a][b] == kUnknown) {
      known[a][b] = side(a, b);
      known[b][a] = -known[a][b];
    }
    return known[a][b] < 0;
  };
  for (int face = 0; face < 4; ++face) {
    const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
    if (isNegative(f[0], f[1]) && isNegative(f[1], f[2]) && isNegative(f[2], f[0])) return face;
  }
  return kNoExit;
}

/// Whether the way ends before it reaches its exit face.
bool CellTracer::endsBefore(const Way& way, int face, const LatticePoint& corner) const {
  const Face plane(exact_.corners[way.tet], face);
  const int side = plane.side(corner);
  if (side != 0) return side > 0;
  for (const Direction tilt : way.tilts) {
    const int tilted = plane.dot(tilt);
    if (tilted != 0) return tilted > 0;
  }
  return true;
}

/// Whether the way begins inside the tet, whose closure contains the centre: no face through the
/// centre may have it outside.
bool CellTracer::leadsInto(const Way& way) const {
  for (int face = 0; face < 4; ++face) {
    const Face plane(exact_.corners[way.tet], face);
    if (plane.side(way.center) != 0) continue;
    int side = plane.dot(way.along);
    for (const Direction tilt : way.tilts) {
      if (side == 0) side = plane.dot(tilt);
    }
    if (side < 0) return false;
  }
  return true;
}

/// The tet among those around the centre into which the way leads.
CellTracer::Way CellTracer::startAroundCenter(const Way& way) {
  star_.assign(1, way);
  for (std::size_t head = 0; head < star_.size(); ++head) {
    const Way here = star_[head];
    if (leadsInto(here)) return here;
    for (int face = 0; face < 4; ++face) {
      if (Face(exact_.corners[here.tet], face).side(here.center) != 0) continue;
      if (topology_.isBoundary(halfFaceOf(here.tet, face))) {
        fail(here.tet, "a centre lies on the boundary");
      }
      const Way next = across(here, face);
      const bool seen = std::any_of(star_.begin(), star_.end(),
                                    [&](const Way& other) { return other.tet == next.tet; });
      if (!seen) star_.push_back(next);
    }
  }
  fail(way.tet, "no tet around a centre contains the beginning of the way");
}

}  // namespace hexhex
