// Where lines cross faces, by exact weights.
#include <gtest/gtest.h>

#include <curved/simplex_point.hpp>

#include "extract/support.hpp"
#include "lattice/random.hpp"

namespace hexhex::test {

using namespace curved;

namespace {

using testing::LatticeRandom;

using Point2 = std::array<std::int64_t, 2>;

/// Whether a line through the origin, seen along it, has all corners of a triangle on one side.
bool isBeside(const std::array<Point2, 3>& seen) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& a = seen[i];
    const auto& b = seen[(i + 1) % 3];
    const auto& c = seen[(i + 2) % 3];
    const auto side = [&](std::int64_t x, std::int64_t y) {
      return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    };
    const std::int64_t ofCorner = side(c[0], c[1]);
    const std::int64_t ofLine = side(0, 0);
    if ((ofCorner > 0 && ofLine < 0) || (ofCorner < 0 && ofLine > 0)) return true;
  }
  return false;
}

TEST(SimplexPoint, IsWhereALineCrossesAFace) {
  LatticeRandom random(1);
  int met = 0;
  int missed = 0;
  for (int n = 0; n < cases(20000); ++n) {
    lattice::LatticeTet corners{};
    for (lattice::LatticePoint& corner : corners) {
      for (std::int64_t& x : corner) x = random.between(-5, 5);
    }
    const auto face = static_cast<int>(random.between(0, 3));
    const auto along = static_cast<std::size_t>(random.between(0, 2));
    std::array<Point2, 3> seen{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto f =
          static_cast<std::size_t>(lattice::kFaceCorners[static_cast<std::size_t>(face)][i]);
      seen[i] = Point2{corners[f][(along + 1) % 3], corners[f][(along + 2) % 3]};
    }
    const std::int64_t area = (seen[1][0] - seen[0][0]) * (seen[2][1] - seen[0][1]) -
                              (seen[1][1] - seen[0][1]) * (seen[2][0] - seen[0][0]);
    if (area == 0) continue;  // the face is parallel to the line
    const SimplexPoint point = intersectionWithFace(corners, face, along);
    ASSERT_EQ(point.simplex() == lattice::kNoSimplex, isBeside(seen));
    if (point.simplex() == lattice::kNoSimplex) {
      ++missed;
      continue;
    }
    ++met;
    EXPECT_EQ(point.weights[static_cast<std::size_t>(face)], 0);
    // On the line.
    EXPECT_EQ(point.compare(corners, (along + 1) % 3, 0), 0);
    EXPECT_EQ(point.compare(corners, (along + 2) % 3, 0), 0);
  }
  EXPECT_GT(met, 100);
  EXPECT_GT(missed, 100);
}

}  // namespace

}  // namespace hexhex::test
