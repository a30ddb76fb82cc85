// How may a vertex of a map move? Everything around it is brought into one chart, its first. Where
// only directions are known, axes are fixed (FixedAxes); where translations between charts are
// known too, as numbers or as unknowns, its position is (PointEquations).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <utility>
#include <vector>

#include <lattice/rotation.hpp>

namespace hexhex::tetmap {

/// Axes of the first chart along which the vertex must not move. Rotations lead from the first
/// chart into the one of the given axis.
class FixedAxes {
 public:
  /// @param planes  normals of planes, as axes of the first chart
  explicit FixedAxes(lattice::AxisSet planes = 0) noexcept : axes_(planes) {}

  /// A plane in which the vertex must stay, such as one of the boundary.
  void addPlane(int axis, lattice::Rotation rotation) noexcept {
    axes_ |= lattice::imageOf(1U << axis, rotation.inverse());
  }
  void addSingularEdge(int axis, lattice::Rotation rotation) noexcept {
    axes_ |= lattice::imageOf(lattice::kAllAxes & ~(1U << axis), rotation.inverse());
    ++singularEdges_;
  }
  /// The rotation of charts once around an edge at the vertex. It leaves the edge's axis alone.
  void addTurn(lattice::Rotation turn) noexcept {
    for (int axis = 0; axis < 3; ++axis) {
      const lattice::Direction d = lattice::direction(axis, 1);
      if (turn(d) != d) axes_ |= 1U << axis;
    }
  }

  [[nodiscard]] lattice::AxisSet axes() const noexcept {
    return isNode(singularEdges_) ? lattice::kAllAxes : axes_;
  }
  /// A node has a number of singular edges other than zero or two. (Section 3.2)
  [[nodiscard]] static constexpr bool isNode(std::size_t singularEdges) noexcept {
    return singularEdges != 0 && singularEdges != 2;
  }

 private:
  lattice::AxisSet axes_;
  std::size_t singularEdges_ = 0;
};

/// A known number as the rest of an equation.
struct KnownRest {
  std::int64_t value = 0;

  void multiply(std::int64_t factor) noexcept { value *= factor; }
  void add(const KnownRest& other, std::int64_t factor = 1) noexcept {
    value += factor * other.value;
  }
  [[nodiscard]] std::int64_t commonDivisor(std::int64_t divisor) const noexcept {
    return std::gcd(divisor, value);
  }
  void divide(std::int64_t divisor) noexcept { value /= divisor; }
};

/// Linear equations of the vertex's position u in the first chart: coefficients . u + rest = 0.
/// Exact: coefficients are -2 to 2 at first, and divided by their common divisors.
/// @tparam Rest  KnownRest, or a form in unknowns with the same functions
template <class Rest>
class PointEquations {
 public:
  struct Equation {
    std::array<std::int64_t, 3> coefficients{};
    Rest rest;
  };
  /// By pivot, with coefficients all zero where a coordinate is free; and the rests of equations
  /// whose coefficients have vanished.
  struct Solution {
    std::array<Equation, 3> coordinates;
    std::vector<Rest> left;
  };

  /// A coordinate of the image R u, plus `rest`, is zero.
  void addPlane(lattice::Rotation rotation, std::size_t axis, Rest rest) {
    Equation equation{{}, std::move(rest)};
    addCoordinate(rotation, axis, 1, equation);
    equations_.push_back(std::move(equation));
  }
  /// A coordinate is the same in two images, up to `rest`.
  void addAgreement(lattice::Rotation one, lattice::Rotation other, std::size_t axis, Rest rest) {
    Equation equation{{}, std::move(rest)};
    addCoordinate(one, axis, 1, equation);
    addCoordinate(other, axis, -1, equation);
    equations_.push_back(std::move(equation));
  }

  /// In reduced row echelon form.
  [[nodiscard]] Solution solve() && {
    Solution solution;
    std::array<std::size_t, 3> columns{};
    std::size_t done = 0;
    for (std::size_t column = 0; column < 3; ++column) {
      if (!takePivot(column, done)) continue;
      for (std::size_t i = 0; i < equations_.size(); ++i) {
        if (i != done) reduce(equations_[i], equations_[done], column);
      }
      columns[done++] = column;
    }
    for (std::size_t i = 0; i < done; ++i) {
      solution.coordinates[columns[i]] = std::move(equations_[i]);
    }
    for (std::size_t i = done; i < equations_.size(); ++i) {
      solution.left.push_back(std::move(equations_[i].rest));
    }
    return solution;
  }

 private:
  static void addCoordinate(lattice::Rotation rotation, std::size_t axis, int factor,
                            Equation& equation) {
    for (int from = 0; from < 3; ++from) {
      const lattice::Direction to = rotation(lattice::direction(from, 1));
      if (static_cast<std::size_t>(lattice::axisOf(to)) != axis) continue;
      equation.coefficients[static_cast<std::size_t>(from)] += factor * lattice::signOf(to);
    }
  }

  /// Moves the first equation with the smallest coefficient into place; false if there is none.
  bool takePivot(std::size_t column, std::size_t place) {
    std::size_t best = equations_.size();
    const auto size = [&](std::size_t i) { return std::abs(equations_[i].coefficients[column]); };
    for (std::size_t i = place; i < equations_.size(); ++i) {
      if (size(i) != 0 && (best == equations_.size() || size(i) < size(best))) best = i;
    }
    if (best == equations_.size()) return false;
    std::swap(equations_[place], equations_[best]);
    return true;
  }

  /// Eliminates a coordinate.
  static void reduce(Equation& equation, const Equation& pivot, std::size_t column) {
    auto& coefficients = equation.coefficients;
    if (coefficients[column] == 0) return;
    const std::int64_t common = std::gcd(coefficients[column], pivot.coefficients[column]);
    const std::int64_t mine = pivot.coefficients[column] / common;
    const std::int64_t theirs = -coefficients[column] / common;
    for (std::size_t k = 0; k < 3; ++k) {
      coefficients[k] = mine * coefficients[k] + theirs * pivot.coefficients[k];
    }
    equation.rest.multiply(mine);
    equation.rest.add(pivot.rest, theirs);
    std::int64_t divisor = 0;
    for (const std::int64_t c : coefficients) divisor = std::gcd(divisor, c);
    divisor = equation.rest.commonDivisor(divisor);
    if (divisor <= 1) return;
    for (std::int64_t& c : coefficients) c /= divisor;
    equation.rest.divide(divisor);
  }

  std::vector<Equation> equations_;
};

}  // namespace hexhex::tetmap
