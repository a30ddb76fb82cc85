// Linear forms with integer coefficients, and systems of homogeneous linear equations.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex::quantization {

/// A sum of integer multiples of variables.
class IntegerForm {
 public:
  using Term = std::pair<Index, std::int64_t>;  ///< variable and coefficient

  IntegerForm() = default;
  IntegerForm(Index variable, std::int64_t coefficient) : terms_{{variable, coefficient}} {}

  [[nodiscard]] bool isZero() const noexcept { return terms_.empty(); }
  /// Ascending by variable, with nonzero coefficients.
  [[nodiscard]] std::span<const Term> terms() const noexcept { return terms_; }
  [[nodiscard]] std::int64_t coefficient(Index variable) const noexcept;

  /// Adds `factor` times `other`.
  /// @throws Error TooLarge on overflow, as do multiply() and operator()
  void add(const IntegerForm& other, std::int64_t factor);
  void multiply(std::int64_t factor);
  /// Divides by an integer that divides all coefficients.
  void divide(std::int64_t divisor);
  /// The greatest common divisor of all coefficients and `with`.
  [[nodiscard]] std::int64_t commonDivisor(std::int64_t with = 0) const noexcept;

  [[nodiscard]] std::int64_t operator()(std::span<const std::int64_t> values) const;

  [[nodiscard]] auto operator<=>(const IntegerForm&) const = default;

 private:
  std::vector<Term> terms_;
};

/// Homogeneous equations in integer variables, solved for as many variables as there are
/// independent equations; the others are free.
class IntegerSystem {
 public:
  /// @param equations  forms that must vanish
  /// @param preferences  further forms that should vanish; those that would produce fractions
  ///                     smaller than eighths are skipped
  IntegerSystem(std::size_t variableCount, std::vector<IntegerForm> equations,
                std::vector<IntegerForm> preferences = {});

  /// The solution nearest to `wanted` (least squares).
  /// @throws Error TooLarge for more variables than the charts of real maps produce
  [[nodiscard]] std::vector<double> nearest(const std::vector<double>& wanted) const;

  /// Rounds free variables to multiples of `step` and computes the others.
  /// @return empty if one of them is then not an integer
  [[nodiscard]] std::vector<std::int64_t> roundedTo(const std::vector<double>& solution,
                                                    std::int64_t step) const;

  /// Each variable as a combination of free ones: pairs of a free variable and its factor,
  /// ascending.
  [[nodiscard]] std::vector<std::vector<std::pair<Index, double>>> combinations() const;

  [[nodiscard]] const std::vector<Index>& freeVariables() const noexcept { return free_; }

 private:
  /// coefficient * variable + rest = 0, where `rest` contains free variables and those solved
  /// later.
  struct Solved {
    Index variable;
    std::int64_t coefficient;
    IntegerForm rest;
  };

  void addEquations(std::vector<IntegerForm> equations, std::int64_t largestPivot);
  void addEquation(IntegerForm form, std::int64_t largestPivot);
  [[nodiscard]] Index firstSolvedIn(const IntegerForm& form) const noexcept;

  std::size_t variableCount_;
  std::vector<Solved> solved_;
  std::vector<Index> solvedBy_;  ///< per variable: its index in `solved_`, or kNone
  std::vector<Index> free_;
};

}  // namespace hexhex::quantization
