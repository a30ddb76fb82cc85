// Gaps between quads and a surface are closed from both sides.
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <base/vector3.hpp>
#include <improve/closing.hpp>

#include "improve/improved.hpp"
#include "mesh/grid_meshes.hpp"

namespace hexhex::test {

namespace improvement = hexhex::improvement;

namespace closing {

const std::vector<Quad> kQuad = {{0, 1, 2, 3}};
constexpr std::array<double, 4> kCentre = {0.25, 0.25, 0.25, 0.25};

/// A ball with labels of a cube: its tets are half as long as the cells.
TetMap ball(std::size_t cells) {
  TetMap map = hexhex::testing::identityMap(2 * cells);
  for (Vec3& point : map.points) {
    double largest = 0;
    for (double& x : point) {
      x = x / static_cast<double>(cells) - 1;
      largest = std::max(largest, std::abs(x));
    }
    const double size = length(point);
    if (size > 0) point = times(largest / size, point);
  }
  for (auto& corners : map.parameters) {
    for (Vec3& corner : corners) corner = times(0.5, corner);
  }
  return map;
}

}  // namespace closing

TEST(Closing, MovesAllCornersByWhatTheCentreLacks) {
  const std::vector<std::uint8_t> isHeld(5, 0);
  const std::vector<improvement::Gap> gaps = {{0, closing::kCentre, {0, 0, 3}}};
  const Array<Vec3> moves = improvement::closingMoves(gaps, closing::kQuad, isHeld, 2);
  for (Index v = 0; v < 4; ++v) EXPECT_NEAR(moves[v][2], 1, 1e-12);
  EXPECT_EQ(moves[4], Vec3{});
  for (const Vec3& move : improvement::closingMoves(gaps, closing::kQuad, isHeld, 3)) {
    EXPECT_EQ(move, Vec3{});
  }
}

TEST(Closing, LeavesHeldCornersToTheOthers) {
  const std::vector<std::uint8_t> isHeld = {1, 0, 0, 0};
  const std::vector<improvement::Gap> gaps = {{0, closing::kCentre, {0, -3, 0}}};
  const Array<Vec3> moves = improvement::closingMoves(gaps, closing::kQuad, isHeld, 2);
  EXPECT_EQ(moves[0], Vec3{});
  for (Index v = 1; v < 4; ++v) EXPECT_NEAR(moves[v][1], -4.0 / 3, 1e-9);
}

/// A corner that is already on the other side moves no farther than the limit allows.
TEST(Closing, ComesToAStopBetweenBothSides) {
  const std::vector<std::uint8_t> isHeld(4, 0);
  const std::vector<improvement::Gap> gaps = {{0, closing::kCentre, {0, 0, 2.5}},
                                              {0, {1, 0, 0, 0}, {0, 0, -1.5}}};
  const Array<Vec3> moves = improvement::closingMoves(gaps, closing::kQuad, isHeld, 2);
  EXPECT_LE(moves[0][2], 0.5 + 1e-9);
  double centre = 0;
  for (const Vec3& move : moves) centre += move[2] / 4;
  EXPECT_NEAR(centre, 0.5, 1e-6);
}

/// Of quads with corners on a sphere, one covers the mean solid angle or more. Its chords are about
/// as deep as the circle around a square of that size, or deeper: no such mesh is nearer.
TEST(Closing, BringsABallNearerThanAnyMeshWithVerticesOnIt) {
  constexpr std::size_t kCells = 4;
  const TetMap map = closing::ball(kCells);
  HexMesh mesh = extracted(map, 1);
  ASSERT_EQ(mesh.cells.size(), kCells * kCells * kCells);
  ImproveOptions options;
  options.slack = 0;
  HexMesh held = mesh;
  const double onSphere = improvedOn(held, map, options).distanceAfter.hausdorff();
  const ImproveReport report = improvedOn(mesh, map);
  const double angle = 4 * std::numbers::pi / (6 * kCells * kCells);
  const double depth =
      (1 - 1 / std::tan((angle + 2 * std::numbers::pi) / 8)) / (2 * std::numbers::sqrt3);
  EXPECT_GT(onSphere, depth);
  EXPECT_LT(report.distanceAfter.hausdorff(), 0.6 * depth);
  EXPECT_TRUE(report.after.allPositive());
  EXPECT_GT(report.offSurface, 0U);
  HexMesh four = extracted(map, 1);
  improvedOn(four, map, {}, 4);
  EXPECT_EQ(four.points, mesh.points);
}

}  // namespace hexhex::test
