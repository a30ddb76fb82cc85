// Points of edges in faces: floating point against exact arithmetic, seen from both ends.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

#include <curved/intersections.hpp>

#include "lattice/random.hpp"

namespace hexhex::test {

using namespace curved;

namespace {

using testing::LatticeRandom;

/// Corners on the half-integer grid, anywhere, or nearly on a line: all of them around the origin.
lattice::LatticeTet randomCorners(std::int64_t unit, LatticeRandom& random) {
  lattice::LatticeTet corners{};
  const bool onGrid = random.oneIn(3);
  const std::int64_t thickness = random.oneIn(3) ? 3 : 4 * unit;
  for (lattice::LatticePoint& corner : corners) {
    for (std::int64_t& coordinate : corner) {
      coordinate = onGrid ? unit / 2 * random.between(-6, 6) : random.between(-4, 4) * unit;
      if (!onGrid) coordinate += random.between(-thickness, thickness);
    }
  }
  return corners;
}

/// Whether the line meets the closed face in one point, by exact arithmetic.
bool meets(const OwnersFace& face, const ChartEdge& edge, std::int64_t unit) {
  lattice::LatticePoint line;
  for (std::size_t k = 0; k < 3; ++k) line[k] = edge.z[k] * unit;
  int positive = 0;
  int negative = 0;
  const auto axis = static_cast<std::size_t>(lattice::axisOf(edge.along));
  for (std::size_t i = 0; i < 3; ++i) {
    const lattice::Int128 weight = lattice::crossComponent(face.corner((i + 1) % 3) - line,
                                                           face.corner((i + 2) % 3) - line, axis);
    positive += weight > 0 ? 1 : 0;
    negative += weight < 0 ? 1 : 0;
  }
  return (positive == 0) != (negative == 0);
}

ChartEdge reversed(const ChartEdge& edge) {
  return {lattice::step(edge.z, edge.along), lattice::opposite(edge.along)};
}

/// What occurred: tests that miss a case say nothing.
struct IntersectionCounts {
  std::size_t certain = 0;
  std::size_t leftToExact = 0;
  std::size_t onBorders = 0;
};

/// The place along the edge of a point with these shares.
double placeOf(const FaceShares& shares, const OwnersFace& face, const ChartEdge& edge,
               std::int64_t unit) {
  const auto axis = static_cast<std::size_t>(lattice::axisOf(edge.along));
  double place = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int64_t at =
        lattice::signOf(edge.along) * (face.corner(c)[axis] - edge.z[axis] * unit);
    place += shares.of[c] * static_cast<double>(at);
  }
  return place / static_cast<double>(unit);
}

/// For the parameter of an intersection whose shares are known to 2^-37.
double errorBound(const OwnersFace& face, const ChartEdge& edge, std::int64_t unit) {
  const auto axis = static_cast<std::size_t>(lattice::axisOf(edge.along));
  const double reach = std::abs(face.second(axis)) + std::abs(face.third(axis));
  const std::int64_t begin = std::int64_t{edge.z[axis]} - (lattice::signOf(edge.along) < 0 ? 1 : 0);
  const auto first = static_cast<double>(face.corner(0)[axis] - begin * unit);
  return (0x1p-36 * reach + 0x1p-50 * std::abs(first)) / static_cast<double>(unit) + 0x1p-52;
}

double largestDifference(const FaceShares& a, const FaceShares& b) {
  double largest = 0;
  for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(a.of[c] - b.of[c]));
  return largest;
}

/// @param edge  its line meets the closed face
void compareIntersection(const OwnersFace& face, const ChartEdge& edge, std::int64_t unit,
                         IntersectionCounts& counts) {
  const FaceShares rough = shareRoughly(face, edge, unit);
  const FaceShares exact = shareExactly(face, edge, unit);
  if (!exact.inside) {
    EXPECT_FALSE(rough.inside);
    ++counts.onBorders;
    return;
  }
  ++(rough.inside ? counts.certain : counts.leftToExact);
  EXPECT_TRUE(!rough.inside || largestDifference(rough, exact) < 0x1p-37);
  const FaceIntersection intersection = crossFace(face, edge, unit);
  EXPECT_LE(std::abs(intersection.parameter - placeOf(exact, face, edge, unit)),
            errorBound(face, edge, unit));
  const FaceIntersection back = crossFace(face, reversed(edge), unit);
  EXPECT_TRUE(back.parameter == 1 - intersection.parameter &&
              intersection.parameter == 1 - back.parameter && back.shares == intersection.shares);
}

TEST(FaceIntersection, IsTheSameByBothArithmeticsAndFromBothEnds) {
  LatticeRandom random(8812);
  IntersectionCounts counts;
  for (int i = 0; i < testing::cases(200000) + 5000 && !HasFailure(); ++i) {
    // Where products fit 53 bits, and where they are rounded.
    const std::int64_t unit = std::int64_t{1} << (random.oneIn(2) ? 18 : 44);
    const lattice::LatticeTet corners = randomCorners(unit, random);
    const OwnersFace face(corners, static_cast<int>(random.between(0, 3)));
    ChartEdge edge{{}, static_cast<lattice::Direction>(random.between(0, 5))};
    for (std::int32_t& z : edge.z) z = static_cast<std::int32_t>(random.between(-4, 4));
    if (meets(face, edge, unit)) compareIntersection(face, edge, unit, counts);
  }
  EXPECT_GT(counts.certain, 100U);
  EXPECT_GT(counts.leftToExact, 0U);
  EXPECT_GT(counts.onBorders, 10U);
}

}  // namespace
}  // namespace hexhex::test
