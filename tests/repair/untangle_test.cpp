// The solver alone, on problems whose best answers are known.
#include "repair/untangle.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include <base/vector3.hpp>
#include <mesh/grid_meshes.hpp>

#include "igm/prepare.hpp"
#include "repair/patch_problem.hpp"

namespace hexhex::test {

namespace {

class Untangle : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!canUntangle()) GTEST_SKIP() << "skipped: built without libLBFGS";
  }

  Context context{1};
  Stage stage{context, "test"};
};

constexpr std::array<Vec3, 4> kCornerOfCube = {Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// A tet that is to be the corner of a cube, with one vertex to be moved there.
UntangleProblem problemWithFree(std::size_t corner, const Vec3& start, double sign) {
  UntangleTet tet;
  tet.inverseShape = {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t i = 0; i < 4; ++i) tet.corners[i].constant = kCornerOfCube[i];
  UntangleCorner& free = tet.corners[corner];
  free.constant = {7, 8, 9};
  free.unknown = {0, 1, 2};
  free.sign = {sign, sign, sign};
  UntangleProblem problem;
  problem.tets = {tet};
  for (std::size_t k = 0; k < 3; ++k) problem.x.push_back(sign * (start[k] - free.constant[k]));
  return problem;
}

TEST_F(Untangle, FindsTheIdealShape) {
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (const double sign : {1.0, -1.0}) {
      // A place on the wrong side of the other three, and one on the right side.
      for (const Vec3& start : {Vec3{0.5, 0.75, 0.9}, Vec3{-0.75, -0.5, -0.25}}) {
        UntangleProblem problem = problemWithFree(corner, start, sign);
        EXPECT_NEAR(untangle(problem, stage), 1, 1e-3);
        for (std::size_t k = 0; k < 3; ++k) {
          const double found = problem.tets[0].corners[corner].constant[k] + sign * problem.x[k];
          EXPECT_NEAR(found, kCornerOfCube[corner][k], 1e-3) << "corner " << corner;
        }
      }
    }
  }
}

/// What untangle() makes small, of a tet that is to be the corner of a cube.
double energyOf(const TetParameters& u) {
  const std::array<Vec3, 3> edges = {minus(u[1], u[0]), minus(u[2], u[0]), minus(u[3], u[0])};
  double squares = 0;
  for (const Vec3& edge : edges) squares += dot(edge, edge);
  const double det = tripleProduct(edges[0], edges[1], edges[2]);
  return squares / std::cbrt(det * det) + (det * det + 1) / det;
}

/// A vertex between two tets, of which each would have it elsewhere: for one it is the first
/// corner, for the other the last.
TEST_F(Untangle, FindsTheBestPlaceForTwoTets) {
  const auto tetsAt = [](double z) {
    const Vec3 middle = {0.3, 0.2, z};
    return std::array{TetParameters{Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, middle},
                      TetParameters{middle, Vec3{0, 1, 1.5}, {0, 0, 1.5}, {1, 0, 1.5}}};
  };
  const auto energyAt = [&](double z) {
    const auto tets = tetsAt(z);
    return energyOf(tets[0]) + energyOf(tets[1]);
  };
  double best = 0.1;
  for (double z = 0.1; z < 1.4; z += 1e-4) best = energyAt(z) < energyAt(best) ? z : best;
  EXPECT_GT(std::abs(best - 0.75), 0.02);

  UntangleProblem problem;
  problem.x = {2.5};
  const auto tets = tetsAt(0);
  for (std::size_t t = 0; t < 2; ++t) {
    UntangleTet tet;
    tet.inverseShape = {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t i = 0; i < 4; ++i) tet.corners[i].constant = tets[t][i];
    UntangleCorner& free = tet.corners[t == 0 ? 3 : 0];
    free.unknown[2] = 0;
    free.sign[2] = 1;
    problem.tets.push_back(tet);
  }
  EXPECT_GT(untangle(problem, stage), 0);
  EXPECT_NEAR(problem.x[0], best, 1e-3);
}

/// Shapes in space are what a patch aims at, made as large as its volume in the map.
TEST_F(Untangle, LeavesAPatchWithoutDefectsAsItIs) {
  TetMap map = testing::identityMap(4);
  for (Vec3& p : map.points) {
    for (double& x : p) x *= 0.7;
  }
  DefectCollector defects;
  const PreparedMap prepared = prepareMap(map, 1e-2, 1, context, defects);
  ASSERT_TRUE(defects.empty());
  const LocalParameters parameters(prepared.input);
  const std::array<Index, 1> start = {7};
  const Patch patch = growPatch(prepared.topology, start, 2);
  const PatchCharts charts(map, prepared.topology, parameters, patch, 1e-2);
  const std::vector<PatchVertex> vertices = findFreedom(parameters, patch, charts);
  PatchProblem problem(map, prepared.topology, parameters, patch, vertices);
  const std::vector<double> before = problem.problem().x;
  ASSERT_GT(before.size(), 3U);
  EXPECT_NEAR(untangle(problem.problem(), stage), 1, 1e-6);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(problem.problem().x[i], before[i], 1e-6);
  }
}

/// The best place for the only inner vertex of a cube is its middle, where it is in space.
TEST_F(Untangle, MovesVerticesToWhereTheyAreInSpace) {
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
