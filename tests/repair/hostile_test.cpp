// Maps that no repair can help, and what must hold whatever is repaired.
#include <algorithm>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include "extract/support.hpp"
#include "igm/igm.hpp"
#include "repair/same_connectivity.hpp"
#include "support/error_of.hpp"
#include "support/joined_maps.hpp"

namespace hexhex::test {

namespace {

TetMap sphere(int refine, int defects = 0, std::uint64_t seed = 1) {
  SampleOptions options;
  options.refine = refine;
  options.cells = refine;
  options.charts = ChartStyle::Blocks;
  options.defects = defects;
  options.seed = seed;
  return generateSample(SampleKind::Sphere, options).map;
}

void mirror(TetMap& map, std::size_t begin, std::size_t end) {
  for (std::size_t t = begin; t < end; ++t) {
    for (Vec3& u : map.parameters[t]) u[0] = -u[0];
  }
}

Error errorOfRepair(const TetMap& map) {
  return test::errorOf([&] { static_cast<void>(repair(map)); });
}

class HostileMaps : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!canRepair()) GTEST_SKIP() << "skipped: built without Eigen";
  }
};

TEST_F(HostileMaps, WithAnInvertedComponentAreRefused) {
  TetMap map = joined(sphere(4), sphere(2));
  const std::size_t first = sphere(4).tets.size();
  mirror(map, first, map.tets.size());
  const Error error = errorOfRepair(map);
  EXPECT_EQ(error.code(), ErrorCode::FlippedTet);
  EXPECT_NE(std::string(error.what()).find("component"), std::string::npos) << error.what();
  EXPECT_EQ(error.place().kind, PlaceKind::Tet);
  EXPECT_EQ(error.place().index, first);
}

TEST_F(HostileMaps, WithAnInvertedBlockAreRefused) {
  TetMap map = sphere(5);
  mirror(map, 0, map.tets.size() / 7);
  const Error error = errorOfRepair(map);
  EXPECT_EQ(error.code(), ErrorCode::FlippedTet);
  EXPECT_NE(std::string(error.what()).find("region"), std::string::npos) << error.what();
  EXPECT_LT(error.place().index, map.tets.size() / 7);
}

TEST_F(HostileMaps, WithoutAnySenseAreRefused) {
  TetMap map = sphere(2);
  for (TetParameters& corners : map.parameters) corners = {};
  EXPECT_EQ(errorOfRepair(map).code(), ErrorCode::FlippedTet);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(-5, 5);
  for (TetParameters& corners : map.parameters) {
    for (Vec3& u : corners) u = {anywhere(random), anywhere(random), anywhere(random)};
  }
  EXPECT_EQ(errorOfRepair(map).code(), ErrorCode::FlippedTet);
  map.parameters[3][1][2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(errorOfRepair(map).code(), ErrorCode::NotFinite);
  map.parameters[3][1][2] = 1e12;
  EXPECT_EQ(errorOfRepair(map).code(), ErrorCode::TooLarge);
  EXPECT_EQ(errorOfRepair({}).code(), ErrorCode::EmptyMesh);
}

TEST_F(HostileMaps, OfOneTetAreRefused) {
  TetMap map;
  map.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  map.tets = {{0, 1, 2, 3}};
  map.parameters = {{Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}};
  EXPECT_EQ(errorOfRepair(map).code(), ErrorCode::FlippedTet);
}

/// Damage in two components, with more and less than one thread per place.
TEST_F(HostileMaps, WithSeveralPlacesAreRepairedTheSameWithAnyNumberOfThreads) {
  const TetMap damaged = joined(sphere(4, 8, 1), sphere(3, 5, 2));
  Context one(1);
  RepairReport report;
  const TetMap expected = repair(damaged, {}, one, &report);
  EXPECT_EQ(report.regions.size(), 2U);
  const HexMesh mesh = verifiedExtraction(expected);
  const HexMesh wanted = extract(joined(sphere(4), sphere(3)));
  EXPECT_EQ(mesh.cells.size(), wanted.cells.size());
  EXPECT_EQ(mesh.points.size(), wanted.points.size());
  for (const int threads : {2, 8}) {
    Context many(threads);
    RepairReport again;
    EXPECT_EQ(repair(damaged, {}, many, &again).parameters, expected.parameters);
    EXPECT_EQ(again.largestMove, report.largestMove);
    EXPECT_EQ(again.movedVertices, report.movedVertices);
  }
}

TEST_F(HostileMaps, AreRepairedForLargeScales) {
  const TetMap damaged = sphere(3, 6);
  Context context;
  RepairOptions options;
  options.scale = 5;
  ExtractOptions scaled;
  scaled.scale = 5;
  const HexMesh mesh = verifiedExtraction(repair(damaged, options, context), scaled);
  EXPECT_TRUE(sameConnectivity(mesh, extract(sphere(3), scaled)));
}

}  // namespace

}  // namespace hexhex::test
