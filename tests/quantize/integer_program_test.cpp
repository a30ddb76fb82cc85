// What finds the integers of quantization: all solvers that there are give good ones.
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <quantize/integers/integer_program.hpp>

#include <hexhex/error.hpp>

#include "lattice/random.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

using namespace quantization;
namespace {

std::vector<IntegerSolver> solvers() {
  std::vector<IntegerSolver> there;
  for (const IntegerSolver& solver : {highsSolver(), roundingSolver()}) {
    if (solver.name != nullptr) there.push_back(solver);
  }
  return there;
}

/// @return infinity if conditions are broken
double costOf(const IntegerProgram& program, const std::vector<std::int64_t>& integers) {
  if (integers.size() != program.lengths.size()) return INFINITY;
  double cost = 0;
  for (std::size_t a = 0; a < integers.size(); ++a) {
    if (integers[a] < program.least[a]) return INFINITY;
    const double length = program.lengths[a];
    cost += std::abs(static_cast<double>(integers[a]) - length) / std::max(length, 1.0);
  }
  for (const ArcEquation& equation : program.equations) {
    std::int64_t sum = 0;
    for (const auto& [arc, factor] : equation) sum += factor * integers[arc];
    if (sum != 0) return INFINITY;
  }
  return cost;
}

/// A row of rectangles, each divided otherwise below than above: sums of both sides agree.
IntegerProgram rectangles(testing::LatticeRandom& random, double scale) {
  IntegerProgram program;
  for (int rectangle = 0; rectangle < 8; ++rectangle) {
    ArcEquation equation;
    double whole = 0;
    const auto add = [&](double length, int sign) {
      equation.emplace_back(static_cast<Index>(program.lengths.size()), sign);
      program.lengths.push_back(length);
      program.least.push_back(1);
    };
    for (std::uint64_t below = 1 + random.below(3); below-- > 0;) {
      const double length = scale * static_cast<double>(random.between(1, 100)) / 100;
      whole += length;
      add(length, 1);
    }
    const std::uint64_t above = 1 + random.below(3);
    for (std::uint64_t k = 0; k < above; ++k) add(whole / static_cast<double>(above), -1);
    program.equations.push_back(equation);
  }
  return program;
}

TEST(IntegerProgram, AllSolversComeNearToTheMinimum) {
  testing::LatticeRandom random(3);
  for (const double scale : {0.5, 3.0, 40.0}) {
    for (int round = 0; round < 5; ++round) {
      const IntegerProgram program = rectangles(random, scale);
      const double first = costOf(program, solvers().front().solve(program, Context()));
      for (const IntegerSolver& solver : solvers()) {
        SCOPED_TRACE(solver.name);
        const bool isRounding = std::string(solver.name) == "rounding";
        if (isRounding && scale < 10) continue;  // often finds none
        const double cost = costOf(program, solver.solve(program, Context()));
        EXPECT_LE(cost, first * (isRounding ? 2 : 1.011) + 1e-6);
      }
    }
  }
}

TEST(IntegerProgram, WithoutASolutionIsToldFromOthers) {
  IntegerProgram program;
  program.lengths = {1, 1, 1};
  program.least = {1, 1, 1};
  program.equations = {{{0, 1}, {1, 1}}};  // n0 + n1 = 0
  for (const IntegerSolver& solver : solvers()) {
    SCOPED_TRACE(solver.name);
    EXPECT_TRUE(solver.solve(program, Context()).empty());
  }
}

/// Few equations with large factors (market splits, Cornuejols and Dawande 1998): small, but long.
IntegerProgram hardProgram() {
  IntegerProgram program;
  program.lengths.assign(40, 1.5);
  program.least.assign(40, 1);
  testing::LatticeRandom random(24);
  for (int row = 0; row < 4; ++row) {
    ArcEquation equation;
    for (Index arc = 0; arc < 40; ++arc) {
      equation.emplace_back(arc, static_cast<int>(random.between(-50, 50)));
    }
    program.equations.push_back(equation);
  }
  return program;
}

TEST(IntegerProgram, SolversEndWhenCancelled) {
  for (const IntegerSolver& solver : solvers()) {
    SCOPED_TRACE(solver.name);
    Context context;
    std::thread user([&context] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      context.cancel();
    });
    // As often as it takes: who is fast may end before.
    const auto solve = [&] {
      while (true) static_cast<void>(solver.solve(hardProgram(), context));
    };
    EXPECT_EQ(codeOf(solve), ErrorCode::Cancelled);
    user.join();
  }
}

TEST(IntegerProgram, HardOnesEnd) {
  HEXHEX_LARGE_TEST();
  for (const IntegerSolver& solver : solvers()) {
    SCOPED_TRACE(solver.name);
    const IntegerProgram program = hardProgram();
    const std::vector<std::int64_t> integers = solver.solve(program, Context());
    EXPECT_EQ(integers, solver.solve(program, Context()));
    EXPECT_TRUE(integers.empty() || costOf(program, integers) < INFINITY);
  }
}

TEST(IntegerProgram, LibrariesComeFirst) {
  EXPECT_STREQ(integerSolver().name, solvers().front().name);
  EXPECT_STREQ(roundingSolver().name, "rounding");
}

}  // namespace
}  // namespace hexhex::test
