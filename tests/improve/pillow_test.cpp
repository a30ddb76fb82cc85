// Layers under the boundary: where they help, they are kept, and hold to the surface.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <adjacency/hex_topology.hpp>
#include <gtest/gtest.h>
#include <support/effort.hpp>

#include <hexhex/curved.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/samples.hpp>
#include <hexhex/structure.hpp>

#include <base/vector3.hpp>

#include "improve/improved.hpp"
#include "mesh/grid_meshes.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {
using hexhex::testing::identityMap;

namespace pillows {

ImproveReport improvedWith(HexMesh& mesh, const TetMap& map, PillowMode mode, int threads = 2) {
  ImproveOptions options;
  options.pillow = mode;
  return improvedOn(mesh, map, options, threads);
}

/// What labels make of a smooth body: a cube whose edges and corners are nowhere on its surface.
/// @param axes  of the ellipsoid
TetMap ellipsoid(std::size_t n, const Vec3& axes) {
  TetMap map = identityMap(n);
  for (Vec3& point : map.points) {
    double largest = 0;
    for (double& x : point) {
      x = 2 * x / static_cast<double>(n) - 1;
      largest = std::max(largest, std::abs(x));
    }
    const double size = length(point);
    const double factor = size > 0 ? largest / size : 0;
    for (std::size_t k = 0; k < 3; ++k) point[k] *= axes[k] * factor;
  }
  return map;
}

double levelOf(const Vec3& point, const Vec3& axes) {
  return length({point[0] / axes[0], point[1] / axes[1], point[2] / axes[2]});
}

std::uint64_t bad(const ImproveReport& report) { return report.notPositive.size(); }

}  // namespace pillows

TEST(ImprovePillow, VerticesSlideAcrossBordersOfLabelsOnASmoothSurface) {
  HEXHEX_LARGE_TEST();
  const TetMap map = pillows::ellipsoid(8, {1, 1, 1});
  HexMesh mesh = extracted(map, 1);
  const ImproveReport ball = pillows::improvedWith(mesh, map, PillowMode::Never);
  EXPECT_EQ(ball.vertices[2] + ball.vertices[3], 0U);
  const TetMap box = identityMap(4);
  mesh = extracted(box, 1);
  const ImproveReport cube = pillows::improvedWith(mesh, box, PillowMode::Never);
  EXPECT_EQ(cube.vertices[2], 12U * 3);
  EXPECT_EQ(cube.vertices[3], 8U);
}

TEST(ImprovePillow, RaisesTheMinimumOfSmoothBodies) {
  HEXHEX_LARGE_TEST();
  for (const Vec3& axes : {Vec3{1, 1, 1}, Vec3{1, 1.5, 0.7}}) {
    const TetMap map = pillows::ellipsoid(8, axes);
    const HexMesh mesh = extracted(map, 1);
    HexMesh without = mesh;
    HexMesh with = mesh;
    const ImproveReport never = pillows::improvedWith(without, map, PillowMode::Never);
    const ImproveReport automatic = pillows::improvedWith(with, map, PillowMode::Auto);
    EXPECT_EQ(never.addedCells, 0U);
    EXPECT_EQ(automatic.addedCells, 6U * 64);
    EXPECT_EQ(with.cells.size(), mesh.cells.size() + automatic.addedCells);
    EXPECT_EQ(with.points.size(), mesh.points.size() + automatic.addedPoints.size());
    EXPECT_EQ(automatic.before.validity.size(), mesh.cells.size());
    EXPECT_EQ(automatic.after.validity.size(), with.cells.size());
    EXPECT_TRUE(automatic.after.allPositive());
    EXPECT_LT(never.after.quality.minimum, 0.3);
    EXPECT_GT(automatic.after.quality.minimum, never.after.quality.minimum + 0.1);
    EXPECT_LE(automatic.distanceAfter.hausdorff(),
              1.001 * std::max(never.distanceAfter.hausdorff(), kSurfaceTolerance));
    Context context(2);
    const MeshStructure structure = findStructure(with, context);
    EXPECT_EQ(structure.eulerCharacteristic, 1);
    EXPECT_EQ(structure.boundaryQuads, 6U * 64);
    // Vertices of the boundary lie on its triangles, so at most as deep as these.
    Stage stage(context, "test");
    for (const Quad& quad : adjacency::quadsAt(with, adjacency::boundaryPlaces(with, stage))) {
      for (const Index v : quad) {
        EXPECT_LT(v, mesh.points.size());
        EXPECT_LT(std::abs(pillows::levelOf(with.points[v], axes) - 1), 0.05);
      }
    }
  }
}

TEST(ImprovePillow, CanBeImprovedAgainWithItsMap) {
  HEXHEX_LARGE_TEST();
  const TetMap map = pillows::ellipsoid(6, {1, 1.3, 0.8});
  HexMesh mesh = extracted(map, 1);
  const ImproveReport first = pillows::improvedWith(mesh, map, PillowMode::Always);
  ASSERT_GT(first.addedCells, 0U);
  const ImproveReport second = pillows::improvedWith(mesh, map, PillowMode::Never);
  EXPECT_EQ(second.vertices, first.vertices);
  EXPECT_TRUE(second.after.allPositive());
  EXPECT_GE(second.after.quality.minimum, first.after.quality.minimum);
  EXPECT_LE(second.distanceAfter.hausdorff(),
            1.001 * std::max(second.distanceBefore.hausdorff(), kSurfaceTolerance));
}

