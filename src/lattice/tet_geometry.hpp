// One tet in its chart, on the dyadic lattice: corners, faces, and the exact predicates of
// Appendix A.
//
// Coordinates are 64-bit integers: parameters times a power of two, `unit`. They stay below 2^60 in
// magnitude, so differences fit 61 bits, components of face normals (2x2 minors) 124 bits, and
// orientation determinants 187 bits.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include <hexhex/types.hpp>

#include <base/vector3.hpp>
#include <lattice/direction.hpp>
#include <lattice/wide_int.hpp>

namespace hexhex::lattice {

/// A parameter times `unit`.
using LatticePoint = std::array<std::int64_t, 3>;
using LatticeTet = std::array<LatticePoint, 4>;

/// A simplex of a tet as the set of its corners: bit i for corner i. 0 is no simplex, 15 the tet.
using CornerMask = std::uint8_t;
inline constexpr CornerMask kNoSimplex = 0;
inline constexpr CornerMask kWholeTet = 15;

[[nodiscard]] constexpr int dimension(CornerMask mask) noexcept {
  // A table, as not every target counts bits in one instruction.
  constexpr std::array<std::int8_t, 16> kDimensions = {-1, 0, 0, 1, 0, 1, 1, 2,
                                                       0,  1, 1, 2, 1, 2, 2, 3};
  return kDimensions[mask];
}
[[nodiscard]] constexpr bool contains(CornerMask mask, int corner) noexcept {
  return ((mask >> corner) & 1) != 0;
}
[[nodiscard]] constexpr CornerMask cornerBit(int corner) noexcept {
  return static_cast<CornerMask>(1 << corner);
}
/// The face opposite a corner.
[[nodiscard]] constexpr CornerMask faceMask(int opposite) noexcept {
  return static_cast<CornerMask>(kWholeTet ^ (1 << opposite));
}

/// The corner opposite a face.
[[nodiscard]] constexpr int oppositeCorner(CornerMask face) noexcept {
  return std::countr_zero(unsigned{kWholeTet} ^ face);
}
/// The first and last corner of a simplex: the only one of a vertex, the two ends of an edge.
[[nodiscard]] constexpr std::size_t firstCorner(CornerMask simplex) noexcept {
  return static_cast<std::size_t>(std::countr_zero(unsigned{simplex}));
}
[[nodiscard]] constexpr std::size_t lastCorner(CornerMask simplex) noexcept {
  return static_cast<std::size_t>(std::bit_width(unsigned{simplex}) - 1);
}

/// Corners of the face opposite corner f, in the order in which the right-hand normal points to
/// corner f, i.e. into the (positive) tet.
inline constexpr std::array<std::array<int, 3>, 4> kFaceCorners = {
    {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

/// Component `axis` of the cross product a x b, exact.
[[nodiscard]] constexpr Int128 crossComponent(const LatticePoint& a, const LatticePoint& b,
                                              std::size_t axis) noexcept {
  const std::size_t j = axis == 2 ? 0 : axis + 1;
  const std::size_t k = axis == 0 ? 2 : axis - 1;
  return static_cast<Int128>(a[j]) * b[k] - static_cast<Int128>(a[k]) * b[j];
}

/// det(b - a, c - a, d - a), exact: six times the signed volume, times unit^3. Positive if d lies
/// on the side of the triangle a b c to which its right-hand normal points (ori3D of the paper,
/// with the sign that makes tets of a valid map positive).
[[nodiscard]] Int192 orientationDeterminant(const LatticePoint& a, const LatticePoint& b,
                                            const LatticePoint& c, const LatticePoint& d) noexcept;

/// det(u, v, w) in floating point.
struct RoundedDeterminant {
  double value = 0;
  double magnitude = 0;  ///< sum of the magnitudes of all products

  RoundedDeterminant(const Vec3& u, const Vec3& v, const Vec3& w) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t j = axis == 2 ? 0 : axis + 1;
      const std::size_t k = axis == 0 ? 2 : axis - 1;
      const double first = u[j] * v[k];
      const double second = u[k] * v[j];
      value += (first - second) * w[axis];
      magnitude += (std::abs(first) + std::abs(second)) * std::abs(w[axis]);
    }
  }
  /// Whether the sign is certified, if each component carries at most one rounding.
  [[nodiscard]] bool hasCertifiedSign() const noexcept {
    // Each of the six products of three factors carries three roundings of its factors, two
    // multiplications, and up to three additions: at most 8 roundings of relative size 2^-53, hence
    // an error below 8.1 * 2^-53 < 2^-49 times the sum of magnitudes, which itself is computed to
    // within a factor 1 + 2^-49. 2^-48 leaves a factor of two.
    constexpr double kRelativeError = 0x1p-48;
    return std::abs(value) > kRelativeError * magnitude;
  }
};

/// A sum of products of three multiples of a power of two is exact in floating point if the sum of
/// their magnitudes is below this: no product and no partial sum needs more than 53 bits. (Factors
/// that need more, and were rounded, are then multiplied by zero.)
/// @param bits  all factors, or-ed
[[nodiscard]] inline double exactBelow(std::int64_t bits) noexcept {
  // 2^(52 + 3 e) for multiples of 2^e.
  const int e = std::countr_zero(static_cast<std::uint64_t>(bits));
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + 52 + 3 * e) << 52);
}

