// The solver, on problems whose answers are known.
#include "untangle/untangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include <base/parallel.hpp>

#include "untangle/grid_problem.hpp"

namespace hexhex::test {

using untangle::Corner;
using untangle::Element;
using untangle::End;
using untangle::Problem;
using untangle::Result;
using untangle::Solver;

namespace {

struct Untangle : ::testing::Test {
  Context context{1};
  Stage stage{context, "test"};

  Result untangled(Problem& problem) { return Solver(problem, stage).run({}); }
};

constexpr std::array<Vec3, 4> kCornerOfCube = {Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr std::array<Vec3, 3> kAxes = {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// A tet that is to be the corner of a cube, with one vertex to be moved there.
Problem problemWithFree(std::size_t corner, const Vec3& start, std::int8_t sign) {
  Element tet;
  tet.gradients = kAxes;
  for (std::size_t i = 0; i < 4; ++i) tet.corners[i].constant = kCornerOfCube[i];
  tet.corners[corner] = {{7, 8, 9}, {0, 1, 2}, {sign, sign, sign}};
  Problem problem;
  problem.elements = {tet};
  for (std::size_t k = 0; k < 3; ++k) {
    problem.x.push_back(sign * (start[k] - tet.corners[corner].constant[k]));
  }
  return problem;
}

TEST_F(Untangle, FindsTheIdealShape) {
  for (std::size_t corner = 0; corner < 4; ++corner) {
    for (const std::int8_t sign : {std::int8_t{1}, std::int8_t{-1}}) {
      // A place on the wrong side of the other three, and one on the right side.
      for (const Vec3& start : {Vec3{0.5, 0.75, 0.9}, Vec3{-0.75, -0.5, -0.25}}) {
        Problem problem = problemWithFree(corner, start, sign);
        EXPECT_NEAR(untangled(problem).leastDeterminant, 1, 1e-3);
        const Vec3 found = problem.elements[0].corners[corner].at(problem.x.data());
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_NEAR(found[k], kCornerOfCube[corner][k], 1e-3) << "corner " << corner;
        }
      }
    }
  }
}

/// What the solver makes small, of a tet that is to be the corner of a cube.
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

  Problem problem;
  problem.x = {2.5};
  const auto tets = tetsAt(0);
  for (std::size_t t = 0; t < 2; ++t) {
    Element tet;
    tet.gradients = kAxes;
    for (std::size_t i = 0; i < 4; ++i) tet.corners[i].constant = tets[t][i];
    Corner& free = tet.corners[t == 0 ? 3 : 0];
    free.unknown[2] = 0;
    free.sign[2] = 1;
    problem.elements.push_back(tet);
  }
  const Result result = untangled(problem);
  EXPECT_GT(result.leastDeterminant, 0);
  EXPECT_NEAR(problem.x[0], best, 1e-3);
  EXPECT_NEAR(result.energy, energyAt(best), 1e-6);
}

TEST_F(Untangle, UnfoldsAShuffledBox) {
  // Where sides may slide, they may also fold over.
  for (const auto& [boundary, most] :
       {std::pair(Boundary::Fixed, 6.0), {Boundary::Fixed, 1.0}, {Boundary::Sliding, 0.7}}) {
    auto [problem, best] = gridProblem(6, boundary);
    shuffle(problem, most);
    const std::size_t before = flippedTets(problem);
    ASSERT_GT(before, problem.elements.size() / 8);
    const Result result = untangled(problem);
    EXPECT_EQ(result.end, End::Positive);
    EXPECT_TRUE(result.flipped.empty());
    EXPECT_EQ(flippedTets(problem), 0U);
    double least = std::numeric_limits<double>::infinity();
    for (const Element& tet : problem.elements) least = std::min(least, volumeOf(problem, tet));
    EXPECT_NEAR(result.leastDeterminant, least, 1e-12);
    // Nothing is distorted in the best map.
    const auto ideal = 5 * static_cast<double>(problem.elements.size());
    EXPECT_GE(result.energy, ideal * (1 - 1e-12));
    EXPECT_LT(result.energy, ideal * 1.02);
    for (std::size_t i = 0; i < best.size(); ++i) EXPECT_NEAR(problem.x[i], best[i], 0.3);
  }
}

TEST_F(Untangle, StartsAtTheSolutionOfTheLinearProblem) {
  for (const std::size_t n : {5U, 16U}) {  // the second one is too large to be factored
    auto [problem, best] = gridProblem(n, Boundary::Sliding);
    shuffle(problem, 5);
    Solver(problem, stage).start();
    for (std::size_t i = 0; i < best.size(); ++i) EXPECT_NEAR(problem.x[i], best[i], 1e-3);
  }
}

/// Without any constant corner.
TEST_F(Untangle, TurnsElementsTowardsTheirTargets) {
  Problem problem = problemWithFree(0, {}, 1);
  problem.matrices = {{Vec3{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
  problem.pull = 0.5;
  problem.x.assign(12, 0.0);
  Element& tet = problem.elements[0];
  tet.target = 0;
  for (int i = 0; i < 4; ++i) {
    tet.corners[static_cast<std::size_t>(i)] = {{}, {3 * i, 3 * i + 1, 3 * i + 2}, {1, 1, 1}};
  }
  const auto expectTurned = [&] {
    const Vec3 origin = tet.corners[0].at(problem.x.data());
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 edge = minus(tet.corners[i + 1].at(problem.x.data()), origin);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(edge[k], problem.matrices[0][k][i], 1e-3);
    }
  };
  Solver solver(problem, stage);
  solver.start();
  expectTurned();
  shuffle(problem, 0.6);
  EXPECT_EQ(solver.run({}).end, End::Positive);
  expectTurned();
}

/// A tet on its base, which is bound to the plane z = 0. Turned over with its apex below, it is
/// positive: only the element of its base sees the fold.
TEST_F(Untangle, UnfoldsBoundaryTrianglesThatTetsDoNotSee) {
  Element tet;
  tet.gradients = kAxes;
  for (std::size_t i = 0; i < 4; ++i) {
    const int first = static_cast<int>(3 * i);
    tet.corners[i] = {{}, {first, first + 1, i == 3 ? first + 2 : -1}, {1, 1, 1}};
  }
  tet.corners[0] = {};  // at the origin
  Problem problem;
  problem.elements = {tet};
  problem.x.assign(12, 0.0);
  const auto set = [&problem](std::size_t corner, const Vec3& u) {
    std::copy(u.begin(), u.end(), problem.x.begin() + static_cast<std::ptrdiff_t>(3 * corner));
  };
  set(1, {0.3, 1, 0});
  set(2, {0.9, -0.2, 0});
  set(3, {0.1, 0.2, -1});
  ASSERT_GT(volumeOf(problem, tet), 0);
  Problem blind = problem;
  EXPECT_TRUE(untangled(blind).flipped.empty());
  EXPECT_LT(blind.x[11], 0);

  // The base faces -z. Its gradients are those of the tet in its plane.
  Element base = tet;
  base.corners[3] = base.corners[0];
  base.gradients[2] = {};
  base.offset = 0;
  problem.matrices = {{Vec3{0, 0, 0}, {0, 0, 0}, {0, 0, 1}}};  // e n^T with e = n = -z
  problem.elements.push_back(base);
  const Result result = untangled(problem);
  EXPECT_EQ(result.end, End::Positive);
  EXPECT_GT(problem.x[3] * problem.x[7] - problem.x[4] * problem.x[6], 0);
  EXPECT_GT(problem.x[11], 0);
  EXPECT_GT(volumeOf(problem, tet), 0);
}

/// An edge along x that is to run along -y and runs along y.
TEST_F(Untangle, TurnsBorderEdgesRound) {
  constexpr double kLength = 2;
  Element edge;
  edge.corners[0] = {{5, 1, 5}, {-1, -1, -1}, {}};
  edge.corners[1] = {{5, 0, 5}, {-1, 0, -1}, {0, 1, 0}};
  edge.corners[2] = edge.corners[3] = edge.corners[0];
  edge.gradients[0] = {1 / kLength, 0, 0};
  edge.offset = 0;
  Problem problem;
  // R - s e_c d^T for the rotation R that turns x to -y and y to x.
  problem.matrices = {{Vec3{0, 1, 0}, {0, 0, 0}, {0, 0, 1}}};
  problem.elements = {edge};
  problem.x = {3};
  ASSERT_GT(untangle::Solver(problem, stage).run({.polishing = 0}).leastDeterminant, 0);
  EXPECT_LT(problem.x[0], 1);
  EXPECT_NEAR(untangled(problem).leastDeterminant, 1, 1e-3);
  EXPECT_NEAR(problem.x[0], 1 - kLength, 1e-2);
}

TEST_F(Untangle, NamesElementsThatStayFlat) {
  auto [problem, best] = gridProblem(3, Boundary::Sliding);
  EXPECT_TRUE(flatElements(problem).empty());
  // All corners of one tet in a plane, and three of another one on a line.
  Element inPlane = problem.elements[0];
  Element onLine = problem.elements[1];
  for (std::size_t i = 0; i < 4; ++i) {
    inPlane.corners[i] = {{0, 0, 2}, {0, 1, -1}, {1, -1, 0}};
    inPlane.corners[i].unknown = {static_cast<int>(2 * i), static_cast<int>(2 * i + 1), -1};
    if (i < 3) onLine.corners[i] = {{3, 4, 0}, {-1, -1, static_cast<int>(i)}, {0, 0, 1}};
  }
  problem.elements.insert(problem.elements.begin() + 7, inPlane);
  problem.elements.push_back(onLine);
  EXPECT_EQ(flatElements(problem), (std::vector<std::size_t>{7, problem.elements.size() - 1}));
  const Result result = untangled(problem);
  EXPECT_EQ(result.end, End::Stalled);
  EXPECT_FALSE(result.flipped.empty());
  EXPECT_FALSE(flatElements(problem).empty());
}

TEST_F(Untangle, SaysWhatStaysFlippedAndNeverAddsToIt) {
  auto [problem, best] = gridProblem(3, Boundary::Fixed);
  // One cube's corner is nailed down on the far side of the box.
  for (Element& tet : problem.elements) {
    for (Corner& corner : tet.corners) {
      if (corner.constant == Vec3{0, 1, 1}) corner.constant = {9, 1, 1};
    }
  }
  const std::size_t before = flippedTets(problem);
  ASSERT_GT(before, 0U);
  const Result result = untangled(problem);
  EXPECT_EQ(result.end, End::Stalled);
  EXPECT_EQ(result.flipped.size(), flippedTets(problem));
  EXPECT_LE(result.flipped.size(), before);
  for (const std::size_t i : result.flipped) {
    EXPECT_LE(volumeOf(problem, problem.elements[i]), 0);
  }
  EXPECT_LE(result.leastDeterminant, 0);
  EXPECT_TRUE(std::isinf(result.energy));
}

TEST_F(Untangle, CopesWithoutUnknownsOrElements) {
  Problem problem = problemWithFree(0, {}, 1);
  problem.x.clear();
  problem.elements[0].corners[0] = {};
  EXPECT_EQ(untangled(problem).end, End::Positive);
  problem.elements[0].corners[0].constant = {2, 2, 2};
  const Result result = untangled(problem);
  EXPECT_EQ(result.end, End::Stalled);
  EXPECT_EQ(result.flipped, std::vector<std::size_t>{0});
  Problem empty;
  Solver(empty, stage).start();
  EXPECT_EQ(untangled(empty).end, End::Positive);
  empty.x = {1.5};  // in no element
  EXPECT_EQ(untangled(empty).end, End::Positive);
}

TEST(UntangleRuns, DoNotDependOnThreads) {
  const auto run = [](int threads) {
    untangle::Problem problem =
        gridProblem(13, Boundary::Sliding).problem;  // several blocks, several levels
    shuffle(problem, 1);
    Context context(threads);
    Stage stage(context, "test");
    withThreads(threads, [&] { static_cast<void>(Solver(problem, stage).run({})); });
    return problem.x;
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(UntangleRuns, CanBeCancelled) {
  auto [problem, best] = gridProblem(8, Boundary::Sliding);
  shuffle(problem, 4);
  int reports = 0;
  Context* running = nullptr;
  Context context(1, [&](std::string_view, double) {
    if (++reports == 50) running->cancel();
  });
  running = &context;
  Stage stage(context, "test");
  try {
    static_cast<void>(Solver(problem, stage).run({}));
    FAIL() << reports << " reports";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

/// Within a bounded number of steps, each of which takes a time proportional to the box.
TEST(UntangleRuns, EndInLargeBoxes) {
  Context context;
  Stage stage(context, "test");
  auto [problem, best] = gridProblem(24, Boundary::Fixed);
  ASSERT_GT(problem.x.size(), 36'000U);
  shuffle(problem, 1);
  ASSERT_GT(flippedTets(problem), problem.elements.size() / 4);
  const Result result = Solver(problem, stage).run({});
  EXPECT_EQ(result.end, End::Positive);
  EXPECT_EQ(flippedTets(problem), 0U);
  EXPECT_LT(result.steps, 200);
}

}  // namespace

}  // namespace hexhex::test
