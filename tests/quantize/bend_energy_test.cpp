// The energy of bent maps: its derivatives.
#include "quantize/bend_energy.hpp"

#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <hexhex/samples.hpp>

#include "quantize/bend_problems.hpp"

namespace hexhex::test {

namespace {

using Name = BendEnergyKind::Name;

/// A small map with many transitions, and random unknowns of it.
struct EnergyTest : testing::Test {
  EnergyTest() {
    SampleOptions options;
    options.cells = 2;
    options.refine = 1;
    options.charts = ChartStyle::Random;
    const TetMap map = oriented(generateSample(SampleKind::Tetrahedron, options).map);
    problem = problemFrom(map, map);
    topology.tets = problem.tets;
    topology.pointCount = problem.points.size();
    EXPECT_TRUE(matchFaces(topology, stage));
    addStars(topology, stage);
    unknowns = findUnknowns(problem, topology, stage);
    EXPECT_TRUE(unknowns.contradictions.empty());
  }

  Vector randomUnknowns(const BendEnergy& energy) {
    Vector x(energy.unknownCount());
    for (double& value : x) value = std::uniform_real_distribution(-2.0, 4.0)(random);
    return x;
  }

  Context context;
  Stage stage{context, "test"};
  BendProblem problem;
  TetTopology topology;
  VertexUnknowns unknowns;
  std::mt19937_64 random{1};
};

TEST_F(EnergyTest, HasTheGradientOfItsDifferences) {
  const BendEnergy energy(topology, problem.reference, unknowns);
  ASSERT_GT(energy.unknownCount(), 10);
  for (const BendEnergyKind kind :
       {BendEnergyKind{Name::Dirichlet, 0}, BendEnergyKind{Name::FoldoverFree, 1},
        BendEnergyKind{Name::FoldoverFree, 0.3}}) {
    const Vector x = randomUnknowns(energy);
    Vector gradient;
    SparseMatrix hessian = energy.emptyHessian();
    energy.derivatives(kind, x, gradient, hessian);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      Vector more = x;
      Vector less = x;
      more[i] += 1e-5;
      less[i] -= 1e-5;
      const double difference =
          (energy.value(kind, more, stage) - energy.value(kind, less, stage)) / 2e-5;
      EXPECT_NEAR(gradient[i], difference, 1e-5 * (1 + gradient.norm()));
    }
  }
}

TEST_F(EnergyTest, HasTheHessianOfTheDirichletEnergy) {
  const BendEnergy energy(topology, problem.reference, unknowns);
  const BendEnergyKind kind{Name::Dirichlet, 0};
  const Vector x = randomUnknowns(energy);
  const Vector step = randomUnknowns(energy);
  Vector before;
  Vector after;
  SparseMatrix hessian = energy.emptyHessian();
  energy.derivatives(kind, x, before, hessian);
  energy.derivatives(kind, x + step, after, hessian);
  const Vector change = hessian.selfadjointView<Eigen::Lower>() * step;
  EXPECT_LT((after - before - change).norm(), 1e-9 * change.norm());
}

TEST_F(EnergyTest, HasAPositiveHessianEvenWhereTetsAreFlipped) {
  const BendEnergy energy(topology, problem.reference, unknowns);
  for (const double epsilon : {1.0, 0.1, 0.01}) {
    const Vector x = randomUnknowns(energy);
    EXPECT_GT(energy.folding(x, stage).flippedTets, 0U);
    Vector gradient;
    SparseMatrix hessian = energy.emptyHessian();
    energy.derivatives({Name::FoldoverFree, epsilon}, x, gradient, hessian);
    const Eigen::MatrixXd dense = Eigen::MatrixXd(hessian).selfadjointView<Eigen::Lower>();
    const Vector values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues();
    EXPECT_GT(values.minCoeff(), -1e-12 * values.maxCoeff());
    EXPECT_GT(values.minCoeff(), 0);
  }
}

TEST_F(EnergyTest, IsInfiniteAtFlippedTetsWithoutRegularization) {
  const BendEnergy energy(topology, problem.reference, unknowns);
  EXPECT_TRUE(std::isinf(energy.value({Name::FoldoverFree, 0}, randomUnknowns(energy), stage)));
  EXPECT_GT(regularized(0.1, -1), 0);
  EXPECT_LT(regularized(0.1, -1), regularized(0.1, 0));
  EXPECT_DOUBLE_EQ(regularized(0, 2), 2);
}

}  // namespace

}  // namespace hexhex::test
