#include <utility>
#include <vector>

#include <untangle/lbfgs.hpp>

namespace hexhex::untangle {

namespace {

constexpr std::size_t kPairs = 12;
/// Of the decrease that the slope promises.
constexpr double kSufficient = 1e-4;
constexpr double kShortest = 1e-8;
/// Pairs along which the energy is not convex by this share say nothing.
constexpr double kConvex = 1e-12;

}  // namespace

Lbfgs::Lbfgs(Energy& energy, const Multigrid& metric, const Vector& x, double epsilon)
    : energy_(energy), metric_(metric), epsilon_(epsilon) {
  height_ = energy_.at(x, epsilon_, gradient_);
}

Vector Lbfgs::direction() const {
  Vector d = -gradient_;
  std::vector<double> shares(pairs_.size());
  for (std::size_t i = pairs_.size(); i > 0;) {
    --i;
    shares[i] = pairs_[i].move.dot(d) / pairs_[i].product;
    d -= shares[i] * pairs_[i].change;
  }
  d = scale_ * metric_.cycle(d);
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

/// Halves the step until the energy falls as it should (Armijo 1966).
bool Lbfgs::search(const Vector& towards, Vector& x) {
  const double slope = gradient_.dot(towards);
  if (!(slope < 0)) return false;
  Vector gradient;
  for (double length = 1; length > kShortest; length *= 0.5) {
    const Vector there = x + length * towards;
    const Height height = energy_.at(there, epsilon_, gradient);
    if (!(height.energy <= height_.energy + kSufficient * length * slope)) continue;
    learn({there - x, gradient - gradient_});
    height_ = height;
    gradient_.swap(gradient);
    x = there;
    return true;
  }
  return false;
}

void Lbfgs::learn(Pair pair) {
  pair.product = pair.move.dot(pair.change);
  if (!(pair.product > kConvex * pair.move.norm() * pair.change.norm())) return;
  scale_ = pair.product / pair.change.dot(metric_.cycle(pair.change));
  if (pairs_.size() == kPairs) pairs_.pop_front();
  pairs_.push_back(std::move(pair));
}

}  // namespace hexhex::untangle
