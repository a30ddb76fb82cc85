#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <base/vector3.hpp>
#include <repair/untangle.hpp>

#ifdef HEXHEX_HAS_LBFGS
#include <lbfgs.h>
#endif

namespace hexhex {

#ifdef HEXHEX_HAS_LBFGS

namespace {

/// Rounds of the quasi-Newton method, between which the penalty grows.
constexpr int kMaxRounds = 80;
constexpr int kIterations = 150;
/// Rounds after all tets became positive: they move away from the edge of what is legal.
constexpr int kPolishing = 2;
/// Regularization, when no tet is bad any more.
constexpr double kLeastEpsilon = 1e-9;

/// A positive stand-in for the determinant: near it if it is positive, near 0 if it is negative.
double regularized(double epsilon, double det) {
  const double root = std::sqrt(epsilon * epsilon + det * det);
  return det > 0 ? 0.5 * (det + root) : 0.5 * epsilon * epsilon / (root - det);
}

using Columns = std::array<Vec3, 3>;

/// Columns of the Jacobian matrix of a tet.
Columns jacobian(const UntangleTet& tet, const std::array<Vec3, 4>& u) {
  const Columns edges = {minus(u[1], u[0]), minus(u[2], u[0]), minus(u[3], u[0])};
  Columns columns{};
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      columns[j][k] = edges[0][k] * tet.inverseShape[0][j] + edges[1][k] * tet.inverseShape[1][j] +
                      edges[2][k] * tet.inverseShape[2][j];
    }
  }
  return columns;
}

std::array<Vec3, 4> cornersAt(const UntangleTet& tet, const double* x) {
  std::array<Vec3, 4> u{};
  for (std::size_t i = 0; i < 4; ++i) {
    const UntangleCorner& corner = tet.corners[i];
    u[i] = corner.constant;
    for (std::size_t k = 0; k < 3; ++k) {
      if (corner.unknown[k] >= 0) u[i][k] += corner.sign[k] * x[corner.unknown[k]];
    }
  }
  return u;
}

class Energy {
 public:
  explicit Energy(const UntangleProblem& problem) : problem_(problem) {}

  void setEpsilon(double epsilon) { epsilon_ = epsilon; }

  [[nodiscard]] double leastDeterminant(const double* x) const {
    double least = std::numeric_limits<double>::infinity();
    for (const UntangleTet& tet : problem_.tets) {
      const Columns j = jacobian(tet, cornersAt(tet, x));
      least = std::min(least, tripleProduct(j[0], j[1], j[2]));
    }
    return least;
  }

  /// @param[out] gradient  by unknown
  double evaluate(const double* x, double* gradient) const {
    std::fill_n(gradient, problem_.x.size(), 0.0);
    double energy = 0;
    for (const UntangleTet& tet : problem_.tets) energy += add(tet, x, gradient);
    return energy;
  }

 private:
  /// |J|^2 / chi^(2/3) + (det^2 + 1) / chi: angles, and volumes.
  double add(const UntangleTet& tet, const double* x, double* gradient) const {
    const Columns j = jacobian(tet, cornersAt(tet, x));
    const Columns cofactor = {cross(j[1], j[2]), cross(j[2], j[0]), cross(j[0], j[1])};
    const double det = dot(j[0], cofactor[0]);
    const double chi = regularized(epsilon_, det);
    const double slope = 0.5 * (1 + det / std::sqrt(epsilon_ * epsilon_ + det * det));
    const double power = 1 / std::cbrt(chi * chi);
    const double shape = (dot(j[0], j[0]) + dot(j[1], j[1]) + dot(j[2], j[2])) * power;
    const double volume = (det * det + 1) / chi;
    const double alongCofactor =
        -(2.0 / 3) * shape * slope / chi + (2 * det - volume * slope) / chi;
    // By the columns of J, then by corners.
    Columns byColumn{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        byColumn[c][k] = tet.weight * (2 * power * j[c][k] + alongCofactor * cofactor[c][k]);
      }
    }
    Vec3 sum{};
    for (std::size_t i = 0; i < 3; ++i) {
      Vec3 byCorner{};
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t c = 0; c < 3; ++c) byCorner[k] += byColumn[c][k] * tet.inverseShape[i][c];
      }
      sum = plus(sum, byCorner);
      collect(tet.corners[i + 1], byCorner, 1, gradient);
    }
    collect(tet.corners[0], sum, -1, gradient);
    return tet.weight * (shape + volume);
  }

  static void collect(const UntangleCorner& corner, const Vec3& byCorner, double factor,
                      double* gradient) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (corner.unknown[k] >= 0)
        gradient[corner.unknown[k]] += factor * corner.sign[k] * byCorner[k];
    }
  }

  const UntangleProblem& problem_;
  double epsilon_ = 1;
};

