// Which share of sharp edges the mesh follows, where it is known.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>

#include "mesh/grid_meshes.hpp"
#include "support/effort.hpp"

namespace hexhex::test {

namespace followed {

ImproveReport reportOf(const TetMap& map) {
  Context context(2);
  HexMesh mesh = extract(map, {}, context);
  ImproveOptions options;
  options.slack = 0;  // vertices stay on the surface, and curves on edges of the object
  return improve(mesh, map, options, context);
}

}  // namespace followed

TEST(FollowedCurves, AllOfABox) {
  const ImproveReport report = followed::reportOf(hexhex::testing::identityMap(4));
  EXPECT_NEAR(report.curveLength, 12 / std::sqrt(3.0), 1e-9);
  EXPECT_EQ(report.curvesFollowed, 1);
}

/// A roof whose ridge goes over the top of a box from corner to corner, across all cells.
TEST(FollowedCurves, NotTheRidgeThatCellsLieAcross) {
  constexpr double kSlope = 0.8;
  TetMap map = hexhex::testing::identityMap(6);
  for (Vec3& point : map.points) {
    point[2] -= kSlope * std::abs(point[0] - point[1]) * point[2] / 6;
  }
  const ImproveReport report = followed::reportOf(map);
  const double ridge = std::sqrt(2.0);
  const double others = 4 + 2 + 2 * (1 - kSlope) + 4 * std::sqrt(1 + kSlope * kSlope);
  EXPECT_NEAR(report.curveLength, (others + ridge) / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(report.curvesFollowed, others / (others + ridge), 0.01);
}

TEST(FollowedCurves, ASmoothBodyHasNone) {
  HEXHEX_LARGE_TEST();
  TetMap map = hexhex::testing::identityMap(8);
  for (Vec3& point : map.points) {
    double largest = 0;
    double square = 0;
    for (double& x : point) {
      x -= 4;
      largest = std::max(largest, std::abs(x));
      square += x * x;
    }
    for (double& x : point) x *= square > 0 ? largest / std::sqrt(square) : 0;
  }
  const ImproveReport report = followed::reportOf(map);
  EXPECT_EQ(report.curveLength, 0);
  EXPECT_EQ(report.curvesFollowed, 1);
}

}  // namespace hexhex::test
