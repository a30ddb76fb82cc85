// The rasterizer against brute force: every grid point of the bounding box, located by the oracle.
// Tets of all shapes, so that they are swept in all orders.
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <lattice/tet_rasterizer.hpp>

#include "oracle.hpp"
#include "random.hpp"

namespace hexhex::testing {

using namespace lattice;
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::int64_t size(const GridRange& range) { return std::int64_t{range.last} - range.first + 1; }

/// A simplex (or kNoSimplex) for every grid point of a box.
class SimplexGrid {
 public:
  explicit SimplexGrid(const GridBox& box) : box_(box) {
    if (!box.empty()) {
      simplices_.resize(
          static_cast<std::size_t>(size(box.range[0]) * size(box.range[1]) * size(box.range[2])));
    }
  }
  [[nodiscard]] bool covers(const GridPoint& z) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (z[k] < box_.range[k].first || z[k] > box_.range[k].last) return false;
    }
    return true;
  }
  CornerMask& operator[](const GridPoint& z) {
    std::int64_t index = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      index = index * size(box_.range[k]) + z[k] - box_.range[k].first;
    }
    return simplices_[static_cast<std::size_t>(index)];
  }
  template <class Function>
  void forAllPoints(const Function& function) {
    GridPoint z;
    for (z[0] = box_.range[0].first; z[0] <= box_.range[0].last; ++z[0]) {
      for (z[1] = box_.range[1].first; z[1] <= box_.range[1].last; ++z[1]) {
        for (z[2] = box_.range[2].first; z[2] <= box_.range[2].last; ++z[2]) function(z);
      }
    }
  }
  [[nodiscard]] const std::vector<CornerMask>& simplices() const { return simplices_; }

 private:
  GridBox box_;
  std::vector<CornerMask> simplices_;
};

/// A tet and the lattice units per grid cell.
struct ScaledTet {
  LatticeTet corners;
  std::int64_t unit;
};

/// Int128 holds the determinants of tets that extend over less than 2^40.
template <class Integer>
SimplexGrid bruteForce(const ScaledTet& scaled) {
  const Tet<Integer> tet = [&] {
    LatticeTet relative = scaled.corners;
    for (LatticePoint& p : relative) p = p - scaled.corners[0];
    return widened<Integer>(relative);
  }();
  SimplexGrid grid(gridBox(scaled.corners, scaled.unit));
  grid.forAllPoints([&](const GridPoint& z) {
    grid[z] =
        locate<Integer>(tet, widened<Integer>(latticePoint(z, scaled.unit) - scaled.corners[0]));
  });
  return grid;
}

/// What the rasterizer finds of a grid. Lines come in sweep order, are not empty, and stay in the
/// box.
void expectLines(TetRasterizer& rasterizer, HalfGrid halfGrid, const GridBox& box,
                 const std::vector<CornerMask>& expected) {
  SimplexGrid grid(box);
  const SweepAxes axes = chooseSweepAxes(box);
  std::array<std::int32_t, 2> previous = {box.range[axes()[0]].first,
                                          box.range[axes()[1]].first - 1};
  rasterizer.sweep(halfGrid, [&](const SweptLine& line) {
    ASSERT_EQ(line.axes.index, axes.index);
    ASSERT_LT(previous, (std::array<std::int32_t, 2>{line.level, line.row}));
    previous = {line.level, line.row};
    ASSERT_GT(line.count, 0U);
    for (std::uint32_t i = 0; i < line.count; ++i) {
      ASSERT_TRUE(grid.covers(line.point(i)));
      grid[line.point(i)] = line.simplex(i);
    }
  });
  if (::testing::Test::HasFatalFailure()) return;
  ASSERT_EQ(grid.simplices(), expected);
}

std::string describe(const ScaledTet& scaled) {
  std::string text = "unit " + std::to_string(scaled.unit);
  for (const LatticePoint& p : scaled.corners) {
    text += " (" + std::to_string(p[0]) + ", " + std::to_string(p[1]) + ", " +
            std::to_string(p[2]) + ")";
  }
  return text;
}

