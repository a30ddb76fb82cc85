// Where hex edges cross edges of the tets: near the exact place, and the same from both ends, for
// either order of corners and in every chart.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <curved/intersections.hpp>

#include "lattice/random.hpp"

namespace hexhex::test {

using namespace curved;

namespace {

using Rational = boost::multiprecision::cpp_rational;
using testing::LatticeRandom;

/// Corners on opposite sides of the line, with all of it in one plane.
struct EdgeCorners {
  lattice::LatticePoint a;
  lattice::LatticePoint b;
};

EdgeCorners cornersBesideLine(std::int64_t unit, LatticeRandom& random) {
  const std::int64_t p = random.between(-1000, 1000);
  const std::int64_t q = p == 0 ? random.between(1, 1000) : random.between(-1000, 1000);
  const std::int64_t before = random.between(1, unit / 512);
  const std::int64_t behind = random.between(1, unit / 512);
  return {{random.between(-2 * unit, 2 * unit), -before * p, -before * q},
          {random.between(-2 * unit, 2 * unit), behind * p, behind * q}};
}

Rational exactPlace(const EdgeCorners& corners, std::int64_t unit) {
  const std::size_t axis = corners.a[1] != 0 ? 1 : 2;
  const Rational fromA = std::abs(corners.a[axis]);
  const Rational fromB = std::abs(corners.b[axis]);
  return (fromB * corners.a[0] + fromA * corners.b[0]) / (fromA + fromB) / unit;
}

/// Permutes axes cyclically, and changes signs across the line.
lattice::LatticePoint inOtherChart(const lattice::LatticePoint& point, std::size_t axis,
                                   bool flipped) {
  lattice::LatticePoint result;
  for (std::size_t k = 0; k < 3; ++k) {
    result[(k + axis) % 3] = flipped && k > 0 ? -point[k] : point[k];
  }
  return result;
}

lattice::LatticePoint fromOtherEnd(lattice::LatticePoint point, std::int64_t unit) {
  point[0] = unit - point[0];
  return point;
}

TEST(EdgeIntersection, IsTheSameHoweverItIsSeen) {
  LatticeRandom random(4711);
  int inside = 0;
  for (int i = 0; i < testing::cases(100000) + 5000 && !HasFailure(); ++i) {
    const std::int64_t unit = std::int64_t{1} << (random.oneIn(2) ? 18 : 44);
    const EdgeCorners corners = cornersBesideLine(unit, random);
    const Rational exact = exactPlace(corners, unit);
    if (exact <= 0 || exact >= 1) continue;
    ++inside;
    const auto [a, b] = corners;
    const EdgeIntersection intersection = crossTetEdge(a, b, 0, unit);
    EXPECT_LT(std::abs(intersection.parameter - exact.convert_to<double>()), 0x1p-48);
    EXPECT_LT(std::abs(intersection.shares[0] + intersection.shares[1] - 1), 0x1p-51);
    const EdgeIntersection swapped = crossTetEdge(b, a, 0, unit);
    EXPECT_TRUE(swapped.parameter == intersection.parameter &&
                swapped.shares[0] == intersection.shares[1] &&
                swapped.shares[1] == intersection.shares[0]);
    const EdgeIntersection back =
        crossTetEdge(fromOtherEnd(a, unit), fromOtherEnd(b, unit), 0, unit);
    EXPECT_TRUE(back.parameter == 1 - intersection.parameter &&
                intersection.parameter == 1 - back.parameter && back.shares == intersection.shares);
    const auto axis = static_cast<std::size_t>(random.between(0, 2));
    const bool flipped = random.oneIn(2);
    const EdgeIntersection turned =
        crossTetEdge(inOtherChart(a, axis, flipped), inOtherChart(b, axis, flipped), axis, unit);
    EXPECT_TRUE(turned.parameter == intersection.parameter && turned.shares == intersection.shares);
  }
  EXPECT_GT(inside, 100);
}

}  // namespace
}  // namespace hexhex::test
