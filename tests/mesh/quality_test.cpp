// The scaled Jacobian of cells for which it is known, and its summary.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <hexhex/quality.hpp>

#include <mesh/grid_meshes.hpp>

namespace hexhex {
namespace {

using testing::gridMesh;
using testing::Random;
using testing::reversed;

std::array<Vec3, 8> cornersOf(const HexMesh& mesh) {
  std::array<Vec3, 8> corners;
  for (std::size_t k = 0; k < 8; ++k) corners[k] = mesh.points[mesh.cells[0][k]];
  return corners;
}

/// The unit cube under a linear map with these columns.
std::array<Vec3, 8> parallelepiped(const Vec3& a, const Vec3& b, const Vec3& c) {
  std::array<Vec3, 8> corners = cornersOf(gridMesh(1));
  for (Vec3& p : corners) {
    const Vec3 q = p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = q[0] * a[k] + q[1] * b[k] + q[2] * c[k];
  }
  return corners;
}

TEST(ScaledJacobian, OfBoxesIsOne) {
  EXPECT_DOUBLE_EQ(scaledJacobian(parallelepiped({1, 0, 0}, {0, 1, 0}, {0, 0, 1})), 1);
  EXPECT_DOUBLE_EQ(scaledJacobian(parallelepiped({1e-70, 0, 0}, {0, 1e60, 0}, {0, 0, 3})), 1);
  EXPECT_DOUBLE_EQ(scaledJacobian(parallelepiped({0, 2, 0}, {0, 0, 5}, {7, 0, 0})), 1);
}

TEST(ScaledJacobian, OfShearedBoxesIsTheSineOfTheAngle) {
  for (const double degrees : {10.0, 45.0, 90.0, 135.0, 179.0}) {
    const double angle = degrees * 3.141592653589793 / 180;
    EXPECT_NEAR(scaledJacobian(parallelepiped(
                    {3, 0, 0}, {2 * std::cos(angle), 2 * std::sin(angle), 0}, {0, 0, 1})),
                std::sin(angle), 1e-14);
  }
}

TEST(ScaledJacobian, OfInvertedCellsIsNegative) {
  EXPECT_DOUBLE_EQ(scaledJacobian(parallelepiped({1, 0, 0}, {0, 1, 0}, {0, 0, -1})), -1);
  HexMesh mesh = gridMesh(1);
  mesh.cells[0] = reversed(mesh.cells[0]);
  EXPECT_DOUBLE_EQ(scaledJacobian(cornersOf(mesh)), -1);
}

TEST(ScaledJacobian, OfDegenerateCellsIsZero) {
  EXPECT_EQ(scaledJacobian(parallelepiped({1, 0, 0}, {0, 1, 0}, {0, 0, 0})), 0);
  EXPECT_EQ(scaledJacobian(parallelepiped({1, 0, 0}, {0, 1, 0}, {1, 1, 0})), 0);
  EXPECT_EQ(scaledJacobian({}), 0);
  std::array<Vec3, 8> collapsed = cornersOf(gridMesh(1));
  collapsed[1] = collapsed[0];
  EXPECT_EQ(scaledJacobian(collapsed), 0);
  std::array<Vec3, 8> infinite = cornersOf(gridMesh(1));
  infinite[6][1] = INFINITY;
  EXPECT_EQ(scaledJacobian(infinite), 0);
}

struct PlainProducts {
  double corners = 1;  ///< the smallest of eight
  double centre = 1;
};

/// The definition, written as plainly as possible: corners by bits, axis k changes bit k.
PlainProducts plainProducts(const std::array<Vec3, 8>& vtkCorners) {
  const std::array<std::size_t, 8> vtkOfBits = {0, 1, 3, 2, 4, 5, 7, 6};
  const auto corner = [&](std::size_t bits) { return vtkCorners[vtkOfBits[bits]]; };
  const auto product = [](std::array<Vec3, 3> v) {
    for (Vec3& w : v) {
      const double norm = std::hypot(w[0], w[1], w[2]);
      for (double& x : w) x /= norm;
    }
    return v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
           v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
           v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
  };
  PlainProducts result;
  std::array<Vec3, 3> centre = {};
  for (std::size_t bits = 0; bits < 8; ++bits) {
    std::array<Vec3, 3> edges = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t bit = std::size_t{1} << axis;
      for (std::size_t k = 0; k < 3; ++k) {
        edges[axis][k] = corner(bits | bit)[k] - corner(bits & ~bit)[k];
        centre[axis][k] += edges[axis][k];
      }
    }
    result.corners = std::min(result.corners, product(edges));
  }
  result.centre = product(centre);
  return result;
}

TEST(ScaledJacobian, AgreesWithThePlainDefinition) {
  Random random(3);
  int centreDecided = 0;
  for (int i = 0; i < 20000; ++i) {
    std::array<Vec3, 8> corners = cornersOf(gridMesh(1));
    const double amount = random.real() * 6;
    for (Vec3& p : corners) {
      for (double& x : p) x += amount * (random.real() - 0.5);
    }
    const PlainProducts plain = plainProducts(corners);
    EXPECT_NEAR(scaledJacobian(corners), std::min(plain.corners, plain.centre), 1e-12);
    if (plain.centre < plain.corners - 1e-3) ++centreDecided;
  }
  EXPECT_GT(centreDecided, 0);
}

TEST(ScaledJacobians, AreThoseOfTheCells) {
  HexMesh mesh = gridMesh(15);
  Random random(5);
  for (Vec3& p : mesh.points) {
    for (double& x : p) x += 0.4 * random.real();
  }
  Context one(1);
  Context many(3);
  const Array<double> values = scaledJacobians(mesh, one);
  EXPECT_EQ(scaledJacobians(mesh, many), values);
  ASSERT_EQ(values.size(), mesh.cells.size());
  for (std::size_t c = 0; c < values.size(); ++c) {
    std::array<Vec3, 8> corners;
    for (std::size_t k = 0; k < 8; ++k) corners[k] = mesh.points[mesh.cells[c][k]];
    EXPECT_EQ(values[c], scaledJacobian(corners));
  }
}

TEST(QualitySummary, CountsAndSorts) {
  const QualitySummary summary = summarize({1.0, 0.9, 0.89, 0.0, -0.01, -1.0, -0.9, 0.3});
  EXPECT_EQ(summary.minimum, -1.0);
  EXPECT_NEAR(summary.mean, 1.18 / 8, 1e-15);
  EXPECT_EQ(summary.notPositive, 4U);
  std::array<std::uint64_t, 20> histogram{};
  histogram[19] = 2;  // 0.9 and 1
  histogram[18] = 1;
  histogram[13] = 1;
  histogram[10] = 1;
  histogram[9] = 1;
  histogram[1] = 1;
  histogram[0] = 1;
  EXPECT_EQ(summary.histogram, histogram);
}

TEST(QualitySummary, OfNothing) {
  const QualitySummary summary = summarize({});
  EXPECT_EQ(summary.minimum, 0);
  EXPECT_EQ(summary.mean, 0);
  EXPECT_EQ(summary.notPositive, 0U);
}

}  // namespace
}  // namespace hexhex
