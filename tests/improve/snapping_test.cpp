// Edges of a mesh that are laid onto curves which none of them followed.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <adjacency/hex_topology.hpp>
#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/structure.hpp>

#include <base/vector3.hpp>

#include "improve/improved.hpp"
#include "mesh/grid_meshes.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

namespace snapped {

constexpr double kSlope = 0.6;
constexpr int kSize = 6;

/// A box with a roof whose ridge goes over the top from corner to corner, across all cells.
TetMap roof() {
  TetMap map = hexhex::testing::identityMap(kSize);
  for (Vec3& point : map.points) {
    point[2] -= kSlope * std::abs(point[0] - point[1]) * point[2] / kSize;
  }
  return map;
}

ImproveReport improvedRoof(HexMesh& mesh, bool snap, int threads = 2) {
  const TetMap map = roof();
  mesh = extracted(map, 1);
  ImproveOptions options;
  options.snapCurves = snap;
  return improvedOn(mesh, map, options, threads);
}

/// The largest distance of points of the ridge from edges of the mesh with both ends on it.
double ridgeGap(const HexMesh& mesh) {
  std::vector<std::array<double, 2>> covered;  // from x to x
  for (const Hex& cell : mesh.cells) {
    for (const auto& [a, b] : adjacency::kHexEdges) {
      const Vec3& p = mesh.points[cell[a]];
      const Vec3& q = mesh.points[cell[b]];
      const auto isOnRidge = [](const Vec3& x) {
        return std::abs(x[0] - x[1]) < 1e-9 && std::abs(x[2] - kSize) < 1e-9;
      };
      if (isOnRidge(p) && isOnRidge(q)) {
        covered.push_back({std::min(p[0], q[0]), std::max(p[0], q[0])});
      }
    }
  }
  std::sort(covered.begin(), covered.end());
  double reached = 0;
  double gap = 0;
  for (const auto& [begin, end] : covered) {
    gap = std::max(gap, begin - reached);
    reached = std::max(reached, end);
  }
  return std::max(gap, kSize - reached);
}

}  // namespace snapped

TEST(SnappedCurves, LieOnTheRidgeThatCellsLayAcross) {
  HexMesh without;
  const ImproveReport before = snapped::improvedRoof(without, false);
  EXPECT_EQ(before.snappedCurves, 0U);
  EXPECT_LT(before.curvesFollowed, 0.95);
  EXPECT_GT(snapped::ridgeGap(without), 5);
  HexMesh mesh;
  const ImproveReport report = snapped::improvedRoof(mesh, true);
  EXPECT_EQ(report.snappedCurves, 13U);  // with the edges of the box
  EXPECT_NEAR(report.curvesFollowed, 1, 1e-9);
  EXPECT_LT(snapped::ridgeGap(mesh), 1e-9);
  EXPECT_TRUE(report.after.allPositive());
  EXPECT_GT(report.after.quality.minimum, 0.2);
  EXPECT_LT(report.distanceAfter.hausdorff(), 1e-9);
  EXPECT_GT(before.distanceAfter.hausdorff(), 5e-3);
  EXPECT_EQ(mesh.cells.size(), without.cells.size() + report.addedCells);
  EXPECT_EQ(mesh.points.size(), without.points.size() + report.addedPoints.size());
  Context context(2);
  const MeshStructure structure = findStructure(mesh, context);
  EXPECT_EQ(structure.eulerCharacteristic, 1);
}

TEST(SnappedCurves, AreTheSameWithAnyNumberOfThreads) {
  HEXHEX_LARGE_TEST();
  HexMesh one;
  HexMesh four;
  snapped::improvedRoof(one, true, 1);
  snapped::improvedRoof(four, true, 4);
  EXPECT_TRUE(
      std::equal(one.points.begin(), one.points.end(), four.points.begin(), four.points.end()));
  EXPECT_EQ(one.cells, four.cells);
}

TEST(SnappedCurves, LeaveMeshesAloneThatFollowAllOfThem) {
  const TetMap box = hexhex::testing::identityMap(4);
  HexMesh mesh = extracted(box, 1);
  const HexMesh before = mesh;
  ImproveOptions options;
  options.snapCurves = true;
  const ImproveReport report = improvedOn(mesh, box, options);
  EXPECT_EQ(report.snappedCurves, 0U);
  EXPECT_EQ(mesh.cells, before.cells);
}

TEST(SnappedCurves, AreThoseOfStraightCells) {
  const TetMap map = snapped::roof();
  Context context(1);
  LagrangeMesh mesh = extractLagrange(map, 2, {}, context);
  ImproveOptions options;
  options.snapCurves = true;
  EXPECT_EQ(errorOf([&] { improve(mesh, map, options, context); }).code(),
            ErrorCode::InvalidArgument);
}

}  // namespace hexhex::test
