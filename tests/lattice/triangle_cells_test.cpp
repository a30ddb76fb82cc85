// The half diagonals that triangles cut, and the columns of cells that they meet, against exact
// intersection.
#include <algorithm>
#include <bit>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <lattice/triangle_cells.hpp>

#include "oracle.hpp"
#include "random.hpp"

namespace hexhex::testing::triangle_cells {

using namespace lattice;
namespace {

using Triangle = std::array<LatticePoint, 3>;
using Wide = std::array<Int128, 3>;

Wide cross(const Wide& a, const Wide& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Wide widen(const LatticePoint& p) { return {p[0], p[1], p[2]}; }

/// Whether an axis separates the triangle from the open cube [0, unit]^3: their shadows on it do
/// not overlap. (An axis of length zero separates nothing.)
bool separates(const Wide& axis, const Triangle& triangle, std::int64_t unit) {
  Int128 cubeLow = 0;
  Int128 cubeHigh = 0;
  for (const Int128 a : axis) (a < 0 ? cubeLow : cubeHigh) += a * unit;
  if (cubeLow == cubeHigh) return false;
  std::array<Int128, 3> shadow{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) shadow[i] += axis[k] * triangle[i][k];
  }
  return std::max({shadow[0], shadow[1], shadow[2]}) <= cubeLow ||
         std::min({shadow[0], shadow[1], shadow[2]}) >= cubeHigh;
}

/// Exactly, by the separating axes of two convex polytopes: normals of both, and the products of
/// their edges.
bool meetsOpenCube(Triangle triangle, const GridPoint& z, std::int64_t unit) {
  for (LatticePoint& p : triangle) {
    for (std::size_t k = 0; k < 3; ++k) p[k] -= z[k] * unit;
  }
  std::vector<Wide> axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::array<Wide, 3> edges{};
  for (std::size_t i = 0; i < 3; ++i) edges[i] = widen(triangle[(i + 1) % 3] - triangle[i]);
  axes.push_back(cross(edges[0], edges[1]));
  for (std::size_t k = 0; k < 3; ++k) {
    for (const Wide& edge : edges) axes.push_back(cross(axes[k], edge));
  }
  return std::none_of(axes.begin(), axes.end(),
                      [&](const Wide& axis) { return separates(axis, triangle, unit); });
}

template <class Integer>
Integer dot(const Point<Integer>& a, const Point<Integer>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Integer>
Point<Integer> crossOf(const Point<Integer>& a, const Point<Integer>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The part of a half diagonal, from a cell's centre (0) to a corner (1), that lies in a
/// half-space.
template <class Integer>
struct Interval {
  // Two fractions with positive denominators.
  std::array<Integer, 2> low = {0, 1};
  std::array<Integer, 2> high = {1, 1};
  bool empty = false;

  /// Keeps those t for which value + t slope is not negative.
  void keep(const Integer& value, const Integer& slope) {
    if (slope == 0) empty = empty || value < 0;
    if (slope > 0 && -value * low[1] > low[0] * slope) low = {-value, slope};
    if (slope < 0 && value * high[1] < high[0] * -slope) high = {value, -slope};
  }
  /// Whether something is left, other than the corner alone.
  [[nodiscard]] bool hasMoreThanCorner() const {
    return !empty && low[0] * high[1] <= high[0] * low[1] && low[0] < low[1];
  }
};

/// Whether a half diagonal of a cell, with the centre but without the corner, meets a triangle:
/// exactly, for units of up to 2^10 with 128 bits, and 2^24 with 256.
template <class Integer>
bool meetsHalfDiagonal(const Triangle& triangle, const GridPoint& z, std::size_t corner,
                       std::int64_t unit) {
  std::array<Point<Integer>, 3> p;
  LatticePoint center{};
  LatticePoint diagonal{};
  for (std::size_t k = 0; k < 3; ++k) {
    center[k] = z[k] * unit + unit / 2;
    diagonal[k] = (2 * kCellCorners[corner][k] - 1) * unit / 2;
  }
  for (std::size_t i = 0; i < 3; ++i) p[i] = widened<Integer>(triangle[i]);
  const auto between = [](const Point<Integer>& from, const Point<Integer>& to) {
    return Point<Integer>{to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  };
  const auto start = widened<Integer>(center);
  const auto step = widened<Integer>(diagonal);
  const Point<Integer> normal = crossOf<Integer>(between(p[0], p[1]), between(p[0], p[2]));
  Interval<Integer> interval;
  // In the plane, from both its sides, and inside of each edge.
  const auto height = dot<Integer>(normal, between(p[0], start));
  const auto slope = dot<Integer>(normal, step);
  interval.keep(height, slope);
  interval.keep(-height, -slope);
  for (std::size_t i = 0; i < 3; ++i) {
    const Point<Integer> inward = crossOf<Integer>(normal, between(p[i], p[(i + 1) % 3]));
    interval.keep(dot<Integer>(inward, between(p[i], start)), dot<Integer>(inward, step));
  }
  return interval.hasMoreThanCorner();
}

bool isDegenerate(const Triangle& t) {
  const Wide normal = cross(widen(t[1] - t[0]), widen(t[2] - t[0]));
  return normal[0] == 0 && normal[1] == 0 && normal[2] == 0;
}

enum Kind {
  kGeneral,
  kGrid,
  kHalves,
  kThirds,
  kThin,
  kInGridPlane,
  kInCenterPlane,
  kTouching,
  kKinds
};

/// A point on a half diagonal, often the centre of the cell.
LatticePoint pointOnHalfDiagonal(LatticeRandom& random, std::int64_t unit, std::int64_t extent) {
  const std::int64_t fraction = random.oneIn(3) ? 0 : random.between(0, unit / 2);
  LatticePoint p{};
  for (std::int64_t& coordinate : p) {
    coordinate =
        random.between(0, extent - 1) * unit + unit / 2 + (random.oneIn(2) ? fraction : -fraction);
  }
  return p;
}

/// Puts a corner or the middle of an edge on a half diagonal.
void touchHalfDiagonal(Triangle& t, LatticeRandom& random, std::int64_t unit, std::int64_t extent) {
  const LatticePoint touched = pointOnHalfDiagonal(random, unit, extent);
  const bool atCorner = random.oneIn(2);
  for (std::size_t k = 0; k < 3; ++k) t[0][k] = atCorner ? touched[k] : 2 * touched[k] - t[1][k];
  std::rotate(t.begin(), t.begin() + random.between(0, 2), t.end());
}

Triangle anyTriangle(LatticeRandom& random, Kind kind, std::int64_t unit, std::int64_t extent) {
  for (;;) {
    Triangle t{};
    for (LatticePoint& p : t) {
      for (std::int64_t& coordinate : p) {
        const std::int64_t parts = kind == kThirds ? 3 : kind == kHalves ? 2 : 1;
        coordinate = kind == kGeneral || kind == kThin || kind == kTouching
                         ? random.between(0, extent * unit)
                         : random.between(0, extent * parts) * unit / parts;
      }
    }
    if (kind == kThin) {
      for (std::size_t k = 0; k < 3; ++k) t[2][k] = (t[0][k] + t[1][k]) / 2;
      t[2][random.below(3)] += random.between(1, 3);
    }
    if (kind == kInGridPlane) {
      const std::size_t axis = random.below(3);
      for (LatticePoint& p : t) p[axis] = t[0][axis];
    }
    if (kind == kInCenterPlane) {
      const std::size_t axis = random.below(3);
      const std::int64_t height = random.between(0, extent - 1) * unit + unit / 2;
      for (LatticePoint& p : t) p[axis] = height;
    }
    if (kind == kTouching) touchHalfDiagonal(t, random, unit, extent);
    if (!isDegenerate(t)) return t;
  }
}

/// Calls visit(GridPoint) for all cells that may have anything to do with a triangle of
/// anyTriangle().
template <class Visit>
void forEachCell(std::int64_t extent, const Visit& visit) {
  GridPoint z{};
  for (z[0] = -1; z[0] <= extent; ++z[0]) {
    for (z[1] = -1; z[1] <= extent; ++z[1]) {
      for (z[2] = -1; z[2] <= extent; ++z[2]) visit(z);
    }
  }
}

/// What TriangleCells or TriangleColumns find of each cell, far from the origin.
template <class Cells>
std::map<GridPoint, CellCornerSet> takenBy(Triangle triangle, std::int64_t unit,
                                           const LatticePoint& offset) {
  for (LatticePoint& p : triangle) {
    for (std::size_t k = 0; k < 3; ++k) p[k] += offset[k] * unit;
  }
  std::map<GridPoint, CellCornerSet> taken;
  Cells(triangle, unit).run([&](const GridPoint& z, CellCornerSet corners) {
    GridPoint back{};
    for (std::size_t k = 0; k < 3; ++k) back[k] = z[k] - static_cast<std::int32_t>(offset[k]);
    EXPECT_NE(corners, 0U);
    EXPECT_TRUE(taken.emplace(back, corners).second) << "a cell came twice";
  });
  return taken;
}

/// A triangle, and what it takes.
struct Drawn {
  std::int64_t unit;
  std::int64_t extent;
  Triangle triangle;
  std::map<GridPoint, CellCornerSet> taken;
};

/// @param leastBits, mostBits  of the unit
Drawn draw(LatticeRandom& random, Kind kind, std::int64_t leastBits, std::int64_t mostBits) {
  Drawn drawn;
  drawn.unit = std::int64_t{1} << random.between(leastBits, mostBits);
  drawn.extent = random.between(1, 5);
  drawn.triangle = anyTriangle(random, kind, drawn.unit, drawn.extent);
  drawn.taken =
      takenBy<TriangleCells>(drawn.triangle, drawn.unit, random.point(-1'000'000, 1'000'000));
  return drawn;
}

/// Conservative, but of use.
/// @param cases    triangles that were drawn
/// @param visited  what they took
/// @param met      what they had to take
/// @param most     the former may be so many times as many as the latter
void expectUse(Kind kind, int cases, std::size_t visited, std::size_t met, std::size_t most) {
  if (kind == kInGridPlane) {
    EXPECT_EQ(met, 0U);
    EXPECT_EQ(visited, 0U);
  } else {
    EXPECT_GT(4 * met, static_cast<std::size_t>(cases));
    EXPECT_LT(visited, most * met);
  }
}

class TriangleCellsKinds : public ::testing::TestWithParam<Kind> {};

/// Compares with exact arithmetic on integers of some width.
/// @param mostBits  of the unit
template <class Integer>
void expectAllHalfDiagonals(Kind kind, std::uint64_t seed, int count, std::int64_t mostBits) {
  LatticeRandom random(seed + static_cast<std::uint64_t>(kind));
  std::size_t met = 0;
  std::size_t visited = 0;
  for (int i = count; i > 0; --i) {
    Drawn drawn = draw(random, kind, 1, mostBits);
    for (const auto& [z, corners] : drawn.taken) {
      visited += static_cast<std::size_t>(std::popcount(corners));
    }
    forEachCell(drawn.extent, [&](const GridPoint& z) {
      for (std::size_t corner = 0; corner < 8; ++corner) {
        if (!meetsHalfDiagonal<Integer>(drawn.triangle, z, corner, drawn.unit)) continue;
        ++met;
        EXPECT_TRUE((drawn.taken[z] >> corner) & 1U) << "case " << i << " unit " << drawn.unit;
      }
    });
  }
  if (kind == kThin && mostBits > 10) return;  // too thin to meet anything
  // What is met at a corner only, or by rounding errors, is little, but for triangles in planes of
  // centres.
  expectUse(kind, count, visited, met, 2);
}

TEST_P(TriangleCellsKinds, LeaveNoHalfDiagonalOut) {
  expectAllHalfDiagonals<Int128>(GetParam(), 81, cases(1500), 10);
}

TEST_P(TriangleCellsKinds, LeaveNoHalfDiagonalOutOfManyBits) {
  expectAllHalfDiagonals<Integer256>(GetParam(), 281, cases(200), 24);
}

/// Whatever meets the open cell meets some open octant of it, or the planes between them, and all
/// octants are taken: so this holds, too, here for as many bits as there can be.
TEST_P(TriangleCellsKinds, ColumnsLeaveNoCellOut) {
  LatticeRandom random(181 + static_cast<std::uint64_t>(GetParam()));
  std::size_t met = 0;
  std::size_t visited = 0;
  const int count = cases(3000);
  for (int i = count; i > 0; --i) {
    const std::int64_t unit = std::int64_t{1} << random.between(2, 30);
    const std::int64_t extent = random.between(1, 5);
    const Triangle triangle = anyTriangle(random, GetParam(), unit, extent);
    const auto taken =
        takenBy<TriangleColumns>(triangle, unit, random.point(-1'000'000, 1'000'000));
    visited += taken.size();
    forEachCell(extent, [&](const GridPoint& z) {
      if (!meetsOpenCube(triangle, z, unit)) return;
      ++met;
      EXPECT_TRUE(taken.contains(z)) << "case " << i << " unit " << unit;
    });
  }
  expectUse(GetParam(), count, visited, met, 3);
}

std::string kindName(const ::testing::TestParamInfo<Kind>& kind) {
  constexpr std::array<const char*, kKinds> kNames = {
      "General", "Grid", "Halves", "Thirds", "Thin", "InGridPlane", "InCenterPlane", "Touching"};
  return kNames[static_cast<std::size_t>(kind.param)];
}

INSTANTIATE_TEST_SUITE_P(, TriangleCellsKinds,
                         ::testing::Values(kGeneral, kGrid, kHalves, kThirds, kThin, kInGridPlane,
                                           kInCenterPlane, kTouching),
                         kindName);

}  // namespace
}  // namespace hexhex::testing::triangle_cells
