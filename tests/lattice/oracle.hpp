// The predicates of the lattice by determinants over integers of any width: slow, and obvious
// enough to judge the fast ones.
#pragma once

#include <array>
#include <cstdint>

#include <boost/multiprecision/cpp_int.hpp>

#include <lattice/tet_geometry.hpp>

namespace hexhex::testing {

using namespace lattice;

template <unsigned kBits>
using FixedInteger = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<kBits, kBits, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, void>,
    boost::multiprecision::et_off>;
/// Wide enough for everything in the tests, products of two determinants of infinitesimally moved
/// points included.
using BigInteger = FixedInteger<2048>;
/// Wide enough for every determinant of lattice points.
using Integer256 = FixedInteger<256>;

template <class Integer>
using Point = std::array<Integer, 3>;
template <class Integer>
using Tet = std::array<Point<Integer>, 4>;

template <class Integer>
int signum(const Integer& a) {
  return a > 0 ? 1 : (a < 0 ? -1 : 0);
}

inline BigInteger toBig(Int128 a) {
  return BigInteger(static_cast<std::int64_t>(a >> 64)) * (BigInteger(1) << 64) +
         static_cast<std::uint64_t>(a);
}

/// The point times 2^shift.
template <class Integer>
Point<Integer> widened(const LatticePoint& p, int shift = 0) {
  const Integer scale = Integer(1) << shift;
  return {Integer(p[0]) * scale, Integer(p[1]) * scale, Integer(p[2]) * scale};
}
template <class Integer>
Tet<Integer> widened(const LatticeTet& tet, int shift = 0) {
  return {widened<Integer>(tet[0], shift), widened<Integer>(tet[1], shift),
          widened<Integer>(tet[2], shift), widened<Integer>(tet[3], shift)};
}

inline LatticePoint vectorOf(Direction d) {
  LatticePoint v{};
  v[static_cast<std::size_t>(axisOf(d))] = signOf(d);
  return v;
}

inline LatticePoint latticePoint(const GridPoint& z, std::int64_t unit) {
  return {z[0] * unit, z[1] * unit, z[2] * unit};
}

template <class Integer>
void move(Point<Integer>& p, const Integer& distance, Direction d) {
  p[static_cast<std::size_t>(axisOf(d))] += distance * signOf(d);
}

/// det(b - a, c - a, d - a)
template <class Integer>
Integer determinant(const Point<Integer>& a, const Point<Integer>& b, const Point<Integer>& c,
                    const Point<Integer>& d) {
  const Point<Integer> u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Point<Integer> v = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const Point<Integer> w = {d[0] - a[0], d[1] - a[1], d[2] - a[2]};
  return u[0] * (v[1] * w[2] - v[2] * w[1]) - v[0] * (u[1] * w[2] - u[2] * w[1]) +
         w[0] * (u[1] * v[2] - u[2] * v[1]);
}

template <class Integer>
Integer determinant(const Tet<Integer>& tet) {
  return determinant<Integer>(tet[0], tet[1], tet[2], tet[3]);
}

/// Barycentric coordinates of p times the determinant of the tet.
template <class Integer>
std::array<Integer, 4> barycentric(const Tet<Integer>& tet, const Point<Integer>& p) {
  std::array<Integer, 4> coordinates;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    Tet<Integer> replaced = tet;
    replaced[corner] = p;
    coordinates[corner] = determinant<Integer>(replaced);
  }
  return coordinates;
}

/// The simplex of a positive tet whose interior contains p, or kNoSimplex.
template <class Integer>
CornerMask locate(const Tet<Integer>& tet, const Point<Integer>& p) {
  const std::array<Integer, 4> coordinates = barycentric<Integer>(tet, p);
  CornerMask simplex = kNoSimplex;
  for (int corner = 0; corner < 4; ++corner) {
    const int s = signum(coordinates[static_cast<std::size_t>(corner)]);
    if (s < 0) return kNoSimplex;
    if (s > 0) simplex = static_cast<CornerMask>(simplex | cornerBit(corner));
  }
  return simplex;
}

