#include <algorithm>
#include <cassert>
#include <cmath>
#include <deque>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <untangle/foldover_energy.hpp>
#include <untangle/laplacian.hpp>
#include <untangle/multigrid.hpp>
#include <untangle/untangle.hpp>

namespace hexhex::untangle {

/// Limited-memory BFGS (Nocedal 1980) with a given initial metric.
class Lbfgs {
 public:
  /// @param energy, metric  must outlive this
  /// @param x  starting point
  /// @param epsilon  of the energy
  Lbfgs(Energy& energy, const Multigrid& metric, const Vector& x, double epsilon);

  /// One step downhill.
  /// @param[in,out] x  where the last step ended
  /// @return false if no step lowers the energy
  bool step(Vector& x);

  /// At the current x.
  [[nodiscard]] const Height& height() const noexcept { return height_; }

 private:
  struct Pair {
    Vector move;
    Vector change;       ///< of the gradient
    Vector steepest;     ///< the change in the metric
    double product = 0;  ///< of move and change
  };
  [[nodiscard]] Vector direction() const;
  bool search(const Vector& towards, Vector& x);
  void learn(Vector move, Vector change, Vector steepest);

  Energy& energy_;
  const Multigrid& metric_;
  double epsilon_;
  Height height_;
  Vector gradient_;
  Vector steepest_;         ///< the gradient in the metric
  double scale_ = 1;        ///< of the metric
  std::deque<Pair> pairs_;  ///< most recent last
};

namespace {

constexpr std::size_t kPairs = 12;
/// Required fraction of the decrease that the slope predicts.
constexpr double kSufficient = 1e-4;
constexpr double kShortest = 1e-8;
/// Pairs whose move and gradient change have a smaller cosine are ignored.
constexpr double kConvex = 1e-12;

}  // namespace

Lbfgs::Lbfgs(Energy& energy, const Multigrid& metric, const Vector& x, double epsilon)
    : energy_(energy), metric_(metric), epsilon_(epsilon) {
  height_ = energy_.at(x, epsilon_, gradient_);
  steepest_ = metric_.cycle(gradient_);
}

/// The metric is linear: applied to each gradient once, it is known for all their sums.
Vector Lbfgs::direction() const {
  Vector rest = -gradient_;
  Vector d = -steepest_;
  std::vector<double> shares(pairs_.size());
  for (std::size_t i = pairs_.size(); i > 0;) {
    --i;
    shares[i] = pairs_[i].move.dot(rest) / pairs_[i].product;
    rest -= shares[i] * pairs_[i].change;
    d -= shares[i] * pairs_[i].steepest;
  }
  d *= scale_;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    d += (shares[i] - pairs_[i].change.dot(d) / pairs_[i].product) * pairs_[i].move;
  }
  return d;
}

bool Lbfgs::step(Vector& x) {
  if (search(direction(), x)) return true;
  if (pairs_.empty()) return false;
  pairs_.clear();
  return search(direction(), x);
}

/// Halves the step until the energy decreases sufficiently (Armijo 1966).
bool Lbfgs::search(const Vector& towards, Vector& x) {
  assert(towards.size() == x.size());
  const double slope = gradient_.dot(towards);
  if (!(slope < 0)) return false;
  Vector gradient;
  for (double length = 1; length > kShortest; length *= 0.5) {
    const Vector there = x + length * towards;
    const Height height = energy_.at(there, epsilon_, gradient);
    if (!(height.energy <= height_.energy + kSufficient * length * slope)) continue;
    Vector steepest = metric_.cycle(gradient);
    learn(there - x, gradient - gradient_, steepest - steepest_);
    height_ = height;
    gradient_.swap(gradient);
    steepest_.swap(steepest);
    x = there;
    return true;
  }
  return false;
}

void Lbfgs::learn(Vector move, Vector change, Vector steepest) {
  const double product = move.dot(change);
  if (!(product > kConvex * move.norm() * change.norm())) return;
  scale_ = product / change.dot(steepest);
  if (pairs_.size() == kPairs) pairs_.pop_front();
  pairs_.push_back({std::move(move), std::move(change), std::move(steepest), product});
}

