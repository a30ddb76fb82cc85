#include <algorithm>
#include <cmath>

#include <Eigen/IterativeLinearSolvers>
#include <quantize/newton.hpp>

namespace hexhex {

namespace {

/// With more unknowns, factors take several times as long as conjugate gradients, and memory. With
/// fewer, their accuracy saves splits.
constexpr int kMostFactored = 8000;
constexpr int kMostSteps = 150;
/// Steps after which there are to be fewer flipped tets than ever before.
constexpr int kPatience = 25;
/// Regularization where no tet is bad any more.
constexpr double kLeastEpsilon = 1e-9;

}  // namespace

NewtonSolver::NewtonSolver(const BendEnergy& energy, Stage& stage)
    : energy_(energy), stage_(stage), hessian_(energy.emptyHessian()) {
  if (energy.unknownCount() <= kMostFactored) cholesky_.analyzePattern(hessian_);
}

/// Solves for the Newton direction. The matrix is shifted a little, as it is singular along
/// unknowns that may all move together.
Vector NewtonSolver::direction() {
  const double shift = 1e-10 * hessian_.diagonal().mean();
  for (Eigen::Index i = 0; i < hessian_.rows(); ++i) hessian_.coeffRef(i, i) += shift;
  if (energy_.unknownCount() <= kMostFactored) {
    cholesky_.factorize(hessian_);
    if (cholesky_.info() == Eigen::Success) return cholesky_.solve(-gradient_);
  }
  Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower> gradients;
  gradients.setTolerance(1e-3);
  gradients.setMaxIterations(1000);
  gradients.compute(hessian_);
  const Vector direction = gradients.solve(-gradient_);
  return direction.dot(gradient_) < 0 ? direction : Vector(-gradient_);
}

double NewtonSolver::step(BendEnergyKind kind, Vector& x) {
  stage_.context().throwIfCancelled();
  ++iterations_;
  energy_.derivatives(kind, x, gradient_, hessian_);
  const Vector towards = direction();
  const double slope = gradient_.dot(towards);
  const double before = energy_.value(kind, x, stage_);
  for (double length = 1; length > 1e-6; length *= 0.5) {
    const Vector there = x + length * towards;
    const double after = energy_.value(kind, there, stage_);
    if (after <= before + 1e-4 * length * slope) {
      x = there;
      return 1 - after / before;
    }
  }
  return 0;
}

void NewtonSolver::start(Vector& x) {
  if (x.size() > 0) step({BendEnergyKind::Name::Dirichlet, 0}, x);
}

bool NewtonSolver::untangle(Vector& x, double epsilon) {
  Folding folding = energy_.folding(x, stage_);
  Index fewest = folding.flippedTets;
  Vector best = x;
  int idle = 0;
  for (int i = 0; i < kMostSteps && idle < kPatience && fewest > 0 && x.size() > 0; ++i) {
    const double decrease = step({BendEnergyKind::Name::FoldoverFree, epsilon}, x);
    folding = energy_.folding(x, stage_);
    idle = folding.flippedTets < fewest ? 0 : idle + 1;
    if (folding.flippedTets <= fewest) best = x;
    fewest = std::min(fewest, folding.flippedTets);
    // The penalty grows as fast as the energy can follow (their Section 3, Theorem 1), and at least
    // as much as one step of Newton's method makes up for.
    const double least = folding.leastDeterminant;
    const double aim = (1 - std::max(decrease, 0.5)) * regularized(epsilon, least);
    epsilon = std::max(kLeastEpsilon, 2 * std::sqrt(std::max(0.0, aim * (aim - least))));
  }
  x = best;
  return fewest == 0;
}

void NewtonSolver::polish(Vector& x, int steps) {
  constexpr double kLeastDecrease = 1e-3;
  if (x.size() == 0) return;
  for (int i = 0; i < steps; ++i) {
    if (step({BendEnergyKind::Name::FoldoverFree, 0}, x) < kLeastDecrease) break;
  }
}

}  // namespace hexhex