TEST(ImprovePillow, GivesTheSameBytesWithAnyNumberOfThreads) {
  HEXHEX_LARGE_TEST();
  const TetMap map = pillows::ellipsoid(6, {1, 1.3, 0.8});
  HexMesh one = extracted(map, 1);
  HexMesh four = one;
  pillows::improvedWith(one, map, PillowMode::Always, 1);
  pillows::improvedWith(four, map, PillowMode::Always, 4);
  EXPECT_TRUE(
      std::equal(one.points.begin(), one.points.end(), four.points.begin(), four.points.end()));
  EXPECT_TRUE(std::equal(one.cells.begin(), one.cells.end(), four.cells.begin(), four.cells.end()));
}

TEST(ImprovePillow, LeavesAlignedBlocksAlone) {
  for (const double jitter : {0.0, 0.8}) {
    SampleOptions options;
    options.cells = 3;
    options.jitter = jitter;
    const TetMap map = generateSample(SampleKind::Box, options).map;
    HexMesh mesh = extracted(map, 1);
    const HexMesh before = mesh;
    const ImproveReport report = pillows::improvedWith(mesh, map, PillowMode::Auto);
    EXPECT_EQ(report.addedCells, 0U);
    EXPECT_EQ(mesh.cells, before.cells);
  }
}

/// Whatever the body, `auto` gives up nothing.
TEST(ImprovePillow, AutoIsNeverWorse) {
  HEXHEX_LARGE_TEST();
  for (const SampleKind kind : {SampleKind::Box, SampleKind::Torus, SampleKind::Sphere,
                                SampleKind::Cylinder, SampleKind::Star}) {
    for (const double jitter : {0.3, 0.9}) {
      SampleOptions options;
      options.cells = 2;
      options.jitter = jitter;
      options.features = jitter > 0.5;
      const TetMap map = generateSample(kind, options).map;
      HexMesh without = extracted(map, 2);
      HexMesh with = without;
      const ImproveReport never = pillows::improvedWith(without, map, PillowMode::Never);
      const ImproveReport automatic = pillows::improvedWith(with, map, PillowMode::Auto);
      EXPECT_LE(pillows::bad(automatic), pillows::bad(never));
      if (pillows::bad(automatic) == pillows::bad(never)) {
        EXPECT_GE(automatic.after.quality.minimum, never.after.quality.minimum);
      }
      EXPECT_LE(automatic.distanceAfter.hausdorff(),
                1.001 * std::max(never.distanceAfter.hausdorff(), kSurfaceTolerance));
    }
  }
}

TEST(ImprovePillow, KeepsRegionsAndTagsOnTheirFaces) {
  TetMap map = identityMap(6);
  for (const Tet& tet : map.tets) {
    double x = 0;
    for (const Index v : tet) x += map.points[v][0] / 4;
    map.regions.push_back(x < 3 ? 1 : 2);
  }
  HexMesh mesh = extracted(map, 1);
  const ImproveReport report = pillows::improvedWith(mesh, map, PillowMode::Always);
  EXPECT_EQ(report.addedCells, 6U * 36);
  EXPECT_TRUE(report.after.allPositive());
  EXPECT_LT(report.innerDistanceAfter, 1e-9);
  EXPECT_LT(report.distanceAfter.hausdorff(), 1e-9);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    for (const Index v : mesh.cells[c]) {
      const double x = mesh.points[v][0];
      EXPECT_TRUE(mesh.regions[c] == 1 ? x < 3 + 1e-9 : x > 3 - 1e-9);
    }
  }
}

TEST(ImprovePillow, StaysInsideAThinPlate) {
  HexMesh mesh =
      hexhex::testing::gridMesh(5, [](std::size_t, std::size_t, std::size_t z) { return z == 0; });
  for (Vec3& point : mesh.points) point[2] *= 0.01;
  Context context(2);
  ImproveOptions options;
  options.pillow = PillowMode::Always;
  const ImproveReport report = improve(mesh, options, context);
  EXPECT_EQ(report.addedCells, 2U * 25 + 20U);
  EXPECT_TRUE(report.after.allPositive());
  EXPECT_LT(report.distanceAfter.hausdorff(), 1e-12);
}

TEST(ImprovePillow, IsRefusedWhereThereCannotBeOne) {
  HexMesh pair =
      hexhex::testing::gridMesh(2, [](auto x, auto y, auto z) { return z == 0 && x == y; });
  const HexMesh before = pair;
  Context context(2);
  ImproveOptions options;
  options.pillow = PillowMode::Always;
  EXPECT_EQ(codeOf([&] { improve(pair, options, context); }), ErrorCode::NonManifoldEdge);
  EXPECT_EQ(pair.points, before.points);
  EXPECT_EQ(pair.cells, before.cells);
  options.pillow = PillowMode::Auto;
  EXPECT_EQ(improve(pair, options, context).addedCells, 0U);
  const TetMap map = identityMap(2);
  LagrangeMesh curved = extractLagrange(map, 2, {}, context);
  EXPECT_EQ(codeOf([&] { improve(curved, map, options, context); }), ErrorCode::InvalidArgument);
}

}  // namespace hexhex::test
