// The conservative rasterization of triangles against exact intersection.
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <lattice/triangle_cells.hpp>

#include "oracle.hpp"
#include "random.hpp"

namespace hexhex::testing {
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

bool isDegenerate(const Triangle& t) {
  const Wide normal = cross(widen(t[1] - t[0]), widen(t[2] - t[0]));
  return normal[0] == 0 && normal[1] == 0 && normal[2] == 0;
}

enum Kind { kGeneral, kGrid, kThirds, kThin, kInGridPlane, kKinds };

Triangle anyTriangle(Random& random, Kind kind, std::int64_t unit, std::int64_t extent) {
  for (;;) {
    Triangle t{};
    for (LatticePoint& p : t) {
      for (std::int64_t& coordinate : p) {
        const std::int64_t parts = kind == kThirds ? 3 : 1;
        coordinate = kind == kGeneral || kind == kThin
                         ? random.between(0, extent * unit)
                         : random.between(0, extent * parts) * unit / parts;
      }
    }
    if (kind == kThin) {
      for (std::size_t k = 0; k < 3; ++k) t[2][k] = (t[0][k] + t[1][k]) / 2;
      t[2][random.index(3)] += random.between(1, 3);
    }
    if (kind == kInGridPlane) {
      const std::size_t axis = random.index(3);
      for (LatticePoint& p : t) p[axis] = t[0][axis];
    }
    if (!isDegenerate(t)) return t;
  }
}

class TriangleCellsKinds : public ::testing::TestWithParam<Kind> {};

TEST_P(TriangleCellsKinds, LeaveNoCellOut) {
  Random random(81 + static_cast<std::uint64_t>(GetParam()));
  std::size_t met = 0;
  std::size_t visited = 0;
  for (int i = cases(6000); i > 0; --i) {
    const std::int64_t unit = std::int64_t{1} << random.between(2, 30);
    const std::int64_t extent = random.between(1, 5);
    Triangle triangle = anyTriangle(random, GetParam(), unit, extent);
    const LatticePoint offset = random.point(-1'000'000, 1'000'000);
    std::set<GridPoint> cells;
    Triangle moved = triangle;
    for (LatticePoint& p : moved) {
      for (std::size_t k = 0; k < 3; ++k) p[k] += offset[k] * unit;
    }
    TriangleCells(moved, unit).run([&](const GridPoint& z) {
      GridPoint back{};
      for (std::size_t k = 0; k < 3; ++k) back[k] = z[k] - static_cast<std::int32_t>(offset[k]);
      EXPECT_TRUE(cells.insert(back).second) << "a cell came twice";
    });
    visited += cells.size();
    GridPoint z{};
    for (z[0] = -1; z[0] <= extent; ++z[0]) {
      for (z[1] = -1; z[1] <= extent; ++z[1]) {
        for (z[2] = -1; z[2] <= extent; ++z[2]) {
          if (!meetsOpenCube(triangle, z, unit)) continue;
          ++met;
          ASSERT_TRUE(cells.contains(z)) << "case " << i << " unit " << unit;
        }
      }
    }
  }
  // Conservative, but of use.
  if (GetParam() == kInGridPlane) {
    EXPECT_EQ(met, 0U);
    EXPECT_EQ(visited, 0U);
  } else {
    EXPECT_GT(met, 1000U);
    EXPECT_LT(visited, 3 * met);
  }
}

std::string kindName(const ::testing::TestParamInfo<Kind>& kind) {
  constexpr std::array<const char*, kKinds> kNames = {"General", "Grid", "Thirds", "Thin",
                                                      "InGridPlane"};
  return kNames[static_cast<std::size_t>(kind.param)];
}

INSTANTIATE_TEST_SUITE_P(, TriangleCellsKinds,
                         ::testing::Values(kGeneral, kGrid, kThirds, kThin, kInGridPlane),
                         kindName);

}  // namespace
}  // namespace hexhex::testing
