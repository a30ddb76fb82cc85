#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/LU>
#include <untangle/laplacian.hpp>
#include <untangle/lbfgs.hpp>
#include <untangle/multigrid.hpp>
#include <untangle/untangle.hpp>

namespace hexhex::untangle {

namespace {

/// So many unknowns are solved for exactly: more of them take longer to factor than all else.
constexpr Eigen::Index kMostFactored = 4000;
constexpr int kMostRounds = 150;
/// Steps of a round. A larger penalty than the map can follow leaves it folded, so that a round
/// goes on as long as each step lowers the energy by a good share.
constexpr int kStepsOfRound = 10;
constexpr int kMostStepsOfRound = 100;
constexpr double kFastDecrease = 0.03;
struct Pace {
  /// Rounds after which there are to be fewer flipped elements than ever before.
  int patience;
  /// The penalty grows at least as if the energy had fallen by this share.
  double leastFollowed;
};
constexpr Pace kQuick = {8, 0.5};
constexpr Pace kPatient = {16, 0.2};
/// A step that lowers the energy by a smaller share ends its round.
constexpr double kLeastDecrease = 1e-6;
/// Regularization where hardly any element is bad.
constexpr double kLeastEpsilon = 1e-9;
/// Polishing ends when so many steps lower the energy by less than this share.
constexpr int kPolishingSteps = 6;
constexpr double kLeastPolish = 1e-4;

/// The penalty grows as fast as the energy could follow (their Section 3, Theorem 1).
double nextEpsilon(double epsilon, double followed, double leastDeterminant) {
  const double aim = (1 - followed) * regularized(epsilon, leastDeterminant);
  const double square = aim * (aim - leastDeterminant);
  return std::max(kLeastEpsilon, 2 * std::sqrt(std::max(0.0, square)));
}

}  // namespace

struct Solver::Parts {
  Parts(Problem& theProblem, Stage& theStage)
      : problem(theProblem),
        stage(theStage),
        energy(theProblem, theStage),
        metric(laplacian(theProblem, energy.uses()), kMostFactored, theStage.context()) {}

  /// Untangles x. Ends at the best place that was seen.
  End untangle(double epsilon, const Pace& pace, Vector& x, int& steps) {
    std::size_t fewest = energy.at(x, epsilon).flipped;
    Vector best = x;
    int idle = 0;
    int rounds = 0;
    for (; fewest > 0 && idle < pace.patience && rounds < kMostRounds; ++rounds) {
      Lbfgs descent(energy, metric, x, epsilon);
      const double before = descent.height().energy;
      steps += descendRound(descent, x);
      const Height& now = descent.height();
      idle = now.flipped < fewest ? 0 : idle + 1;
      if (now.flipped <= fewest) best = x;
      fewest = std::min(fewest, now.flipped);
      const double followed = std::max(1 - now.energy / before, pace.leastFollowed);
      epsilon = nextEpsilon(epsilon, followed, now.leastDeterminant);
    }
    x = best;
    if (fewest == 0) return End::Positive;
    return rounds == kMostRounds ? End::OutOfSteps : End::Stalled;
  }

  /// @return steps
  int descendRound(Lbfgs& descent, Vector& x) const {
    for (int step = 1; step <= kMostStepsOfRound; ++step) {
      stage.context().throwIfCancelled();
      const double before = descent.height().energy;
      if (!descent.step(x)) return step;
      const Height& now = descent.height();
      const double least = step < kStepsOfRound ? kLeastDecrease : kFastDecrease;
      if (now.flipped == 0 || before - now.energy < least * before) return step;
    }
    return kMostStepsOfRound;
  }

  /// @return steps
  int polish(int most, Vector& x) {
    Lbfgs descent(energy, metric, x, 0);
    double before = descent.height().energy;
    for (int step = 1; step <= most; ++step) {
      stage.context().throwIfCancelled();
      if (!descent.step(x)) return step;
      if (step % kPolishingSteps != 0) continue;
      if (before - descent.height().energy < kLeastPolish * before) return step;
      before = descent.height().energy;
    }
    return most;
  }

  Problem& problem;
  Stage& stage;
  Energy energy;
  Multigrid metric;
};

Solver::Solver(Problem& problem, Stage& stage) : parts_(std::make_unique<Parts>(problem, stage)) {}

Solver::~Solver() = default;

void Solver::start() {
  Problem& problem = parts_->problem;
  const Vector x = parts_->metric.solve(targetForces(problem, parts_->energy.uses()));
  problem.x.assign(x.begin(), x.end());
}

Result Solver::run(const Options& options) {
  Problem& problem = parts_->problem;
  Vector x = Eigen::Map<const Vector>(problem.x.data(), std::ssize(problem.x));
  Result result;
  result.end =
      parts_->untangle(options.epsilon, options.isPatient ? kPatient : kQuick, x, result.steps);
  if (result.end == End::Positive) result.steps += parts_->polish(options.polishing, x);
  problem.x.assign(x.begin(), x.end());
  const Height height = parts_->energy.at(x, 0);
  const Vector coordinates = coordinatesOf(problem, x);
  result.energy = height.energy;
  result.leastDeterminant = height.leastDeterminant;
  for (std::size_t i = 0; height.flipped > 0 && i < problem.elements.size(); ++i) {
    const double det = jacobian(problem, problem.elements[i], coordinates.data()).determinant();
    if (!(det > 0)) result.flipped.push_back(i);
  }
  return result;
}

std::vector<std::size_t> flatElements(const Problem& problem) {
  // Random unknowns that make a polynomial of degree three vanish by chance are rare; twice is
  // rarer.
  constexpr int kDraws = 2;
  // Far above rounding, far below the flattest tets of real maps.
  constexpr double kFlat = 1e-13;
  std::mt19937_64 random(1);
  std::vector<char> isFlat(problem.elements.size(), 1);
  Vector x(std::ssize(problem.x));
  for (int draw = 0; draw < kDraws; ++draw) {
    for (double& value : x) value = static_cast<double>(random() >> 11) * 0x1p-43;  // below 1024
    const Vector coordinates = coordinatesOf(problem, x);
    for (std::size_t i = 0; i < isFlat.size(); ++i) {
      const Eigen::Matrix3d j = jacobian(problem, problem.elements[i], coordinates.data());
      const double most = j.col(0).norm() * j.col(1).norm() * j.col(2).norm();
      if (std::abs(j.determinant()) > kFlat * most) isFlat[i] = 0;
    }
  }
  std::vector<std::size_t> flat;
  for (std::size_t i = 0; i < isFlat.size(); ++i) {
    if (isFlat[i] != 0) flat.push_back(i);
  }
  return flat;
}

}  // namespace hexhex::untangle
