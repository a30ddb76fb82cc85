// What the solver is made of: derivatives of the energy, the Laplacian, multigrid.
#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <untangle/energy_lanes.hpp>
#include <untangle/foldover_energy.hpp>
#include <untangle/laplacian.hpp>
#include <untangle/multigrid.hpp>

#include <hexhex/hexhex.hpp>

#include "untangle/grid_problem.hpp"

namespace hexhex::test {

using untangle::Corner;
using untangle::Element;
using untangle::Energy;
using untangle::Multigrid;
using untangle::Problem;
using untangle::Vector;

namespace {

struct UntangleParts : ::testing::Test {
  Context context{1};
  Stage stage{context, "test"};
  std::mt19937_64 random{1};

  double draw() { return std::uniform_real_distribution(-2.0, 2.0)(random); }
  Vec3 drawVector() { return {draw(), draw(), draw()}; }
  Vector drawVector(Eigen::Index size) {
    Vector v(size);
    for (double& value : v) value = draw();
    return v;
  }

  /// Elements of all kinds: with signs, constants, offsets and targets, and with unknowns that are
  /// several coordinates, also of one corner.
  Problem randomProblem() {
    Problem problem;
    problem.pull = 0.7;
    problem.x.resize(9);
    for (double& x : problem.x) x = draw();
    for (int i = 0; i < 3; ++i)
      problem.matrices.push_back({drawVector(), drawVector(), drawVector()});
    for (int e = 0; e < 40; ++e) {
      Element element;
      for (Corner& corner : element.corners) {
        corner.constant = drawVector();
        for (std::size_t k = 0; k < 3; ++k) {
          corner.unknown[k] = static_cast<int>(random() % 12) - 3;
          corner.sign[k] = random() % 2 == 0 ? 1 : -1;
          if (corner.unknown[k] < 0) corner.unknown[k] = -1;
        }
      }
      element.gradients = {drawVector(), drawVector(), drawVector()};
      element.weight = 0.1 + std::abs(draw());
      element.offset = static_cast<int>(random() % 4) - 1;
      element.target = static_cast<int>(random() % 4) - 1;
      problem.elements.push_back(element);
    }
    return problem;
  }
};

TEST_F(UntangleParts, GradientIsThatOfDifferences) {
  const Problem problem = randomProblem();
  Energy energy(problem, stage);
  const Vector x = Eigen::Map<const Vector>(problem.x.data(), std::ssize(problem.x));
  for (const double epsilon : {1.0, 0.3}) {
    Vector gradient;
    const untangle::Height height = energy.at(x, epsilon, gradient);
    EXPECT_EQ(height.energy, energy.at(x, epsilon).energy);
    EXPECT_GT(height.flipped, 0U);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      Vector more = x;
      Vector less = x;
      more[i] += 1e-6;
      less[i] -= 1e-6;
      const double difference =
          (energy.at(more, epsilon).energy - energy.at(less, epsilon).energy) / 2e-6;
      EXPECT_NEAR(gradient[i], difference, 1e-6 * gradient.norm());
    }
  }
}

TEST_F(UntangleParts, EnergyIsThatOfItsDefinition) {
  Problem problem = randomProblem();
  const Vector x = Eigen::Map<const Vector>(problem.x.data(), std::ssize(problem.x));
  for (; !problem.elements.empty(); problem.elements.pop_back()) {  // whole lanes, and others
    for (const double epsilon : {1.0, 1e-3, 1e-9}) {
      double sum = 0;
      for (const Element& element : problem.elements) {
        const Eigen::Matrix3d j = untangle::jacobian(problem, element, x.data());
        const double det = j.determinant();
        const double chi = untangle::regularized(epsilon, det);
        const double pull = 0.5 * problem.pull * (j - targetOf(problem, element)).squaredNorm();
        sum += element.weight *
               (j.squaredNorm() / std::cbrt(chi * chi) + (det * det + 1) / chi + pull);
      }
      EXPECT_NEAR(Energy(problem, stage).at(x, epsilon).energy, sum, 1e-12 * sum);
    }
  }
}

TEST_F(UntangleParts, EnergiesAreTheSameInAllRegisters) {
  const auto fill = [this](auto& rows) {
    for (auto& row : rows) {
      for (untangle::Number& number : row) {
        for (std::size_t lane = 0; lane < untangle::kLanes; ++lane) number[lane] = draw();
      }
    }
  };
  for (int i = 0; i < 1000; ++i) {
    untangle::ElementLanes elements;
    fill(elements.corners);
    fill(elements.gradients);
    fill(elements.offset);
    fill(elements.target);
    for (std::size_t lane = 0; lane < untangle::kLanes; ++lane) elements.weight[lane] = 1 + draw();
    const double epsilon = i % 3 == 0 ? 1 : std::exp(-10 * std::abs(draw()));
    std::array<untangle::ForceLanes, 2> results;
    for (const untangle::EnergyKernel kernel : untangle::energyKernels()) {
      kernel(elements, epsilon, 0.3, results[1]);
      if (kernel == untangle::energyKernels().front()) results[0] = results[1];
      EXPECT_EQ(std::memcmp(&results[0], &results[1], sizeof results[0]), 0);
    }
  }
}

TEST_F(UntangleParts, EnergyIsInfiniteAtFlippedElementsWithoutRegularization) {
  const Problem problem = randomProblem();
  Energy energy(problem, stage);
  const Vector x = Eigen::Map<const Vector>(problem.x.data(), std::ssize(problem.x));
  Vector gradient;
  EXPECT_TRUE(std::isinf(energy.at(x, 0).energy));
  EXPECT_TRUE(std::isinf(energy.at(x, 0, gradient).energy));
  EXPECT_DOUBLE_EQ(untangle::regularized(0, 2), 2);
}

/// chi(det) and chi(-det) differ by det, and their product is epsilon^2 / 4.
TEST_F(UntangleParts, RegularizedDeterminantsAreTheRootsOfTheirEquation) {
  for (const double epsilon : {1.0, 1e-3, 1e-7}) {
    for (const double det : {0.0, 1e-5, 1.0, 1e3}) {
      const double above = untangle::regularized(epsilon, det);
      const double below = untangle::regularized(epsilon, -det);
      EXPECT_NEAR(above - below, det, 1e-15 * (epsilon + det));
      EXPECT_NEAR(4 * above * below / (epsilon * epsilon), 1, 1e-14);
    }
  }
}

/// The energy without all but its pull is quadratic: weight / 2 |J - target|^2.
TEST_F(UntangleParts, LaplacianAndForcesAreThoseOfTheDistanceToTargets) {
  const Problem problem = randomProblem();
  const untangle::Uses uses(problem);
  const Vector x = drawVector(std::ssize(problem.x));
  const auto distance = [&](const Vector& at) {
    double sum = 0;
    for (const Element& element : problem.elements) {
      sum += 0.5 * element.weight *
             (untangle::jacobian(problem, element, at.data()) - targetOf(problem, element))
                 .squaredNorm();
    }
    return sum;
  };
  const Vector slope = laplacian(problem, uses) * x - targetForces(problem, uses);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Vector more = x;
    Vector less = x;
    more[i] += 1e-4;
    less[i] -= 1e-4;
    EXPECT_NEAR(slope[i], (distance(more) - distance(less)) / 2e-4, 1e-6 * slope.norm());
  }
}