/// One run of the solver.
struct Descent {
  static constexpr int kPast = 8;
  const Energy& energy;
  std::array<double, kPast> past{};  ///< energies of as many iterations
};

lbfgsfloatval_t evaluate(void* instance, const lbfgsfloatval_t* x, lbfgsfloatval_t* gradient, int,
                         lbfgsfloatval_t) {
  return static_cast<const Descent*>(instance)->energy.evaluate(x, gradient);
}

/// Ends a run in which hardly anything happens any more. (The solver could do so by itself, but
/// would go on if it lacked memory for the past.)
int isSlow(void* instance, const lbfgsfloatval_t*, const lbfgsfloatval_t*, lbfgsfloatval_t energy,
           lbfgsfloatval_t, lbfgsfloatval_t, lbfgsfloatval_t, int, int iteration, int) {
  constexpr double kLeastChange = 1e-5;
  double& past =
      static_cast<Descent*>(instance)->past[static_cast<std::size_t>(iteration % Descent::kPast)];
  const double change = std::abs(past - energy);
  past = energy;
  return iteration > Descent::kPast && change < kLeastChange * std::abs(energy) ? 1 : 0;
}

/// The unknowns in memory as the solver wants it.
class Unknowns {
 public:
  explicit Unknowns(const std::vector<double>& x)
      : size_(static_cast<int>(x.size())), data_(lbfgs_malloc(size_)) {
    if (data_ == nullptr) throw std::bad_alloc();
    std::copy(x.begin(), x.end(), data_);
  }
  ~Unknowns() { lbfgs_free(data_); }
  Unknowns(const Unknowns&) = delete;
  Unknowns& operator=(const Unknowns&) = delete;
  [[nodiscard]] double* data() { return data_; }
  [[nodiscard]] int size() const { return size_; }

 private:
  int size_;
  double* data_;
};

/// One round with a fixed penalty. However the solver ends, the unknowns are no worse than before.
double minimize(Energy& energy, Unknowns& x) {
  lbfgs_parameter_t parameters;
  lbfgs_parameter_init(&parameters);
  parameters.m = 12;
  parameters.max_iterations = kIterations;
  parameters.epsilon = 1e-7;
  Descent descent{energy};
  const int end = lbfgs(x.size(), x.data(), nullptr, evaluate, isSlow, &descent, &parameters);
  if (end == LBFGSERR_OUTOFMEMORY) throw std::bad_alloc();  // all other ends are as good as any
  std::vector<double> unused(static_cast<std::size_t>(x.size()));
  return energy.evaluate(x.data(), unused.data());
}

}  // namespace

bool canUntangle() noexcept { return true; }

double untangle(UntangleProblem& problem, Stage& stage) {
  Energy energy(problem);
  if (problem.x.empty()) return energy.leastDeterminant(nullptr);
  Unknowns x(problem.x);
  double least = energy.leastDeterminant(x.data());
  double epsilon = 1;
  energy.setEpsilon(epsilon);
  std::vector<double> unused(problem.x.size());
  double before = energy.evaluate(x.data(), unused.data());
  int polished = 0;
  for (int round = 0; round < kMaxRounds && polished < kPolishing; ++round) {
    stage.context().throwIfCancelled();
    const double now = minimize(energy, x);
    least = energy.leastDeterminant(x.data());
    if (least > 0) {
      ++polished;
      epsilon = kLeastEpsilon;
    } else {
      // The penalty grows as fast as the energy could follow (their Section 3, Theorem 1).
      const double followed = std::max(1 - now / before, 0.1);
      const double aim = (1 - followed) * regularized(epsilon, least);
      epsilon = std::max(kLeastEpsilon, 2 * std::sqrt(std::max(0.0, aim * (aim - least))));
    }
    energy.setEpsilon(epsilon);
    before = energy.evaluate(x.data(), unused.data());
    if (!std::isfinite(before)) break;
  }
  std::copy_n(x.data(), problem.x.size(), problem.x.begin());
  return energy.leastDeterminant(problem.x.data());
}

#else

bool canUntangle() noexcept { return false; }

double untangle(UntangleProblem& /*problem*/, Stage& /*stage*/) {
  return -std::numeric_limits<double>::infinity();
}

#endif

}  // namespace hexhex
