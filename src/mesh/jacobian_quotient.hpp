// Scaled Jacobians in parts of a cell: determinants divided by the lengths of columns.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

#include <hexhex/types.hpp>

#include <mesh/bezier.hpp>

namespace hexhex::mesh {

/// A part of the cell.
struct CellPart {
  Vec3 lower = {0, 0, 0};
  Vec3 size = {1, 1, 1};

  [[nodiscard]] Vec3 corner(std::size_t corner) const {
    Vec3 place = lower;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1U) != 0) place[axis] += size[axis];
    }
    return place;
  }
  [[nodiscard]] CellPart half(std::size_t axis, std::size_t which) const {
    CellPart part = *this;
    part.size[axis] /= 2;
    if (which == 1) part.lower[axis] += part.size[axis];
    return part;
  }
};

[[nodiscard]] inline double scaledDeterminant(double determinant, double lengths) {
  const double value = determinant / lengths;
  return std::isfinite(value) ? std::clamp(value, -1.0, 1.0) : (determinant < 0 ? -1.0 : 0.0);
}

[[nodiscard]] inline double leastOf(const Bezier<double>& polynomial) {
  return *std::min_element(polynomial.values.begin(), polynomial.values.end());
}

[[nodiscard]] inline double largestOf(const Bezier<double>& polynomial) {
  return *std::max_element(polynomial.values.begin(), polynomial.values.end());
}

[[nodiscard]] inline Bezier<double> productOf(Bezier<double> a, Bezier<double> b) {
  Bezier<double> product;
  weigh(a, false);
  weigh(b, false);
  addConvolution(a, b, 1.0, product);
  weigh(product, true);
  return product;
}

/// The squared length of a column.
[[nodiscard]] inline Bezier<double> squareOf(const std::array<Bezier<double>, 3>& column) {
  Bezier<double> sum = productOf(column[0], column[0]);
  for (std::size_t k = 1; k < 3; ++k) {
    const Bezier<double> square = productOf(column[k], column[k]);
    for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += square.values[i];
  }
  return sum;
}

/// Determinants over lengths in a part of a cell. The quotients of the Bezier coefficients of two
/// squares bound the quotient of the squares, which is a mean of them with positive weights.
struct JacobianQuotient {
  CellPart part = {};
  Bezier<double> determinant = {};
  Bezier<double> square = {};   ///< of the determinant
  Bezier<double> lengths = {};  ///< of the columns: the product of their squared lengths
  double error = 0;             ///< of the determinant
  double bound = -1;            ///< lower bound of the quotient

  /// Bounds a quotient that was made or halved.
  /// @param rounding  of coefficients of the two squares, relative to the largest of each
  void close(double rounding) {
    assert(rounding >= 0 && rounding < 1 && error >= 0);
    const double least = leastOf(determinant) - error;
    const double lengthsError = rounding * largestOf(lengths);
    if (!(least > 0)) {
      const double shortest = leastOf(lengths) - lengthsError;
      bound = shortest > 0 ? scaledDeterminant(least, std::sqrt(shortest) * (1 - rounding)) : -1;
      return;
    }
    const double squareError = rounding * largestOf(square) + 2 * error * largestOf(determinant);
    double smallest = 1;
    for (std::size_t i = 0; i < square.values.size(); ++i) {
      smallest =
          std::min(smallest, (square.values[i] - squareError) / (lengths.values[i] + lengthsError));
    }
    bound = std::sqrt(std::max(smallest, 0.0)) * (1 - rounding);
  }

  [[nodiscard]] std::array<JacobianQuotient, 2> halved(std::size_t axis) const {
    std::array<JacobianQuotient, 2> both;
    const auto halve = [&](Bezier<double> JacobianQuotient::*polynomial) {
      std::array<Bezier<double>, 2> parts = halves(this->*polynomial, axis);
      for (std::size_t h = 0; h < 2; ++h) both[h].*polynomial = std::move(parts[h]);
    };
    halve(&JacobianQuotient::determinant);
    halve(&JacobianQuotient::square);
    halve(&JacobianQuotient::lengths);
    for (std::size_t h = 0; h < 2; ++h) both[h].part = part.half(axis, h);
    return both;
  }
};

}  // namespace hexhex::mesh
