// Basic vector arithmetic, as much as measuring takes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

#include <base/lanes.hpp>

namespace hexhex {

[[nodiscard]] constexpr Vec3 minus(const Vec3& a, const Vec3& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

[[nodiscard]] constexpr Vec3 plus(const Vec3& a, const Vec3& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

[[nodiscard]] constexpr Vec3 times(double factor, const Vec3& a) noexcept {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

/// Exact vectors: lattice points, far from overflow.
using IntegerVector = std::array<std::int64_t, 3>;

[[nodiscard]] constexpr IntegerVector operator+(const IntegerVector& a,
                                                const IntegerVector& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

[[nodiscard]] constexpr IntegerVector operator-(const IntegerVector& a,
                                                const IntegerVector& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

[[nodiscard]] constexpr IntegerVector operator-(const IntegerVector& a) noexcept {
  return {-a[0], -a[1], -a[2]};
}

[[nodiscard]] constexpr double dot(const Vec3& a, const Vec3& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

[[nodiscard]] constexpr Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Six times the volume of the tet spanned by three vectors.
[[nodiscard]] constexpr double tripleProduct(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  return dot(a, cross(b, c));
}

/// Dihedral angle of a tet at the edge between two of its corners, as if the tet were positive.
[[nodiscard]] inline double dihedralAngle(const std::array<Vec3, 4>& tet, std::size_t a,
                                          std::size_t b) noexcept {
  std::size_t c = 0;
  while (c == a || c == b) ++c;
  const std::size_t d = 6 - a - b - c;
  const Vec3 edge = minus(tet[b], tet[a]);
  const Vec3 left = cross(edge, minus(tet[c], tet[a]));
  const Vec3 right = cross(edge, minus(tet[d], tet[a]));
  const Vec3 normal = cross(left, right);
  return std::atan2(std::sqrt(dot(normal, normal)), dot(left, right));
}

/// The axis of the component of largest magnitude, the first if there are several.
[[nodiscard]] inline std::size_t dominantAxis(const Vec3& v) noexcept {
  // As arithmetic, since a branch could not be predicted.
  const std::size_t first = std::abs(v[1]) > std::abs(v[0]) ? 1 : 0;
  const std::size_t isThird = std::abs(v[2]) > std::max(std::abs(v[0]), std::abs(v[1])) ? 1 : 0;
  return first + isThird * (2 - first);
}

/// Nearest integer (ties to even) of a number below 2^52 in magnitude, like std::nearbyint, but
/// without a call.
[[nodiscard]] inline double nearestInteger(double x) noexcept {
  const double large = std::copysign(0x1p52, x);
  return (x + large) - large;
}

/// 0 if a rounded sum is exactly a + b, otherwise positive: if it is not, the sum minus the larger
/// number is exact and differs from the smaller one (Dekker).
[[nodiscard]] inline double restOfSum(double sum, double a, double b) noexcept {
  return std::abs((sum - a) - b) + std::abs((sum - b) - a);
}

[[nodiscard]] inline bool isFinite(const Vec3& v) noexcept {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

/// Whether all coordinates of all corners are finite.
[[nodiscard]] inline bool isFinite(const TetParameters& corners) noexcept {
  // 0 times a number is 0 only if the number is finite. Two overlapping pairs cover all three
  // coordinates.
  Pair rest = {0, 0};
  for (const Vec3& u : corners) rest += 0 * loadPair(&u[0]) + 0 * loadPair(&u[1]);
  return rest[0] + rest[1] == 0;
}

[[nodiscard]] inline double length(const Vec3& a) noexcept { return std::sqrt(dot(a, a)); }

/// Unit normals turn by more than an angle, in radians, if their cosine is below this. At the angle
/// itself they do not, however they are rounded: 1e-12 of a cosine is about a microradian.
[[nodiscard]] inline double leastCosine(double angle) noexcept { return std::cos(angle) - 1e-12; }

/// The mean of points.
[[nodiscard]] inline Vec3 centreOf(std::span<const Vec3> points) noexcept {
  Vec3 sum{};
  for (const Vec3& point : points) sum = plus(sum, point);
  for (double& x : sum) x /= static_cast<double>(points.size());
  return sum;
}

}  // namespace hexhex