namespace {

/// Maximum number of unknowns for which the Laplacian is factored: beyond, factoring takes longer
/// than everything else.
constexpr Eigen::Index kMostFactored = 4000;
constexpr int kMostRounds = 150;
/// Number of steps per round. If the penalty grew faster than the map can follow, folds would
/// persist, so a round continues while each step lowers the energy by at least kFastDecrease.
constexpr int kStepsOfRound = 10;
constexpr int kMostStepsOfRound = 100;
constexpr double kFastDecrease = 0.03;
struct Pace {
  /// Number of rounds over which the rate of vanishing flips is measured.
  int patience;
  /// The penalty grows at least as if the energy had decreased by this fraction.
  double leastFollowed;
};
constexpr Pace kQuick = {8, 0.5};
constexpr Pace kPatient = {16, 0.2};
/// A step that lowers the energy by a smaller fraction ends its round.
constexpr double kLeastDecrease = 1e-6;
/// Lower bound of the regularization.
constexpr double kLeastEpsilon = 1e-9;
/// Polishing ends when this many steps lower the energy by less than this fraction.
constexpr int kPolishingSteps = 6;
constexpr double kLeastPolish = 1e-4;

/// The penalty grows as fast as the energy was able to follow (Garanzha et al. 2021, Section 3,
/// Theorem 1).
double nextEpsilon(double epsilon, double followed, double leastDeterminant) {
  const double aim = (1 - followed) * regularized(epsilon, leastDeterminant);
  const double square = aim * (aim - leastDeterminant);
  return std::max(kLeastEpsilon, 2 * std::sqrt(std::max(0.0, square)));
}

/// Whether flips vanish so slowly, or not at all, that some would be left after all rounds.
/// @param fewest  smallest number of flips up to each round
bool isTooSlow(const std::vector<std::size_t>& fewest, int patience) {
  const int rounds = static_cast<int>(fewest.size());
  if (rounds <= patience) return false;
  const auto now = static_cast<double>(fewest.back());
  const auto before = static_cast<double>(fewest[static_cast<std::size_t>(rounds - 1 - patience)]);
  return now * std::pow(now / before, (kMostRounds - rounds) / patience) >= 1;
}

}  // namespace

struct Solver::Parts {
  Parts(Problem& theProblem, Stage& theStage, Inverse inverse)
      : problem(theProblem),
        stage(theStage),
        energy(theProblem, theStage),
        metric(metricOf(theProblem, energy.uses(), inverse, theStage.context())) {}

  static Multigrid metricOf(const Problem& problem, const Uses& uses, Inverse inverse,
                            const Context& context) {
    if (inverse == Inverse::GaussSeidel) return Multigrid(laplacian(problem, uses));
    return {laplacian(problem, uses), kMostFactored, context};
  }

  /// Untangles x. Ends at the best point seen.
  End untangle(const Options& options, Vector& x, int& steps) {
    const Pace& pace = options.isPatient ? kPatient : kQuick;
    double epsilon = options.epsilon;
    std::size_t fewest = energy.at(x, epsilon).flipped;
    Vector best = x;
    std::vector<std::size_t> history = {fewest};
    while (fewest > 0 && steps < options.mostSteps && !isTooSlow(history, pace.patience)) {
      Lbfgs descent(energy, metric, x, epsilon);
      const double before = descent.height().energy;
      steps += descendRound(descent, x);
      const Height& now = descent.height();
      if (now.flipped <= fewest) best = x;
      fewest = std::min(fewest, now.flipped);
      history.push_back(fewest);
      const double followed = std::max(1 - now.energy / before, pace.leastFollowed);
      epsilon = nextEpsilon(epsilon, followed, now.leastDeterminant);
    }
    x = best;
    return fewest == 0 ? End::Positive : End::Stalled;
  }

  /// @return number of steps
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

  /// @return number of steps
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

Solver::Solver(Problem& problem, Stage& stage, Inverse inverse)
    : parts_(std::make_unique<Parts>(problem, stage, inverse)) {}

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
  result.end = parts_->untangle(options, x, result.steps);
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
  // A polynomial of degree three rarely vanishes at random unknowns by chance; at two draws even
  // less.
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