/// 2^-200 is infinitesimal for the predicates: no determinant of lattice points, below 2^187,
/// outweighs it. Points with one or two orders of it are represented times 2^200 or 2^400.
inline constexpr int kInfinitesimalBits = 200;

/// locate() of p + e d1 with infinitesimal e.
inline CornerMask locateNear(const LatticeTet& tet, const LatticePoint& p, Direction d1) {
  Point<BigInteger> moved = widened<BigInteger>(p, kInfinitesimalBits);
  move(moved, BigInteger(1), d1);
  return locate(widened<BigInteger>(tet, kInfinitesimalBits), moved);
}

/// locate() of p + e d1 + e^2 d2 with infinitesimal e.
inline CornerMask locateNear(const LatticeTet& tet, const LatticePoint& p, Direction d1,
                             Direction d2) {
  Point<BigInteger> moved = widened<BigInteger>(p, 2 * kInfinitesimalBits);
  move(moved, BigInteger(BigInteger(1) << kInfinitesimalBits), d1);
  move(moved, BigInteger(1), d2);
  return locate(widened<BigInteger>(tet, 2 * kInfinitesimalBits), moved);
}

/// Derivatives of barycentric() in direction d: scalar products with the inward normals.
template <class Integer>
std::array<Integer, 4> barycentricSlopes(const Tet<Integer>& tet, Direction d) {
  Point<Integer> moved = tet[0];
  move(moved, Integer(1), d);
  const std::array<Integer, 4> before = barycentric<Integer>(tet, tet[0]);
  std::array<Integer, 4> slopes = barycentric<Integer>(tet, moved);
  for (std::size_t k = 0; k < 4; ++k) slopes[k] -= before[k];
  return slopes;
}

/// A point moves so that its barycentric coordinates are values + t slopes. The faces (a bit for
/// each opposite corner) through which it leaves the closed cone that is bounded by `faces`;
/// several if it leaves through an edge.
inline CornerMask exitFaces(const std::array<BigInteger, 4>& values,
                            const std::array<BigInteger, 4>& slopes, CornerMask faces) {
  CornerMask exits = 0;
  for (int f = 0; f < 4; ++f) {
    const auto face = static_cast<std::size_t>(f);
    if (!contains(faces, f) || slopes[face] >= 0) continue;
    bool inside = true;  // when t = -values[face] / slopes[face]
    for (int g = 0; g < 4; ++g) {
      const auto other = static_cast<std::size_t>(g);
      if (!contains(faces, g)) continue;
      inside = inside && values[face] * slopes[other] - values[other] * slopes[face] >= 0;
    }
    if (inside) exits = static_cast<CornerMask>(exits | cornerBit(f));
  }
  return exits;
}

/// Right answers to exitOfLine(), as bits; 0 for kNoExit.
inline CornerMask exitsOfLine(const LatticeTet& corners, const LatticePoint& p, Direction d1,
                              Direction d2) {
  const Tet<BigInteger> tet = widened<BigInteger>(corners, kInfinitesimalBits);
  Point<BigInteger> shifted = widened<BigInteger>(p, kInfinitesimalBits);
  move(shifted, BigInteger(1), d2);
  return exitFaces(barycentric<BigInteger>(tet, shifted), barycentricSlopes<BigInteger>(tet, d1),
                   kWholeTet);
}

/// Right answers to exitOfTurn(), as bits; 0 for kStaysInside.
inline CornerMask exitsOfTurn(const LatticeTet& corners, CornerMask simplex, Direction d1,
                              Direction d2) {
  const Tet<BigInteger> tet = widened<BigInteger>(corners);
  return exitFaces(barycentricSlopes<BigInteger>(tet, d1), barycentricSlopes<BigInteger>(tet, d2),
                   static_cast<CornerMask>(kWholeTet ^ simplex));
}

}  // namespace hexhex::testing