/// Rasterizes with every kind of epsilon, by lines only and one by one where there are few points,
/// and in every grid the tet that is moved like the grid; and compares with brute force.
template <class Integer>
void expectAgreement(const ScaledTet& scaled) {
  const GridBox box = gridBox(scaled.corners, scaled.unit);
  const std::vector<CornerMask> expected = bruteForce<Integer>(scaled).simplices();
  for (const double epsilon : {0.0, 1e-6, 1e-2, 1e9, kInfinity}) {
    TetRasterizer rasterizer(scaled.corners, scaled.unit, epsilon);
    ASSERT_NO_FATAL_FAILURE(expectLines(rasterizer, kVertexGrid, box, expected))
        << describe(scaled) << " epsilon " << epsilon;
  }
  TetRasterizer byLines(scaled.corners, scaled.unit, 0, false);
  ASSERT_NO_FATAL_FAILURE(expectLines(byLines, kVertexGrid, box, expected)) << describe(scaled);
  if (scaled.unit == 1) return;  // there are no halves
  for (HalfGrid grid = 1; grid < 8; ++grid) {
    LatticeTet moved = scaled.corners;
    for (LatticePoint& p : moved) {
      for (std::size_t k = 0; k < 3; ++k) p[k] += ((grid >> k) & 1) * (scaled.unit / 2);
    }
    for (const bool fewPoints : {false, true}) {
      TetRasterizer rasterizer(moved, scaled.unit, 0, fewPoints);
      ASSERT_NO_FATAL_FAILURE(expectLines(rasterizer, grid, box, expected))
          << describe(scaled) << " grid " << int{grid} << " few points " << fewPoints;
    }
  }
}

/// LatticeRandom tets of one kind, positive, with many grid points on their corners, edges and
/// faces.
class TetSource {
 public:
  explicit TetSource(std::uint64_t seed) : random_(seed) {}

  enum Kind { kGeneral, kGridCorners, kHalves, kThirds, kSliver, kAligned, kFlat, kNeedle, kKinds };

  /// The largest number of grid cells a tet extends over, in each direction.
  std::array<std::int64_t, 3> extent = {3, 3, 3};

  ScaledTet operator()(Kind kind, std::int64_t unit) {
    for (;;) {
      ScaledTet scaled{{}, unit};
      for (LatticePoint& p : scaled.corners) p = corner(kind, unit);
      if (kind == kSliver) flatten(scaled.corners, unit);
      if (kind == kAligned) align(scaled.corners, unit);
      if (kind == kFlat) press(scaled.corners, unit);
      const int s = signum(determinant<Integer256>(widened<Integer256>(scaled.corners)));
      if (s < 0) std::swap(scaled.corners[2], scaled.corners[3]);
      if (s != 0) return scaled;
    }
  }
  LatticeRandom& random() { return random_; }

 private:
  LatticePoint corner(Kind kind, std::int64_t unit) {
    LatticePoint p;
    const std::int64_t parts = kind == kGridCorners ? 1 : (kind == kHalves ? 2 : 3);
    const bool anywhere = kind == kGeneral || kind == kSliver || kind == kFlat || kind == kNeedle;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = anywhere ? random_.between(0, extent[k] * unit)
                      : random_.between(0, extent[k] * parts) * unit / parts;
    }
    return p;
  }
  /// Moves the last corner next to a point of the plane of the others, which may be grid points.
  void flatten(LatticeTet& t, std::int64_t unit) {
    if (random_.oneIn(2)) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) t[i][k] = random_.between(0, extent[k]) * unit;
      }
    }
    for (std::size_t k = 0; k < 3; ++k) t[3][k] = t[0][k] + (t[1][k] - t[0][k]) / 2;
    for (std::size_t k = 0; k < 3; ++k) t[3][k] += (t[2][k] - t[0][k]) / 4;
    t[3][random_.below(3)] += random_.oneIn(2) ? 1 : -1;
    std::swap(t[3], t[random_.below(4)]);
  }
  /// Puts a face onto a grid plane, an edge of it onto a grid line, a corner onto a grid point.
  void align(LatticeTet& t, std::int64_t unit) {
    const std::size_t axis = random_.below(3);
    const std::int64_t plane = random_.between(0, extent[axis]) * unit;
    for (std::size_t i = 0; i < 3; ++i) t[i][axis] = plane;
    const std::size_t next = (axis + 1) % 3;
    if (random_.oneIn(2)) t[0][next] = t[1][next] = random_.between(0, extent[next]) * unit;
    const std::size_t last = (axis + 2) % 3;
    if (random_.oneIn(2)) t[0][last] = random_.between(0, extent[last]) * unit;
    std::swap(t[3], t[random_.below(4)]);
  }
  /// Presses the tet against a grid plane, which it still crosses: cuts by other planes are thin,
  /// their slopes steep.
  void press(LatticeTet& t, std::int64_t unit) {
    const std::size_t axis = random_.below(3);
    const std::int64_t plane = random_.between(0, extent[axis]) * unit;
    const std::int64_t thickness = std::max(unit >> random_.below(24), std::int64_t{1});
    for (LatticePoint& p : t) p[axis] = plane + random_.between(-thickness, thickness);
  }

  LatticeRandom random_;
};

