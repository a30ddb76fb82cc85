// Signs of determinants: in doubles with an error bound (Shewchuk 1997, "Adaptive precision
// floating-point arithmetic and fast robust geometric predicates"), in integers if it fails.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <fill/exact_signs.hpp>

#include <base/vector3.hpp>
#include <mesh/exact_numbers.hpp>

namespace hexhex::fill {
namespace {

using mesh::BigInteger;

/// The differences of points from the first one, as integers with a common scale.
template <std::size_t n>
std::array<std::array<BigInteger, 3>, n> exactDifferences(const Vec3& from,
                                                          const std::array<Vec3, n>& points) {
  int least = std::numeric_limits<int>::max();
  const auto look = [&least](const Vec3& point) {
    for (const double x : point) {
      if (x != 0) least = std::min(least, std::ilogb(x));
    }
  };
  look(from);
  for (const Vec3& point : points) look(point);
  const int shift = std::numeric_limits<double>::digits - least;
  std::array<std::array<BigInteger, 3>, n> result;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result[i][k] = BigInteger(points[i][k], shift) - BigInteger(from[k], shift);
    }
  }
  return result;
}

/// A sum of products whose relative errors have a common bound.
struct Filter {
  double sum = 0;
  double magnitude = 0;

  /// Whether the sign is certain. If all products are 0 and none can have underflowed, the sum is
  /// exactly 0.
  [[nodiscard]] bool tells(double relativeError, bool hasTiny) const noexcept {
    if (hasTiny) return false;
    return std::abs(sum) > relativeError * magnitude || magnitude == 0;
  }
  [[nodiscard]] int sign() const noexcept { return sum > 0 ? 1 : (sum < 0 ? -1 : 0); }
};

/// Whether products of three such numbers may underflow or overflow.
bool isTiny(const Vec3& v) noexcept {
  constexpr double kSmall = 1e-90;
  constexpr double kLarge = 1e90;
  return std::any_of(v.begin(), v.end(), [](double x) {
    return x != 0 && !(std::abs(x) > kSmall && std::abs(x) < kLarge);
  });
}

constexpr double kHalfEpsilon = std::numeric_limits<double>::epsilon() / 2;
// Each difference, product and sum is rounded; these bounds exceed the total.
constexpr double kSpaceError = 16 * kHalfEpsilon;
constexpr double kPlaneError = 8 * kHalfEpsilon;

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = minus(b, a);
  const Vec3 v = minus(c, a);
  const Vec3 w = minus(d, a);
  Filter filter;
  for (std::size_t k = 0; k < 3; ++k) {
    const double left = v[(k + 1) % 3] * w[(k + 2) % 3];
    const double right = v[(k + 2) % 3] * w[(k + 1) % 3];
    filter.sum += u[k] * (left - right);
    filter.magnitude += std::abs(u[k]) * (std::abs(left) + std::abs(right));
  }
  if (filter.tells(kSpaceError, isTiny(u) || isTiny(v) || isTiny(w))) return filter.sign();
  const auto [x, y, z] = exactDifferences<3>(a, {b, c, d});
  return (x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) +
          x[2] * (y[0] * z[1] - y[1] * z[0]))
      .sign();
}

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t axis) {
  const std::size_t i = (axis + 1) % 3;
  const std::size_t j = (axis + 2) % 3;
  const Vec3 u = minus(b, a);
  const Vec3 v = minus(c, a);
  const double left = u[i] * v[j];
  const double right = u[j] * v[i];
  const Filter filter{left - right, std::abs(left) + std::abs(right)};
  if (filter.tells(kPlaneError, isTiny(u) || isTiny(v))) return filter.sign();
  const auto [x, y] = exactDifferences<2>(a, {b, c});
  return (x[i] * y[j] - x[j] * y[i]).sign();
}

}  // namespace hexhex::fill