/// Sign of orientationDeterminant(): a floating-point filter, then exact arithmetic.
[[nodiscard]] int orientation(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                              const LatticePoint& d) noexcept;

/// On which side of a face of a positive tet a point lies: 1 on the tet's side, 0 in the face's
/// plane, -1 beyond it. Exact.
[[nodiscard]] inline int sideOfFace(const LatticeTet& tet, std::size_t face,
                                    const LatticePoint& point) noexcept {
  const std::array<int, 3>& f = kFaceCorners[face];
  return orientation(tet[static_cast<std::size_t>(f[0])], tet[static_cast<std::size_t>(f[1])],
                     tet[static_cast<std::size_t>(f[2])], point);
}

/// The simplex of a tet whose interior contains a point, or kNoSimplex outside. (Algorithm 3)
/// @param sideOf  sideOf(face): on which side of it the point lies, as sideOfFace()
template <class SideOf>
[[nodiscard]] CornerMask simplexBySides(const SideOf& sideOf) noexcept {
  CornerMask simplex = kNoSimplex;
  for (std::size_t face = 0; face < 4; ++face) {
    const int side = sideOf(face);
    if (side < 0) return kNoSimplex;
    // A point off the face opposite a corner has a positive barycentric coordinate there.
    if (side > 0) simplex = static_cast<CornerMask>(simplex | cornerBit(static_cast<int>(face)));
  }
  return simplex;
}

/// The same for a positive tet, exactly.
[[nodiscard]] inline CornerMask simplexOf(const LatticeTet& tet,
                                          const LatticePoint& point) noexcept {
  return simplexBySides([&](std::size_t face) { return sideOfFace(tet, face, point); });
}
/// The same for a grid point.
[[nodiscard]] inline CornerMask simplexOf(const LatticeTet& tet, const GridPoint& z,
                                          std::int64_t unit) noexcept {
  return simplexOf(tet, LatticePoint{z[0] * unit, z[1] * unit, z[2] * unit});
}

/// Signs of the components of a tet's four inward face normals. They decide exactly how directions
/// lie relative to faces, which is all that Holder (A.2) and Casing (A.3) ask.
class NormalSigns {
 public:
  NormalSigns() = default;
  explicit NormalSigns(const LatticeTet& corners) noexcept;

  /// Sign of the scalar product of the inward normal of face f with a direction.
  [[nodiscard]] constexpr int dot(int face, Direction d) const noexcept {
    const unsigned bits = (packed_ >> (2 * (3 * face + axisOf(d)))) & 3U;
    return (static_cast<int>(bits) - 1) * signOf(d);
  }

 private:
  std::uint32_t packed_ = 0;  // 2 bits each: sign + 1
};

/// The simplex of the tet into which the ray from an inner point of simplex `generator` in
/// direction d1 leads, or kNoSimplex if the ray leaves the tet at once. (Algorithm 4)
[[nodiscard]] CornerMask holder(const NormalSigns& signs, CornerMask generator,
                                Direction d1) noexcept;

/// The simplex of the tet into which the quarter plane spanned by d1 and d2 leads, close to the ray
/// in direction d1, from an inner point of simplex `generator`; kNoSimplex if it leaves the tet.
/// (Algorithm 5, for holder and casing in one)
[[nodiscard]] CornerMask casing(const NormalSigns& signs, CornerMask generator, Direction d1,
                                Direction d2) noexcept;

/// Result of the exit searches below: no face is crossed.
inline constexpr int kStaysInside = -1;
/// ... or the search fails, which a valid map excludes.
inline constexpr int kNoExit = -2;

/// Turning from direction d1 to the perpendicular direction d2 around an inner point of `simplex`,
/// where d1 (and the beginning of the turn) lies in the tet: the face through which the turn leaves
/// the tet before it reaches d2, or kStaysInside. A turn that leaves through an edge may take
/// either of its faces. (Algorithm 7)
[[nodiscard]] int exitOfTurn(const LatticeTet& corners, const NormalSigns& signs,
                             CornerMask simplex, Direction d1, Direction d2) noexcept;

/// Going from grid point z in direction d1, shifted infinitesimally in direction d2: the face
/// through which the line leaves the tet, or kNoExit if the line misses the tet. Never face
/// `entered` (-1: none). (Algorithm 9)
[[nodiscard]] int exitOfLine(const LatticeTet& corners, const NormalSigns& signs,
                             const GridPoint& z, std::int64_t unit, Direction d1, Direction d2,
                             int entered) noexcept;

}  // namespace hexhex::lattice