void translate(ScaledTet& scaled, const GridPoint& offset) {
  for (LatticePoint& p : scaled.corners) {
    for (std::size_t k = 0; k < 3; ++k) p[k] += offset[k] * scaled.unit;
  }
}

GridPoint anyOffset(LatticeRandom& random, std::int64_t range) {
  const LatticePoint p = random.point(-range, range);
  return {static_cast<std::int32_t>(p[0]), static_cast<std::int32_t>(p[1]),
          static_cast<std::int32_t>(p[2])};
}

class RasterizeKinds : public ::testing::TestWithParam<TetSource::Kind> {};

TEST_P(RasterizeKinds, SmallTetsWithFewBits) {
  TetSource source(31 + static_cast<std::uint64_t>(GetParam()));
  LatticeRandom& random = source.random();
  for (int i = cases(90'000); i > 0; --i) {
    for (std::int64_t& e : source.extent) e = random.between(1, 6);
    ScaledTet scaled = source(GetParam(), std::int64_t{1} << random.between(0, 8));
    translate(scaled, anyOffset(random, 100));
    ASSERT_NO_FATAL_FAILURE(expectAgreement<Int128>(scaled));
  }
}

TEST_P(RasterizeKinds, SmallTetsFarFromTheOrigin) {
  TetSource source(41 + static_cast<std::uint64_t>(GetParam()));
  LatticeRandom& random = source.random();
  for (int i = cases(50'000); i > 0; --i) {
    for (std::int64_t& e : source.extent) e = random.between(1, 3);
    ScaledTet scaled = source(GetParam(), std::int64_t{1} << random.between(3, 29));
    translate(scaled, anyOffset(random, 1'000'000'000));
    ASSERT_NO_FATAL_FAILURE(expectAgreement<Int128>(scaled));
  }
}

TEST_P(RasterizeKinds, CoordinatesOfSixtyBits) {
  TetSource source(51 + static_cast<std::uint64_t>(GetParam()));
  LatticeRandom& random = source.random();
  for (int i = cases(8'000); i > 0; --i) {
    for (std::int64_t& e : source.extent) e = random.between(1, 3);
    ScaledTet scaled = source(GetParam(), std::int64_t{1} << random.between(30, 52));
    translate(scaled, anyOffset(random, 100));
    ASSERT_NO_FATAL_FAILURE(expectAgreement<Integer256>(scaled));
  }
}

TEST_P(RasterizeKinds, LargeAndLongTets) {
  TetSource source(61 + static_cast<std::uint64_t>(GetParam()));
  LatticeRandom& random = source.random();
  for (int i = cases(1'000); i > 0; --i) {
    for (std::int64_t& e : source.extent) e = random.between(2, 16);
    if (GetParam() == TetSource::kNeedle) source.extent[random.below(3)] *= 50;
    ScaledTet scaled = source(GetParam(), std::int64_t{1} << random.between(3, 20));
    translate(scaled, anyOffset(random, random.oneIn(2) ? 10 : 1'000'000));
    ASSERT_NO_FATAL_FAILURE(expectAgreement<Int128>(scaled));
  }
}

std::string kindName(const ::testing::TestParamInfo<TetSource::Kind>& info) {
  constexpr std::array<const char*, TetSource::kKinds> kNames = {
      "General", "GridCorners", "Halves", "Thirds", "Sliver", "Aligned", "Flat", "Needle"};
  return kNames[static_cast<std::size_t>(info.param)];
}

INSTANTIATE_TEST_SUITE_P(, RasterizeKinds,
                         ::testing::Values(TetSource::kGeneral, TetSource::kGridCorners,
                                           TetSource::kHalves, TetSource::kThirds,
                                           TetSource::kSliver, TetSource::kAligned,
                                           TetSource::kFlat, TetSource::kNeedle),
                         kindName);

TEST(Rasterize, SteepCutsFarFromTheOrigin) {
  // Tets pressed against a grid plane y, cut at constant x into polygons with slopes up to a
  // million, which multiply the rounding error of y.
  LatticeRandom random(71);
  constexpr std::int64_t kUnit = std::int64_t{1} << 29;
  for (int i = cases(20'000); i > 0; --i) {
    ScaledTet scaled{{}, kUnit};
    const std::int64_t thickness = kUnit >> random.between(10, 17);
    for (LatticePoint& p : scaled.corners) {
      p = {random.between(0, 2 * kUnit), random.between(-thickness, thickness),
           random.between(0, 20 * kUnit)};
    }
    const int s = signum(determinant<Int128>(widened<Int128>(scaled.corners)));
    if (s == 0) continue;
    if (s < 0) std::swap(scaled.corners[0], scaled.corners[1]);
    translate(scaled, anyOffset(random, 1'000'000'000));
    ASSERT_NO_FATAL_FAILURE(expectAgreement<Int128>(scaled));
  }
}

TEST(Rasterize, KuhnTetsOfPowerOfTwoCubes) {
  // Faces in planes of the grid and along diagonals, with slopes 0 and 1.
  for (std::int64_t edge = 1; edge <= 8; edge *= 2) {
    for (const auto& order : SweepAxes::kPermutations) {
      ScaledTet scaled{{}, 4};
      for (std::size_t i = 0; i < 3; ++i) {
        scaled.corners[i + 1] = scaled.corners[i];
        scaled.corners[i + 1][order[i]] += edge * scaled.unit;
      }
      if (determinant<Int128>(widened<Int128>(scaled.corners)) < 0) {
        std::swap(scaled.corners[1], scaled.corners[2]);
      }
      ASSERT_NO_FATAL_FAILURE(expectAgreement<Int128>(scaled));
    }
  }
}

TEST(Rasterize, NamesTheSimplexOfEveryPoint) {
  // The corner tet of a cube of edge 2: a line along an edge, and one across the slanted face.
  const ScaledTet scaled = {{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}}, 2};
  SimplexGrid grid = bruteForce<Int128>(scaled);
  TetRasterizer rasterizer(scaled.corners, scaled.unit);
  ASSERT_NO_FATAL_FAILURE(
      expectLines(rasterizer, kVertexGrid, gridBox(scaled.corners, scaled.unit), grid.simplices()));
  EXPECT_EQ((grid[{0, 0, 0}]), cornerBit(0));
  EXPECT_EQ((grid[{0, 0, 1}]), cornerBit(0) | cornerBit(3));
  EXPECT_EQ((grid[{0, 0, 2}]), cornerBit(3));
  EXPECT_EQ((grid[{0, 1, 1}]), cornerBit(2) | cornerBit(3));
  EXPECT_EQ((grid[{1, 1, 1}]), kNoSimplex);
}

/// Centres and midpoints, which tests above only see in tets that are moved with them.
TEST(Rasterize, FindsAllGridsOfOneTet) {
  TetSource source(91);
  LatticeRandom& random = source.random();
  for (int i = cases(20'000); i > 0; --i) {
    for (std::int64_t& e : source.extent) e = random.between(1, 4);
    const auto kind = static_cast<TetSource::Kind>(random.below(TetSource::kKinds));
    ScaledTet scaled = source(kind, std::int64_t{1} << random.between(2, 20));
    translate(scaled, anyOffset(random, 1000));
    TetRasterizer rasterizer(scaled.corners, scaled.unit, 0, random.oneIn(2));
    for (HalfGrid half = 0; half < 8; ++half) {
      const GridBox box = gridBox(scaled.corners, scaled.unit, half);
      SimplexGrid expected(box);
      expected.forAllPoints([&](const GridPoint& z) {
        LatticePoint p = latticePoint(z, scaled.unit);
        for (std::size_t k = 0; k < 3; ++k) p[k] += ((half >> k) & 1) * (scaled.unit / 2);
        expected[z] = locate(widened<Int128>(scaled.corners), widened<Int128>(p));
      });
      ASSERT_NO_FATAL_FAILURE(expectLines(rasterizer, half, box, expected.simplices()))
          << describe(scaled) << " grid " << int{half};
    }
  }
}

/// Corners within a few units of points of the finer grid: faces pass by its points closely.
TEST(Rasterize, PointsAsCloseToFacesAsCanBe) {
  LatticeRandom random(8);
  for (int i = cases(10'000); i > 0; --i) {
    ScaledTet scaled{{}, std::int64_t{1} << random.between(30, 50)};
    for (LatticePoint& corner : scaled.corners) {
      corner = random.point(0, 4);
      for (std::int64_t& c : corner) c = c * (scaled.unit / 2) + random.between(-2, 2);
    }
    const LatticeTet& t = scaled.corners;
    if (orientation(t[0], t[1], t[2], t[3]) <= 0) continue;
    ASSERT_NO_FATAL_FAILURE(expectAgreement<Integer256>(scaled));
  }
}

TEST(GridBox, HoldsTheGridPointsOfTheBoundingBox) {
  LatticeRandom random(72);
  for (int i = cases(100'000); i > 0; --i) {
    const std::int64_t unit = std::int64_t{1} << random.below(30);
    LatticeTet t;
    const std::int64_t range = std::min(unit << random.below(30), std::int64_t{1} << 58);
    for (LatticePoint& p : t) p = random.point(-range, range);
    if (random.oneIn(2)) t[0][0] = unit * (t[0][0] / unit);
    const GridBox box = gridBox(t, unit);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t low = std::min({t[0][k], t[1][k], t[2][k], t[3][k]});
      const std::int64_t high = std::max({t[0][k], t[1][k], t[2][k], t[3][k]});
      const GridRange r = box.range[k];
      // The smallest grid coordinate not below, the largest not above.
      ASSERT_TRUE(r.first * unit >= low && (std::int64_t{r.first} - 1) * unit < low);
      ASSERT_TRUE(r.last * unit <= high && (std::int64_t{r.last} + 1) * unit > high);
    }
  }
}

TEST(GridBox, IsEmptyBetweenGridPlanes) {
  const GridBox box = gridBox({{{1, 0, 0}, {2, 8, 0}, {3, 0, 8}, {3, 0, 0}}}, 4);
  EXPECT_TRUE(box.empty());
  EXPECT_FALSE(gridBox({{{0, 0, 0}, {2, 8, 0}, {3, 0, 8}, {3, 0, 0}}}, 4).empty());
}

TEST(SweepAxes, FewestPlanesFirstLongestLinesLast) {
  const auto axes = [](std::int32_t x, std::int32_t y, std::int32_t z) {
    return chooseSweepAxes({{{{5, 5 + x}, {-3, -3 + y}, {0, z}}}})();
  };
  using Axes = std::array<std::uint8_t, 3>;
  EXPECT_EQ(axes(1, 2, 3), (Axes{0, 1, 2}));
  EXPECT_EQ(axes(1, 3, 2), (Axes{0, 2, 1}));
  EXPECT_EQ(axes(2, 1, 3), (Axes{1, 0, 2}));
  EXPECT_EQ(axes(3, 1, 2), (Axes{1, 2, 0}));
  EXPECT_EQ(axes(2, 3, 1), (Axes{2, 0, 1}));
  EXPECT_EQ(axes(3, 2, 1), (Axes{2, 1, 0}));
  EXPECT_EQ(axes(2, 2, 2), (Axes{0, 1, 2}));
  EXPECT_EQ(axes(2, 1, 2), (Axes{1, 0, 2}));
  constexpr std::int32_t kLargest = 2'000'000'000;
  EXPECT_EQ(axes(kLargest, 1, 0), (Axes{2, 1, 0}));
}

TEST(SimplexOf, LocatesPointsInsideAndOutside) {
  TetSource source(81);
  LatticeRandom& random = source.random();
  for (int i = cases(200'000); i > 0; --i) {
    const auto kind = static_cast<TetSource::Kind>(random.below(TetSource::kKinds));
    ScaledTet scaled = source(kind, std::int64_t{1} << random.between(3, 29));
    translate(scaled, anyOffset(random, random.oneIn(2) ? 3 : 1'000'000'000));
    const GridBox box = gridBox(scaled.corners, scaled.unit);
    GridPoint z;
    for (std::size_t k = 0; k < 3; ++k) {
      z[k] =
          static_cast<std::int32_t>(random.between(box.range[k].first - 2, box.range[k].last + 2));
    }
    ASSERT_EQ(simplexOf(scaled.corners, z, scaled.unit),
              locate(widened<Integer256>(scaled.corners),
                     widened<Integer256>(latticePoint(z, scaled.unit))))
        << describe(scaled);
  }
}

}  // namespace
}  // namespace hexhex::testing
