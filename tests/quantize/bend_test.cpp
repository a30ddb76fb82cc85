// Bent maps: integer-grid maps with the integers that they were to have.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/effort.hpp>

#include <hexhex/hexhex.hpp>

#include "extract/support.hpp"
#include "quantize/bend/bend_split.hpp"
#include "quantize/bend/edge_turns.hpp"
#include "quantize/bend_problem_file.hpp"
#include "quantize/bend_problems.hpp"

namespace hexhex::test {

using namespace quantization;

namespace {

TetMap sample(SampleKind kind, int cells, double jitter, ChartStyle charts = ChartStyle::Blocks,
              std::uint64_t seed = 1) {
  SampleOptions options;
  options.cells = cells;
  options.refine = 2;
  options.jitter = jitter;
  options.charts = charts;
  options.seed = seed;
  return oriented(generateSample(kind, options).map);
}

/// Exactly valid, with the mesh of the map that had the integers.
void expectMeshOf(const TetMap& target, const BentMap& map) {
  ASSERT_TRUE(map.isValid()) << map.contradictions.size() << ' ' << map.flippedTets.size();
  CheckOptions strict;
  strict.tolerance = 0;
  const CheckReport report = check(mapOf(map), strict);
  ASSERT_TRUE(report.defects.empty()) << report.defects[0].sentence;
  const Expectation wanted = check(target).expected;
  EXPECT_EQ(report.expected.cells, wanted.cells);
  EXPECT_EQ(report.expected.boundaryQuads, wanted.boundaryQuads);
  EXPECT_EQ(report.expected.innerSingularEdges, wanted.innerSingularEdges);
  EXPECT_EQ(report.expected.boundarySingularEdges, wanted.boundarySingularEdges);
  ExtractOptions exact;
  exact.tolerance = 0;
  verifiedExtraction(mapOf(map), exact);
}

TEST(Bend, LeavesAnIntegerGridMapAsItIs) {
  for (const SampleKindName& kind : sampleKinds()) {
    SCOPED_TRACE(kind.name);
    const TetMap map = sample(kind.kind, 3, 0.4);
    const BentMap result = bent(problemFrom(map, map));
    expectMeshOf(map, result);
    EXPECT_NEAR(result.energy, 5, 1e-9);
    EXPECT_EQ(result.tets, map.tets);
    for (std::size_t t = 0; t < map.tets.size(); ++t) {
      const Vec3 move = minus(result.parameters[t][0], map.parameters[t][0]);
      for (std::size_t i = 1; i < 4; ++i) {
        // Charts may be moved together along what nothing fixes.
        const Vec3 other = minus(result.parameters[t][i], map.parameters[t][i]);
        EXPECT_LT(length(minus(other, move)), 1e-6);
      }
    }
  }
}

TEST(Bend, ReachesOtherIntegersFromRandomSamples) {
  std::mt19937_64 random(26);
  const auto below = [&random](int n) { return static_cast<int>(random() % std::uint64_t(n)); };
  for (int i = 0; i < cases(24); ++i) {
    const SampleKindName& kind = sampleKinds()[static_cast<std::size_t>(i) % sampleKinds().size()];
    const auto charts = chartStyles()[static_cast<std::size_t>(below(4))].kind;
    const auto seed = random() % 1000;
    const TetMap target = sample(kind.kind, 1 + below(6), 0.1 * below(5), charts, seed);
    const TetMap reference = sample(kind.kind, 2 + below(5), 0.1 * below(9), charts, seed);
    SCOPED_TRACE(std::string(kind.name) + ", case " + std::to_string(i));
    expectMeshOf(target, bent(problemFrom(target, reference)));
  }
}

TEST(Bend, DoesNotDependOnThreads) {
  const BendProblem problem =
      problemFrom(sample(SampleKind::Sphere, 2, 0.3), sample(SampleKind::Sphere, 5, 0.6));
  const BentMap one = bent(problem, 1);
  const BentMap two = bent(problem, 2);
  EXPECT_EQ(one.parameters, two.parameters);
  EXPECT_EQ(one.energy, two.energy);
}

TEST(Bend, NamesVerticesWithoutAnyPlace) {
  const TetMap map = sample(SampleKind::Cylinder, 3, 0);
  BendProblem problem = problemFrom(map, map);
  adjacency::HalfFace moved = 0;
  while (problem.planes[moved].axis < 0) ++moved;
  ++problem.planes[moved].coordinate;
  const BentMap result = bent(problem);
  EXPECT_FALSE(result.isValid());
  EXPECT_TRUE(result.parameters.empty());
  for (const int corner : lattice::kFaceCorners[moved % 4]) {
    const Index v = problem.tets[adjacency::tetOf(moved)][static_cast<std::size_t>(corner)];
    EXPECT_TRUE(std::binary_search(result.contradictions.begin(), result.contradictions.end(), v));
  }
}

TEST(Bend, ReportsWhatStaysFlipped) {
  // A box that is to be turned inside out along one axis.
  const TetMap map = sample(SampleKind::Box, 2, 0, ChartStyle::Aligned);
  BendProblem problem = problemFrom(map, map);
  for (BoundaryPlane& plane : problem.planes) {
    if (plane.axis == 0) plane.coordinate = -plane.coordinate;
  }
  const BentMap result = bent(problem);
  EXPECT_TRUE(result.contradictions.empty());
  EXPECT_FALSE(result.flippedTets.empty());
  EXPECT_GT(result.splitEdges.size(), 0U);
  EXPECT_EQ(result.points.size(), map.points.size() + result.splitEdges.size());
  EXPECT_EQ(result.parentTet.size(), result.tets.size());
  EXPECT_LE(result.tets.size(), 2.1 * static_cast<double>(map.tets.size()));
}

/// One tet whose corners are bound to planes: axis and coordinate, for each corner.
Tightness tightnessOf(const std::array<std::vector<BoundaryPlane>, 4>& corners) {
  BendProblem problem;
  problem.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  problem.tets = {{0, 1, 2, 3}};
  problem.reference = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  problem.transitions.resize(4);
  problem.planes.resize(4);
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (!corners[i].empty()) problem.fixedCorners[i] = corners[i];
  }
  const BentMap map = bent(problem, 1, {.maxGrowth = 1});
  EXPECT_TRUE(map.contradictions.empty());
  EXPECT_EQ(map.flippedTets, std::vector<Index>{0});
  EXPECT_EQ(map.tightness.tet, 0U);
  return map.tightness;
}

TEST(Bend, SaysWhatKeepsTetsFlat) {
  const BoundaryPlane x0{0, 0};
  const BoundaryPlane x1{0, 1};
  const BoundaryPlane y0{1, 0};
  const BoundaryPlane y1{1, 1};
  const BoundaryPlane z0{2, 0};
  const BoundaryPlane z1{2, 1};
  const Tightness plane = tightnessOf({{{z0}, {z0}, {z0}, {z0, x0}}});
  EXPECT_EQ(plane.inPlane, 1U);
  EXPECT_NE(plane.describe().find("1 tet is kept flat by a plane"), std::string::npos);
  const Tightness line = tightnessOf({{{y0, z0}, {y0, z0}, {y0, z0, x0}, {z1}}});
  EXPECT_EQ(line.onCurve, 1U);
  EXPECT_EQ(tightnessOf({{{y0, z0}, {y0, z0}, {y1, z1}, {y1, z1}}}).onCurve, 1U);
  const Tightness point = tightnessOf({{{x0, y0, z0}, {x0, y0, z0}, {y1}, {z1}}});
  EXPECT_EQ(point.atPoint, 1U);
  EXPECT_NE(point.describe().find("two vertices at one place"), std::string::npos);
  // A mirrored tet is not flat.
  const Tightness mirrored =
      tightnessOf({{{x0, y0, z0}, {x0, y1, z0}, {x1, y0, z0}, {x0, y0, z1}}});
  EXPECT_EQ(mirrored.others, 1U);
  EXPECT_EQ(mirrored.corners[3], 4U);
  EXPECT_EQ(mirrored.inPlane + mirrored.onCurve + mirrored.atPoint, 0U);
}

TEST(Bend, FindsEdgesThatAreWoundTwice) {
  // Seen from its axis, the star of valence 8 turns twice as often as one of valence 4 does.
  SampleOptions options;
  options.valence = 8;
  const TetMap map = oriented(generateSample(SampleKind::Star, options).map);
  Context context;
  Stage stage(context, "test");
  auto topology = adjacency::manifoldTopology(map.tets, map.points.size(), stage);
  ASSERT_TRUE(topology);
  adjacency::addStars(*topology, stage);
  const IrregularEdges irregular = irregularEdges(adjacency::EdgeFans(*topology), topology->tets,
                                                  std::span<const TetParameters>(map.parameters));
  EXPECT_EQ(irregular.begin()->second, 8);
  EXPECT_TRUE(tetsAtOtherTurns(*topology, irregular, map.parameters, stage).empty());
  EXPECT_FALSE(tetsAtOtherTurns(*topology, {}, map.parameters, stage).empty());
  // In space, the angles around the axis add up to 360 degrees only.
  std::vector<TetParameters> inSpace;
  for (const Tet& tet : map.tets) {
    inSpace.push_back(
        {map.points[tet[0]], map.points[tet[1]], map.points[tet[2]], map.points[tet[3]]});
  }
  EXPECT_FALSE(tetsAtOtherTurns(*topology, irregular, inSpace, stage).empty());
}

/// Every seventh tet's first edge, more or less.
std::vector<tetmap::EdgeInTet> someEdges(const TetMap& map) {
  std::vector<tetmap::EdgeInTet> edges;
  for (Index t = 0; t < map.tets.size(); t += 7) {
    edges.push_back({tetmap::pairOf(map.tets[t][t % 4], map.tets[t][(t + 1) % 4]), t});
  }
  sortUnique(edges);
  return edges;
}

void expectSameMapAfterSplits(const TetMap& map) {
  BendState state{problemFrom(map, map), map.parameters, std::vector<Index>(map.tets.size()), {}};
  const std::vector<tetmap::EdgeInTet> edges = someEdges(map);
  Context context;
  Stage stage(context, "topology");
  auto topology = adjacency::manifoldTopology(map.tets, map.points.size(), stage);
  ASSERT_TRUE(topology);
  ASSERT_TRUE(splitEdges(state, *topology, edges, 100 * map.tets.size()));
  EXPECT_EQ(state.problem.points.size(), map.points.size() + edges.size());
  EXPECT_GT(state.problem.tets.size(), map.tets.size() + edges.size());
  const TetMap split{state.problem.points, state.problem.tets, state.bent};
  const CheckReport report = check(split);
  EXPECT_TRUE(report.defects.empty());
  EXPECT_EQ(report.expected.cells, check(map).expected.cells);
  // Transitions and planes are still those of the map.
  const BendProblem again = problemFrom(split, split);
  EXPECT_EQ(again.planes, state.problem.planes);
  EXPECT_EQ(again.transitions, state.problem.transitions);
  EXPECT_EQ(again.irregularEdges, state.problem.irregularEdges);
}

TEST(BendSplit, KeepsTheMap) {
  for (const SampleKindName& kind : sampleKinds()) {
    SCOPED_TRACE(kind.name);
    expectSameMapAfterSplits(sample(kind.kind, 3, 0.3, ChartStyle::Random));
  }
}

TEST(BendProblemFile, KeepsEverything) {
  const BendProblem problem =
      problemFrom(sample(SampleKind::Sphere, 2, 0.3), sample(SampleKind::Sphere, 5, 0.6));
  const auto path = std::filesystem::path(testing::TempDir()) / "problem.bend";
  writeBendProblem(path.string(), problem);
  const BendProblem read = readBendProblem(path.string());
  EXPECT_EQ(read.points, problem.points);
  EXPECT_EQ(read.tets, problem.tets);
  EXPECT_EQ(read.reference, problem.reference);
  EXPECT_EQ(read.transitions, problem.transitions);
  EXPECT_EQ(read.planes, problem.planes);
  EXPECT_EQ(read.irregularEdges, problem.irregularEdges);
  std::filesystem::remove(path);
}

/// A map of a real model, or none.
TetMap realMap(const std::string& name) {
  const char* chosen = std::getenv("HEXHEX_DATA");
  const auto file = std::filesystem::path(chosen != nullptr ? chosen : HEXHEX_DATA_DIR) / "maps" /
                    (name + ".hexex");
  return std::filesystem::exists(file) ? oriented(readMap(file)) : TetMap{};
}

TEST(BendRealMaps, FindsTheWayFromHighToLowDensity) {
  HEXHEX_LARGE_TEST();
  for (const auto& [target, reference] : {std::pair("s17c_sphere_r0.1", "s17c_sphere_r100"),
                                          {"fandisk_r0.01", "fandisk_r100"},
                                          {"fanpart_r0.1", "fanpart_r10"},
                                          {"s15c_cylinder_r0.01", "s15c_cylinder_r100"},
                                          {"double-torus_r1", "double-torus_r100"}}) {
    SCOPED_TRACE(target);
    const TetMap coarse = realMap(target);
    if (coarse.tets.empty()) GTEST_SKIP() << "no real maps";
    const BentMap result = bent(problemFrom(coarse, realMap(reference)));
    expectMeshOf(coarse, result);
    EXPECT_EQ(result.tets.size(), coarse.tets.size());
  }
}

/// Sums of integers of the same transitions are such integers, too: few are left of the finer map.
BendProblem difference(const TetMap& fine, const TetMap& coarse, int times) {
  BendProblem problem = problemFrom(fine, fine);
  const BendProblem other = problemFrom(coarse, coarse);
  for (std::size_t h = 0; h < problem.transitions.size(); ++h) {
    for (std::size_t k = 0; k < 3; ++k) {
      problem.transitions[h].translation[k] -= times * other.transitions[h].translation[k];
    }
    problem.planes[h].coordinate -= times * other.planes[h].coordinate;
  }
  const double scale = 1 - times * std::cbrt(volumeOf(coarse) / volumeOf(fine));
  for (TetParameters& tet : problem.reference) {
    for (Vec3& u : tet) u = {scale * u[0], scale * u[1], scale * u[2]};
  }
  return problem;
}

TEST(BendRealMaps, FindsRoomWhereThereIsLittle) {
  HEXHEX_LARGE_TEST();
  const TetMap fine = realMap("s17c_sphere_r100");
  if (fine.tets.empty()) GTEST_SKIP() << "no real maps";
  const BentMap result = bent(difference(fine, realMap("s17c_sphere_r0.1"), 9));
  ASSERT_TRUE(result.isValid());
  EXPECT_LT(result.tets.size(), 1.2 * static_cast<double>(fine.tets.size()));
  EXPECT_EQ(result.points.size(), fine.points.size() + result.splitEdges.size());
  ExtractOptions exact;
  exact.tolerance = 0;
  EXPECT_EQ(verifiedExtraction(mapOf(result), exact).cells.size(), 199U);
}

}  // namespace

}  // namespace hexhex::test
