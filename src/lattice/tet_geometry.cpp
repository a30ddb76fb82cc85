// Exact predicates on a tet: orientation, holder, casing, exits of turns and lines (Algorithms 4,
// 5, 7 and 9).
#include <cmath>

#include <lattice/tet_geometry.hpp>

namespace hexhex::lattice {

Int192 orientationDeterminant(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                              const LatticePoint& d) noexcept {
  const LatticePoint u = b - a;
  const LatticePoint v = c - a;
  const LatticePoint w = d - a;
  Int192 sum;
  for (std::size_t axis = 0; axis < 3; ++axis) sum.addProduct(crossComponent(u, v, axis), w[axis]);
  return sum;
}

namespace {

Vec3 rounded(const LatticePoint& p) noexcept {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

}  // namespace

int orientation(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                const LatticePoint& d) noexcept {
  const LatticePoint u = b - a;
  const LatticePoint v = c - a;
  const LatticePoint w = d - a;
  const RoundedDeterminant determinant(rounded(u), rounded(v), rounded(w));
  if (!determinant.hasCertifiedSign()) {
    // Coordinates in special positions often have few bits, or coincide.
    const std::int64_t bits = u[0] | u[1] | u[2] | v[0] | v[1] | v[2] | w[0] | w[1] | w[2];
    if (determinant.magnitude >= exactBelow(bits)) {
      return orientationDeterminant(a, b, c, d).sign();
    }
  }
  return (determinant.value > 0 ? 1 : 0) - (determinant.value < 0 ? 1 : 0);
}

NormalSigns::NormalSigns(const LatticeTet& corners) noexcept {
  for (std::size_t face = 0; face < 4; ++face) {
    const LatticePoint& origin = corners[static_cast<std::size_t>(kFaceCorners[face][0])];
    const LatticePoint a = corners[static_cast<std::size_t>(kFaceCorners[face][1])] - origin;
    const LatticePoint b = corners[static_cast<std::size_t>(kFaceCorners[face][2])] - origin;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int s = sign(crossComponent(a, b, axis));
      packed_ |= static_cast<std::uint32_t>(s + 1) << (2 * (3 * face + axis));
    }
  }
}

CornerMask holder(const NormalSigns& signs, CornerMask generator, Direction d1) noexcept {
  CornerMask simplex = kWholeTet;
  for (int face = 0; face < 4; ++face) {
    if (contains(generator, face)) continue;  // the generator is not in this face
    const int side = signs.dot(face, d1);
    if (side < 0) return kNoSimplex;
    if (side == 0) simplex = static_cast<CornerMask>(simplex & faceMask(face));
  }
  return simplex;
}

CornerMask casing(const NormalSigns& signs, CornerMask generator, Direction d1,
                  Direction d2) noexcept {
  CornerMask simplex = kWholeTet;
  for (int face = 0; face < 4; ++face) {
    if (contains(generator, face)) continue;
    int side = signs.dot(face, d1);
    if (side == 0) side = signs.dot(face, d2);
    if (side < 0) return kNoSimplex;
    if (side == 0) simplex = static_cast<CornerMask>(simplex & faceMask(face));
  }
  return simplex;
}

namespace {

[[nodiscard]] const LatticePoint& at(const LatticeTet& corners, int corner) noexcept {
  return corners[static_cast<std::size_t>(corner)];
}

/// Sign of (to - from) . d
int stepSign(const LatticePoint& from, const LatticePoint& to, Direction d) noexcept {
  const auto axis = static_cast<std::size_t>(axisOf(d));
  const int s = to[axis] > from[axis] ? 1 : (to[axis] < from[axis] ? -1 : 0);
  return s * signOf(d);
}

/// Whether the plane with normal d3 through the simplex's inner point, oriented like the turn,
/// leaves the cone of the tet at the simplex through face f. With the face's inward normal a x b,
/// where a and b are the directions to its other corners, a point r of the face that lies in the
/// plane moves with velocity d3 x r, and (a x b).(d3 x r) = (a.d3)(b.r) - (a.r)(b.d3) is negative,
/// i.e. points out of the tet, exactly if a.d3 <= 0 <= b.d3.
bool planeLeavesThrough(const LatticeTet& corners, CornerMask simplex, int f,
                        Direction d3) noexcept {
  const std::array<int, 3>& face = kFaceCorners[static_cast<std::size_t>(f)];
  for (std::size_t i = 0; i < 3; ++i) {
    const int first = face[i];
    const int second = face[(i + 1) % 3];
    const int third = face[(i + 2) % 3];
    if (dimension(simplex) == 0 && contains(simplex, first)) {
      return stepSign(at(corners, first), at(corners, second), d3) <= 0 &&
             stepSign(at(corners, first), at(corners, third), d3) >= 0;
    }
    if (dimension(simplex) == 1 && !contains(simplex, third)) {
      // The face is a half plane bounded by the simplex: a runs along it, b = -a closes the turn.
      return stepSign(at(corners, first), at(corners, second), d3) <= 0;
    }
  }
  return true;  // simplex is the face itself: there is no other exit
}

}  // namespace

int exitOfTurn(const LatticeTet& corners, const NormalSigns& signs, CornerMask simplex,
               Direction d1, Direction d2) noexcept {
  std::array<int, 3> candidates{};
  std::size_t count = 0;
  for (int face = 0; face < 4; ++face) {
    if (!contains(simplex, face) && signs.dot(face, d2) < 0) candidates[count++] = face;
  }
  if (count == 0) return kStaysInside;
  if (count == 1) return candidates[0];
  const Direction d3 = cross(d1, d2);
  for (std::size_t i = 0; i < count; ++i) {
    if (planeLeavesThrough(corners, simplex, candidates[i], d3)) return candidates[i];
  }
  return kNoExit;
}

namespace {

/// Sign of det(a - z, b - z, d1), where z is shifted infinitesimally in direction d2: on which side
/// of the edge from a to b the line passes. a and b are given relative to z.
int sideOfEdge(const LatticePoint& a, const LatticePoint& b, Direction d1, Direction d2) noexcept {
  const int side = sign(crossComponent(a, b, static_cast<std::size_t>(axisOf(d1)))) * signOf(d1);
  if (side != 0) return side;
  // d/de det(a - z - e d2, b - z - e d2, d1) = det(b - a, d2, d1) = (b - a).(d2 x d1)
  return stepSign(a, b, cross(d2, d1));
}

}  // namespace

int exitOfLine(const LatticeTet& corners, const NormalSigns& signs, const GridPoint& z,
               std::int64_t unit, Direction d1, Direction d2, int entered) noexcept {
  LatticeTet relative = corners;
  for (LatticePoint& corner : relative) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] -= z[k] * unit;
  }
  for (int face = 0; face < 4; ++face) {
    // The line leaves through a face that it crosses against the inward normal; inside the triangle
    // all three sides are then negative, or zero on its rim, where either face will do.
    if (face == entered || signs.dot(face, d1) >= 0) continue;
    const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
    const LatticePoint& a = at(relative, f[0]);
    const LatticePoint& b = at(relative, f[1]);
    const LatticePoint& c = at(relative, f[2]);
    if (sideOfEdge(a, b, d1, d2) <= 0 && sideOfEdge(b, c, d1, d2) <= 0 &&
        sideOfEdge(c, a, d1, d2) <= 0) {
      return face;
    }
  }
  return kNoExit;
}

}  // namespace hexhex::lattice
