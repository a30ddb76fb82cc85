#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include <Eigen/Dense>
#include <quantize/seamless/integer_form.hpp>

#include <hexhex/error.hpp>

#include <base/sorted.hpp>
#include <lattice/wide_int.hpp>

namespace hexhex::quantization {

namespace {

/// Maximum number of entries of the matrix of nearest(): one gigabyte.
constexpr std::size_t kMostEntries = std::size_t{1} << 27;

/// Limits of coefficients and values, to detect overflow; values of real maps are far below.
constexpr std::int64_t kLargestCoefficient = std::int64_t{1} << 40;
constexpr std::int64_t kLargestValue = std::int64_t{1} << 60;
/// Limit of the divisors that a preference may introduce: in symmetric objects, planes that return
/// after several turns produce fractions down to eighths. Smaller ones, from chains of these, would
/// need a finer lattice.
constexpr std::int64_t kLargestDivisor = 8;

[[noreturn]] void failForSize() {
  throw Error(
      ErrorCode::TooLarge,
      "The conditions that keep the map's charts, planes and singular curves together have "
      "too large coefficients: it is not seamless, or only in a way that cannot be computed "
      "with.");
}

/// sum + a * b
std::int64_t plusProduct(std::int64_t sum, std::int64_t a, std::int64_t b) {
  const lattice::Int128 result = sum + static_cast<lattice::Int128>(a) * b;
  if (result > kLargestCoefficient || result < -kLargestCoefficient) failForSize();
  return static_cast<std::int64_t>(result);
}

}  // namespace

std::int64_t IntegerForm::coefficient(Index variable) const noexcept {
  const auto at = std::lower_bound(terms_.begin(), terms_.end(), variable,
                                   [](const Term& term, Index v) { return term.first < v; });
  return at != terms_.end() && at->first == variable ? at->second : 0;
}

void IntegerForm::add(const IntegerForm& other, std::int64_t factor) {
  std::vector<Term> sum;
  sum.reserve(terms_.size() + other.terms_.size());
  auto a = terms_.begin();
  auto b = other.terms_.begin();
  while (a != terms_.end() || b != other.terms_.end()) {
    if (b == other.terms_.end() || (a != terms_.end() && a->first < b->first)) {
      sum.push_back(*a++);
    } else if (a == terms_.end() || b->first < a->first) {
      sum.emplace_back(b->first, plusProduct(0, factor, b->second));
      ++b;
    } else {
      sum.emplace_back(a->first, plusProduct(a->second, factor, b->second));
      ++a;
      ++b;
    }
    if (sum.back().second == 0) sum.pop_back();
  }
  terms_ = std::move(sum);
}

void IntegerForm::multiply(std::int64_t factor) {
  if (factor == 0) terms_.clear();
  for (Term& term : terms_) term.second = plusProduct(0, term.second, factor);
}

void IntegerForm::divide(std::int64_t divisor) {
  for (Term& term : terms_) term.second /= divisor;
}

std::int64_t IntegerForm::operator()(std::span<const std::int64_t> values) const {
  lattice::Int128 sum = 0;
  for (const auto& [variable, factor] : terms_) {
    sum += static_cast<lattice::Int128>(factor) * values[variable];
  }
  if (sum > kLargestValue || sum < -kLargestValue) failForSize();
  return static_cast<std::int64_t>(sum);
}

std::int64_t IntegerForm::commonDivisor(std::int64_t with) const noexcept {
  std::int64_t divisor = std::abs(with);
  for (const Term& term : terms_) divisor = std::gcd(divisor, term.second);
  return divisor;
}

IntegerSystem::IntegerSystem(std::size_t variableCount, std::vector<IntegerForm> equations,
                             std::vector<IntegerForm> preferences)
    : variableCount_(variableCount), solvedBy_(variableCount, kNone) {
  addEquations(std::move(equations), std::numeric_limits<std::int64_t>::max());
  addEquations(std::move(preferences), kLargestDivisor);
  for (Index v = 0; v < variableCount; ++v) {
    if (solvedBy_[v] == kNone) free_.push_back(v);
  }
}

void IntegerSystem::addEquations(std::vector<IntegerForm> equations, std::int64_t largestPivot) {
  // Normalizes and removes duplicates, as many vertices give the same equation.
  for (IntegerForm& form : equations) {
    if (form.isZero()) continue;
    const std::int64_t divisor = form.commonDivisor();
    form.divide(form.terms().front().second < 0 ? -divisor : divisor);
  }
  sortUnique(equations);
  for (IntegerForm& form : equations) addEquation(std::move(form), largestPivot);
}

/// The first solved equation, in order, whose variable occurs in a form, or kNone.
Index IntegerSystem::firstSolvedIn(const IntegerForm& form) const noexcept {
  Index first = kNone;
  for (const auto& [variable, factor] : form.terms()) first = std::min(first, solvedBy_[variable]);
  return first;
}

void IntegerSystem::addEquation(IntegerForm form, std::int64_t largestPivot) {
  // Substitutes earlier solutions in their order, as each introduces variables solved later.
  for (Index place = firstSolvedIn(form); place != kNone; place = firstSolvedIn(form)) {
    const Solved& solved = solved_[place];
    const std::int64_t factor = form.coefficient(solved.variable);
    form.add({solved.variable, 1}, -factor);
    form.multiply(solved.coefficient);
    form.add(solved.rest, -factor);
    form.divide(std::max<std::int64_t>(form.commonDivisor(), 1));
  }
  if (form.isZero()) return;
  // A pivot of one keeps everything integer; others are rare.
  const auto pivot = std::min_element(
      form.terms().begin(), form.terms().end(),
      [](const auto& a, const auto& b) { return std::abs(a.second) < std::abs(b.second); });
  if (std::abs(pivot->second) > largestPivot) return;
  Solved solved{pivot->first, pivot->second, form};
  solved.rest.add({solved.variable, 1}, -solved.coefficient);
  solvedBy_[solved.variable] = static_cast<Index>(solved_.size());
  solved_.push_back(std::move(solved));
}

std::vector<double> IntegerSystem::nearest(const std::vector<double>& wanted) const {
  // Each variable as a combination of the free ones.
  if (variableCount_ * free_.size() > kMostEntries) {
    throw Error(ErrorCode::TooLarge,
                "The map's charts differ in too many ways (" + std::to_string(variableCount_) +
                    " shared unknowns, of which " + std::to_string(free_.size()) +
                    " are free): it is far from seamless, or too large to be made so.");
  }
  const auto n = static_cast<Eigen::Index>(variableCount_);
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(free_.size()));
  for (std::size_t k = 0; k < free_.size(); ++k) basis(free_[k], static_cast<Eigen::Index>(k)) = 1;
  for (std::size_t i = solved_.size(); i > 0;) {
    --i;
    const Solved& solved = solved_[i];
    for (const auto& [variable, factor] : solved.rest.terms()) {
      basis.row(solved.variable) -= static_cast<double>(factor) /
                                    static_cast<double>(solved.coefficient) * basis.row(variable);
    }
  }
  const Eigen::Map<const Eigen::VectorXd> target(wanted.data(), n);
  const Eigen::VectorXd free = (basis.transpose() * basis).ldlt().solve(basis.transpose() * target);
  const Eigen::VectorXd solution = basis * free;
  return {solution.data(), solution.data() + n};
}

