// Points of edges in faces: floating point against exact arithmetic, seen from both ends.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <curved/face_crossing.hpp>
#include <gtest/gtest.h>

#include "lattice/random.hpp"

namespace hexhex::test {

namespace {

using testing::Random;

/// Corners on the half-integer grid, anywhere, or nearly on a line: all of them around the origin.
LatticeTet randomCorners(std::int64_t unit, Random& random) {
  LatticeTet corners{};
  const bool onGrid = random.oneIn(3);
  const std::int64_t thickness = random.oneIn(3) ? 3 : 4 * unit;
  for (LatticePoint& corner : corners) {
    for (std::int64_t& coordinate : corner) {
      coordinate = onGrid ? unit / 2 * random.between(-6, 6) : random.between(-4, 4) * unit;
      if (!onGrid) coordinate += random.between(-thickness, thickness);
    }
  }
  return corners;
}

/// Whether the line meets the closed face in one point, by exact arithmetic.
bool meets(const CrossedFace& face, const ChartEdge& edge, std::int64_t unit) {
  LatticePoint line;
  for (std::size_t k = 0; k < 3; ++k) line[k] = edge.z[k] * unit;
  int positive = 0;
  int negative = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Int128 weight = crossComponent(face.corner((i + 1) % 3) - line,
                                         face.corner((i + 2) % 3) - line, axisOf(edge.along));
    positive += weight > 0 ? 1 : 0;
    negative += weight < 0 ? 1 : 0;
  }
  return (positive == 0) != (negative == 0);
}

ChartEdge reversed(const ChartEdge& edge) {
  return {step(edge.z, edge.along), opposite(edge.along)};
}

TEST(FaceCrossing, IsTheSameByBothArithmeticsAndFromBothEnds) {
  Random random(8812);
  std::size_t certain = 0;
  std::size_t leftToExact = 0;
  std::size_t onBorders = 0;
  for (int i = 0; i < testing::cases(200000) + 5000; ++i) {
    // Where products fit 53 bits, and where they are rounded.
    const std::int64_t unit = std::int64_t{1} << (random.oneIn(2) ? 18 : 44);
    const LatticeTet corners = randomCorners(unit, random);
    const CrossedFace face(corners, static_cast<int>(random.between(0, 3)));
    ChartEdge edge{{}, static_cast<Direction>(random.between(0, 5))};
    for (std::int32_t& z : edge.z) z = static_cast<std::int32_t>(random.between(-4, 4));
    if (!meets(face, edge, unit)) continue;
    const FaceShares rough = shareRoughly(face, edge, unit);
    const FaceShares exact = shareExactly(face, edge, unit);
    const FaceCrossing crossing = crossFace(face, edge, unit);
    ASSERT_EQ(crossing.inside, exact.inside);
    if (!exact.inside) {
      ASSERT_FALSE(rough.inside);
      ++onBorders;
      continue;
    }
    ++(rough.inside ? certain : leftToExact);
    double place = 0;
    const auto axis = static_cast<std::size_t>(axisOf(edge.along));
    for (std::size_t c = 0; c < 3; ++c) {
      if (rough.inside) {
        ASSERT_NEAR(rough.of[c], exact.of[c], 0x1p-37);
      }
      const std::int64_t at = face.corner(c)[axis] - edge.z[axis] * unit;
      place +=
          exact.of[c] * static_cast<double>(signOf(edge.along) * at) / static_cast<double>(unit);
    }
    ASSERT_LE(std::abs(crossing.parameter - place), crossing.error);
    const FaceCrossing back = crossFace(face, reversed(edge), unit);
    ASSERT_EQ(back.parameter, 1 - crossing.parameter);
    ASSERT_EQ(crossing.parameter, 1 - back.parameter);
    ASSERT_EQ(back.shares, crossing.shares);
  }
  EXPECT_GT(certain, 100U);
  EXPECT_GT(leftToExact, 0U);
  EXPECT_GT(onBorders, 10U);
}

}  // namespace
}  // namespace hexhex::test
