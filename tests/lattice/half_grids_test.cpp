// The points that HalfGrids finds in a tet against those of LineRasterizer, which has its own test.
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <lattice/half_grids.hpp>

#include "random.hpp"

namespace hexhex::testing {
namespace {

using LineKey = std::tuple<std::int32_t, std::int32_t, std::int32_t, std::uint32_t, CornerMask,
                           CornerMask, std::uint8_t>;

LineKey keyOf(const SweptLine& line) {
  return {line.level, line.row, line.first, line.count, line.left, line.right, line.axes.index};
}

/// By LineRasterizer, in the tet moved back.
std::vector<LineKey> expectedLines(LatticeTet corners, std::int64_t unit, HalfGrid grid) {
  for (LatticePoint& corner : corners) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] -= ((grid >> k) & 1) * (unit / 2);
  }
  std::vector<LineKey> lines;
  const GridBox box = gridBox(corners, unit);
  if (box.empty()) return lines;
  LineRasterizer(corners, unit, box, chooseSweepAxes(box)).run([&](const SweptLine& line) {
    lines.push_back(keyOf(line));
  });
  return lines;
}

/// What occurred.
struct Seen {
  int small = 0;     ///< grids without points of which others found none either, or only inner ones
  int boundary = 0;  ///< points on the tet's boundary
  int inside = 0;
};

void compare(const LatticeTet& corners, std::int64_t unit, const HalfGridSearch& search,
             Seen& seen) {
  HalfGrids grids(corners, unit, search);
  for (HalfGrid grid = 0; grid < 8; ++grid) {
    if ((search.wanted() & halfGridBit(grid)) == 0) continue;
    std::vector<LineKey> lines;
    const SweepAxes axes =
        grids.sweep(grid, [&](const SweptLine& line) { lines.push_back(keyOf(line)); });
    const std::vector<LineKey> expected = expectedLines(corners, unit, grid);
    ASSERT_EQ(lines, expected);
    if ((grids.occupied() & halfGridBit(grid)) == 0) {
      ASSERT_TRUE(expected.empty());
      ++seen.small;
    }
    for (const LineKey& line : expected) {
      ASSERT_EQ(axes.index, std::get<6>(line));
      const bool inner = std::get<4>(line) == kWholeTet && std::get<5>(line) == kWholeTet;
      ++(inner ? seen.inside : seen.boundary);
    }
  }
}

/// A test that misses a case says nothing.
void expectAllKinds(const Seen& seen) {
  EXPECT_GT(seen.small, 0);
  EXPECT_GT(seen.boundary, 0);
  EXPECT_GT(seen.inside, 0);
}

/// Corners of a positive tet from a range of coordinates.
LatticeTet anyTet(Random& random, std::int64_t low, std::int64_t high) {
  for (;;) {
    const LatticeTet tet = {random.point(low, high), random.point(low, high),
                            random.point(low, high), random.point(low, high)};
    if (orientation(tet[0], tet[1], tet[2], tet[3]) > 0) return tet;
  }
}

TEST(HalfGrids, FindWhatLinesFind) {
  Random random(7);
  const std::vector<HalfGridSearch> searches = {HalfGridSearch(0x01), HalfGridSearch(0x17),
                                                HalfGridSearch(0x68), HalfGridSearch(0xff)};
  Seen seen;
  for (int i = cases(40'000); i > 0; --i) {
    // Few bits, so that points lie on faces, edges and corners; many, so that they lie close by.
    const std::int64_t unit = std::int64_t{1} << random.between(1, random.oneIn(2) ? 3 : 45);
    const std::int64_t extent = random.between(1, 3) * unit + unit / 2;
    LatticeTet tet = anyTet(random, 0, extent);
    const std::int64_t offset = random.between(-1000, 1000) * unit;
    for (LatticePoint& corner : tet) corner[0] += offset;
    ASSERT_NO_FATAL_FAILURE(compare(tet, unit, searches[random.index(searches.size())], seen));
  }
  expectAllKinds(seen);
}

/// Faces across an axis, through points of some grid or between them, as those on the boundary of a
/// map; tets of a few points along each axis and of more.
TEST(HalfGrids, FacesAcrossAnAxis) {
  Random random(9);
  const HalfGridSearch search(0xff);
  Seen seen;
  for (int i = cases(20'000); i > 0; --i) {
    const std::int64_t unit = std::int64_t{1} << random.between(2, 40);
    LatticeTet tet = anyTet(random, -unit, random.between(1, 6) * unit);
    const auto axis = static_cast<std::size_t>(random.between(0, 2));
    const auto apex = static_cast<std::size_t>(random.between(0, 3));
    const std::int64_t plane = random.between(-1, 12) * (unit / 2) + (random.oneIn(4) ? 1 : 0);
    for (std::size_t c = 0; c < 4; ++c) {
      if (c != apex) tet[c][axis] = plane;
    }
    if (random.oneIn(8)) tet[apex][(axis + 1) % 3] = tet[(apex + 1) % 4][(axis + 1) % 3];
    if (orientation(tet[0], tet[1], tet[2], tet[3]) <= 0) continue;
    ASSERT_NO_FATAL_FAILURE(compare(tet, unit, search, seen));
  }
  expectAllKinds(seen);
  EXPECT_GT(seen.boundary, cases(20'000) / 2);
  EXPECT_GT(seen.inside, cases(20'000) / 2);
}

TEST(HalfGrids, PointsAsCloseToFacesAsCanBe) {
  Random random(8);
  const HalfGridSearch search(0x17);
  Seen seen;
  for (int i = cases(10'000); i > 0; --i) {
    // Corners within a few units of points of the finer grid: faces pass by its points closely.
    const std::int64_t unit = std::int64_t{1} << random.between(30, 50);
    LatticeTet tet = anyTet(random, 0, 4);
    for (LatticePoint& corner : tet) {
      for (std::int64_t& c : corner) c = c * (unit / 2) + random.between(-2, 2);
    }
    if (orientation(tet[0], tet[1], tet[2], tet[3]) <= 0) continue;
    ASSERT_NO_FATAL_FAILURE(compare(tet, unit, search, seen));
  }
  expectAllKinds(seen);
}

}  // namespace
}  // namespace hexhex::testing
