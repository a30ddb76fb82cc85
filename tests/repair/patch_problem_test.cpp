// The problems of patches, whose best answers are known.
#include "repair/patch_problem.hpp"

#include <array>

#include <gtest/gtest.h>
#include <untangle/untangle.hpp>

#include <hexhex/hexhex.hpp>

#include <mesh/grid_meshes.hpp>

#include "igm/igm.hpp"

namespace hexhex::test {

using namespace repairs;

namespace {

class PatchSolution : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!canRepair()) GTEST_SKIP() << "skipped: built without Eigen";
  }

  Context context{1};
  Stage stage{context, "test"};
};

/// Shapes in space are what a patch aims at, made as large as its volume in the map.
TEST_F(PatchSolution, LeavesAPatchWithoutDefectsAsItIs) {
  TetMap map = testing::identityMap(4);
  for (Vec3& p : map.points) {
    for (double& x : p) x *= 0.7;
  }
  igm::DefectCollector defects;
  const igm::PreparedMap prepared = igm::prepareMap(map, 1e-2, 1, context, defects);
  ASSERT_TRUE(defects.empty());
  const igm::LocalParameters parameters(prepared.input);
  const std::array<Index, 1> start = {7};
  const Patch patch = growPatch(prepared.topology, start, 2);
  const PatchCharts charts(map, prepared.topology, parameters, patch, 1e-2);
  const std::vector<PatchVertex> vertices = findFreedom(parameters, patch, charts);
  PatchProblem problem(map, prepared.topology, parameters, patch, vertices);
  const std::vector<double> before = problem.problem().x;
  ASSERT_GT(before.size(), 3U);
  EXPECT_NEAR(untangle::Solver(problem.problem(), stage).run({}).leastDeterminant, 1, 1e-6);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(problem.problem().x[i], before[i], 1e-6);
  }
}

/// The best place for the only inner vertex of a cube is its middle, where it is in space.
TEST_F(PatchSolution, MovesVerticesToWhereTheyAreInSpace) {
  TetMap map = testing::identityMap(2);
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (Vec3& u : map.parameters[t]) {
      if (u == Vec3{1, 1, 1}) u = {2.5, 1.25, 0.75};
    }
  }
  const TetMap repaired = repair(map);
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(repaired.parameters[t][c][k], map.points[map.tets[t][c]][k], 1e-3);
      }
    }
  }
}

}  // namespace

}  // namespace hexhex::test