std::vector<std::vector<std::pair<Index, double>>> IntegerSystem::combinations() const {
  std::vector<std::vector<std::pair<Index, double>>> all(variableCount_);
  for (const Index v : free_) all[v] = {{v, 1.0}};
  for (std::size_t i = solved_.size(); i > 0;) {
    --i;
    const Solved& solved = solved_[i];
    std::map<Index, double> sum;
    for (const auto& [variable, factor] : solved.rest.terms()) {
      const double share = -static_cast<double>(factor) / static_cast<double>(solved.coefficient);
      for (const auto& [free, of] : all[variable]) sum[free] += share * of;
    }
    std::erase_if(sum, [](const auto& term) { return term.second == 0; });
    all[solved.variable].assign(sum.begin(), sum.end());
  }
  return all;
}

std::vector<std::int64_t> IntegerSystem::roundedTo(const std::vector<double>& solution,
                                                   std::int64_t step) const {
  std::vector<std::int64_t> values(variableCount_);
  for (const Index v : free_) {
    values[v] = std::llround(solution[v] / static_cast<double>(step)) * step;
  }
  for (std::size_t i = solved_.size(); i > 0;) {
    --i;
    const Solved& solved = solved_[i];
    const auto rest = solved.rest(values);
    if (rest % solved.coefficient != 0) return {};
    values[solved.variable] = -rest / solved.coefficient;
  }
  return values;
}

}  // namespace hexhex::quantization
