// What keeps cells from being better, and cells that nothing makes positive.
#include <cmath>

#include <gtest/gtest.h>

#include <hexhex/improve.hpp>

#include "mesh/grid_meshes.hpp"

namespace hexhex::test {

using testing::gridMesh;

namespace {

ImproveReport improvedAlone(HexMesh& mesh, const ImproveOptions& options = {}) {
  Context context(1);
  return improve(mesh, options, context);
}

/// A block on a kite of 30, 110, 110 and 110 degrees: one of its upright edges is sharp.
HexMesh sharpBlock() {
  HexMesh mesh = gridMesh(4);
  for (Vec3& point : mesh.points) {
    const double u = point[0] / 4;
    const double v = point[1] / 4;
    point[0] = 4 * u * (1 - v) + 2 * std::sqrt(3.0) * v * (1 - u) + 4.432 * u * v;
    point[1] = 2 * v * (1 - u) + 1.188 * u * v;
  }
  return mesh;
}

}  // namespace

TEST(WorstCell, IsHeldByASharpEdgeOrCorner) {
  HexMesh mesh = sharpBlock();
  const WorstCell worst = improvedAlone(mesh).worst;
  EXPECT_TRUE(worst.holder == CellHolder::Curve || worst.holder == CellHolder::Corner);
  EXPECT_NEAR(worst.angle, 30, 1e-6);
  EXPECT_FALSE(worst.isTagged);
}

TEST(WorstCell, IsHeldByTaggedVertices) {
  HexMesh mesh = sharpBlock();
  for (Index v = 0; v < mesh.points.size(); ++v) {
    if (mesh.points[v][0] == 0) mesh.features.vertices.push_back({v, 7});
  }
  const WorstCell worst = improvedAlone(mesh).worst;
  EXPECT_EQ(worst.holder, CellHolder::Corner);
  EXPECT_TRUE(worst.isTagged);
  EXPECT_NEAR(worst.angle, 30, 1e-6);
}

TEST(WorstCell, IsHeldByTheOption) {
  HexMesh mesh = sharpBlock();
  EXPECT_EQ(improvedAlone(mesh, {.fixBoundary = true}).worst.holder, CellHolder::Held);
}

TEST(WorstCell, IsHeldByNothingButOthersInside) {
  HexMesh mesh = gridMesh(4);
  for (Vec3& point : mesh.points) {
    if (point == Vec3{2, 2, 2}) point = {2.4, 2.3, 2.2};
  }
  const ImproveReport report = improvedAlone(mesh, {.target = 0, .passes = 0});
  EXPECT_EQ(report.worst.holder, CellHolder::Neighbours);
  EXPECT_EQ(report.worst.angle, 0);
}

/// Two cells around an edge that has no others: at its ends, their determinants are opposite.
TEST(WorstCell, MayShareTwoFacesWithAnother) {
  HexMesh mesh = gridMesh(1);
  const Hex a = mesh.cells[0];
  mesh.points.push_back({-1, -1, 0});
  mesh.points.push_back({-1, -1, 1});
  mesh.cells.push_back({a[0], a[3], 8, a[1], a[4], a[7], 9, a[5]});
  const Array<Vec3> before = mesh.points;
  const ImproveReport report = improvedAlone(mesh);
  EXPECT_EQ(report.cannotBePositive, (Array<std::uint64_t>{1}));
  EXPECT_EQ(report.notPositive, (Array<std::uint64_t>{1}));
  EXPECT_EQ(report.worst.holder, CellHolder::SharedFaces);
  EXPECT_EQ(report.worst.cell, 1U);
  EXPECT_EQ(mesh.points, before);
}

}  // namespace hexhex::test