/// The Laplacian of a box, with unknowns of either sign as charts have them.
TEST_F(UntangleParts, MultigridIsNearTheInverse) {
  auto [problem, best] = gridProblem(14, Boundary::Sliding);
  std::vector<std::int8_t> signs(best.size());
  for (std::int8_t& sign : signs) sign = random() % 2 == 0 ? 1 : -1;
  for (Element& element : problem.elements) {
    for (Corner& corner : element.corners) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (corner.unknown[k] >= 0)
          corner.sign[k] = signs[static_cast<std::size_t>(corner.unknown[k])];
      }
    }
  }
  const auto matrix = laplacian(problem, untangle::Uses(problem));
  const Multigrid exact(matrix, matrix.rows(), context);
  const Multigrid levels(matrix, 300, context);
  const Vector v = drawVector(matrix.rows());
  const Vector w = drawVector(matrix.rows());
  EXPECT_LT((matrix * exact.cycle(v) - v).norm(), 1e-9 * v.norm());
  EXPECT_LT((levels.solve(v) - exact.solve(v)).norm(), 1e-4 * exact.solve(v).norm());
  const Multigrid sweep(matrix);
  EXPECT_LT((sweep.solve(v) - exact.solve(v)).norm(), 1e-4 * exact.solve(v).norm());
  // Symmetric and positive definite.
  for (const Multigrid* metric : {&levels, &sweep}) {
    EXPECT_NEAR(v.dot(metric->cycle(w)), w.dot(metric->cycle(v)),
                1e-9 * std::abs(v.dot(metric->cycle(v))));
    EXPECT_GT(v.dot(metric->cycle(v)), 0);
  }
  // Not far from the inverse: each cycle leaves half at most.
  Vector x = Vector::Zero(v.size());
  double before = v.norm();
  for (int i = 0; i < 5; ++i) {
    x += levels.cycle(v - matrix * x);
    const double after = (v - matrix * x).norm();
    EXPECT_LT(after, before / 2);
    before = after;
  }
}

}  // namespace

}  // namespace hexhex::test
