// Partial extraction: everything of a valid map, and what is left of others.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <support/effort.hpp>

#include <hexhex/hexhex.hpp>

#include <mesh/grid_meshes.hpp>

#include "extract/support.hpp"
#include "repair/cell_flood.hpp"
#include "repair/same_connectivity.hpp"

namespace hexhex::test {

using namespace repairs;

namespace {

std::int64_t cellsAtHoles(const PartialMesh& partial) {
  return std::count(partial.mesh.regions.begin(), partial.mesh.regions.end(), std::int32_t{1});
}

TEST(CubeClip, MeasuresPiecesOfTheUnitCube) {
  // The corner of the cube that x + y + z <= 1/2 cuts off, from a tet far larger on one side.
  EXPECT_NEAR(volumeInCube({Vec3{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}), 1.0 / 48,
              1e-15);
  EXPECT_NEAR(volumeInCube({Vec3{-9, -9, -9}, {40, -9, -9}, {-9, 40, -9}, {-9, -9, 40}}), 1, 1e-12);
  // x + y + z <= 1.5 halves the cube.
  EXPECT_NEAR(volumeInCube({Vec3{-1, -1, -1}, {3.5, -1, -1}, {-1, 3.5, -1}, {-1, -1, 3.5}}), 0.5,
              1e-12);
  EXPECT_EQ(volumeInCube({Vec3{2, 0, 0}, {3, 0, 0}, {2, 1, 0}, {2, 0, 1}}), 0);
  const ClippedTriangle triangle = clipToCube({Vec3{0, 0, 0.5}, {4, 0, 0.5}, {0, 4, 0.5}});
  EXPECT_NEAR(triangle.area, 1, 1e-15);
  EXPECT_NEAR(triangle.centre[0], 0.5, 1e-15);
}

/// Damaged maps have cells whose tets miss a corner by less than any tolerance of volumes.
TEST(CellFlood, FindsNoCornerThatNoTetHolds) {
  const TetMap cube = testing::identityMap(1);
  Context context;
  igm::DefectCollector defects;
  igm::PreparedMap prepared = igm::prepareMap(cube, 1e-2, 1, context, defects);
  ASSERT_TRUE(defects.empty());
  const std::vector<std::uint8_t> valid(cube.tets.size(), 1);
  CellFlood flood(prepared, valid);
  ASSERT_TRUE(flood.run(0, {0, 0, 0}));
  for (std::size_t i = 0; i < 8; ++i) EXPECT_TRUE(flood.corner(i).has_value());
  // All tets meet in corner 6.
  for (lattice::LatticeTet& corners : prepared.exact.corners) {
    for (lattice::LatticePoint& corner : corners) {
      if (corner ==
          lattice::LatticePoint{prepared.exact.unit, prepared.exact.unit, prepared.exact.unit}) {
        for (std::int64_t& x : corner) --x;
      }
    }
  }
  ASSERT_TRUE(flood.run(0, {0, 0, 0}));
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(flood.corner(i).has_value(), i != 6);
}

TEST(Partial, IsTheWholeMeshOfAValidMap) {
  for (const SampleKindName& entry : sampleKinds()) {
    SCOPED_TRACE(entry.name);
    SampleOptions options;
    options.cells = 3;
    options.charts = ChartStyle::Random;
    options.jitter = 0.4;
    options.onLattice = 0.3;
    const TetMap map = generateSample(entry.kind, options).map;
    Context context;
    const PartialMesh partial = extractPartial(map, {}, context);
    EXPECT_TRUE(sameConnectivity(partial.mesh, extract(map)));
    EXPECT_TRUE(partial.holes.empty());
    EXPECT_EQ(cellsAtHoles(partial), 0);
    EXPECT_EQ(partial.faceConflicts, 0U);
    EXPECT_TRUE(verify(map, partial.mesh).passed());
  }
}

TEST(Partial, LeavesHolesAtDefects) {
  HEXHEX_LARGE_TEST();
  SampleOptions options;
  options.cells = 6;
  options.refine = 3;
  options.charts = ChartStyle::Blocks;
  const std::size_t wanted = extract(generateSample(SampleKind::Sphere, options).map).cells.size();
  options.defects = 4;
  const TetMap map = generateSample(SampleKind::Sphere, options).map;
  for (const int scale : {1, 2}) {
    Context context;
    const PartialMesh partial = extractPartial(map, {scale, 1e-2}, context);
    const auto all = static_cast<double>(wanted * static_cast<std::size_t>(scale * scale * scale));
    const auto cells = static_cast<double>(partial.mesh.cells.size());
    EXPECT_GT(cells, 0.7 * all);
    EXPECT_LT(cells, all);
    ASSERT_FALSE(partial.holes.empty());
    EXPECT_NEAR(partial.missingCells, all - cells, 1.5);
    EXPECT_GT(cellsAtHoles(partial), 0);
    EXPECT_LT(cellsAtHoles(partial), static_cast<std::int64_t>(partial.mesh.cells.size()));
    EXPECT_EQ(partial.faceConflicts, 0U);
    EXPECT_GE(partial.invalidTets, 4U);
    Context one(1);
    const PartialMesh again = extractPartial(map, {scale, 1e-2}, one);
    EXPECT_EQ(again.mesh.points, partial.mesh.points);
    EXPECT_EQ(again.mesh.cells, partial.mesh.cells);
  }
}

/// Moving an inner vertex changes no volume, so holes have exactly what cells lack. All tets at
/// vertex (1, 1, 1) are part of the hole, also the first tet of the map.
TEST(Partial, HolesHaveTheVolumeThatIsMissing) {
  TetMap map = testing::identityMap(3);
  for (TetParameters& corners : map.parameters) {
    for (Vec3& u : corners) {
      if (u == Vec3{1, 1, 1}) u = {1.75, 1.5, 2.25};
    }
  }
  Context context;
  const PartialMesh partial = extractPartial(map, {}, context);
  EXPECT_LT(partial.mesh.cells.size(), 27U);
  ASSERT_EQ(partial.holes.size(), 1U);
  EXPECT_EQ(partial.holes[0].tet, 0U);
  EXPECT_NEAR(partial.missingCells, 27.0 - static_cast<double>(partial.mesh.cells.size()), 1e-12);
}

TEST(Partial, ManagesAMapBeyondRepair) {
  const char* chosen = std::getenv("HEXHEX_DATA");
  const std::filesystem::path file =
      std::filesystem::path(chosen != nullptr ? chosen : HEXHEX_DATA_DIR) / "defective/spot.hexex";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no real maps here";
  Context context;
  const PartialMesh partial = extractPartial(readMap(file), {}, context);
  EXPECT_GT(partial.mesh.cells.size(), 100U);
  EXPECT_FALSE(partial.holes.empty());
}

}  // namespace

}  // namespace hexhex::test
