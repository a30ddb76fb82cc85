// Polynomials in u, v, w over the unit cube, given by their Bezier coefficients: all values lie
// between the smallest and the largest coefficient, and those at corners are the values there.
//
// T is double or BigInteger, and Twofold while nodes are converted. Integers are the coefficients
// times one positive factor common to all, which preserves signs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <mesh/exact_numbers.hpp>

namespace hexhex::mesh {

/// Numbers on a grid, the first axis fastest: of degree size - 1 along each axis.
template <class T>
struct Bezier {
  std::array<std::size_t, 3> size{};
  std::vector<T> values = {};

  [[nodiscard]] std::size_t stride(std::size_t axis) const noexcept {
    return axis == 0 ? 1 : (axis == 1 ? size[0] : size[0] * size[1]);
  }
  /// Index of the value at a corner; bit i of the corner is for axis i.
  [[nodiscard]] std::size_t cornerAt(std::size_t corner) const noexcept {
    std::size_t at = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1U) != 0) at += (size[axis] - 1) * stride(axis);
    }
    return at;
  }
};

/// Calls visit(index of the first entry of a line) for all lines along an axis.
template <class T, class Visit>
void forLines(const Bezier<T>& grid, std::size_t axis, const Visit& visit) {
  const std::size_t stride = grid.stride(axis);
  const std::size_t slab = stride * grid.size[axis];
  for (std::size_t outer = 0; outer < grid.values.size(); outer += slab) {
    for (std::size_t at = outer; at < outer + stride; ++at) visit(at);
  }
}

/// A fraction; integers leave out the denominator, which is common to all.
template <class T>
[[nodiscard]] T fraction(std::int64_t numerator, std::int64_t denominator) {
  const auto quotient = static_cast<double>(numerator) / static_cast<double>(denominator);
  if constexpr (std::is_same_v<T, double>) {
    return quotient;
  } else if constexpr (std::is_same_v<T, Twofold>) {
    const auto high = static_cast<double>(numerator);
    const auto low = static_cast<double>(numerator - static_cast<std::int64_t>(high));
    const Twofold product = exactProduct(quotient, static_cast<double>(denominator));
    return {quotient,
            (((high - product.high) - product.low) + low) / static_cast<double>(denominator)};
  } else {
    return BigInteger::of(numerator);
  }
}

template <class T>
struct Matrix {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<T> entries = {};  ///< row by row
};

inline void addProduct(double& sum, double a, double b) { sum += a * b; }
inline void addProduct(BigInteger& sum, const BigInteger& a, const BigInteger& b) {
  sum = sum + a * b;
}

/// sums[i] += a * numbers[i].
template <class S, class T>
void addProducts(T* sums, const S& a, const T* numbers, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) addProduct(sums[i], a, numbers[i]);
}
/// By value, so that writing sums cannot change the factor, and several are computed at once.
inline void addProducts(double* sums, double a, const double* numbers, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) sums[i] += a * numbers[i];
}

/// Multiplies all lines along an axis by a matrix.
template <class S, class T>
void apply(const Matrix<S>& matrix, std::size_t axis, Bezier<T>& grid, std::vector<T>& scratch) {
  const std::size_t stride = grid.stride(axis);
  const std::size_t outer = grid.values.size() / (stride * grid.size[axis]);
  scratch.assign(outer * stride * matrix.rows, T{});
  for (std::size_t o = 0; o < outer; ++o) {
    for (std::size_t row = 0; row < matrix.rows; ++row) {
      for (std::size_t column = 0; column < matrix.columns; ++column) {
        const S& factor = matrix.entries[row * matrix.columns + column];
        const T* const from = &grid.values[stride * (column + matrix.columns * o)];
        T* const to = &scratch[stride * (row + matrix.rows * o)];
        addProducts(to, factor, from, stride);
      }
    }
  }
  grid.values.swap(scratch);
  grid.size[axis] = matrix.rows;
}

[[nodiscard]] inline std::vector<std::int64_t> binomials(std::size_t n) {
  std::vector<std::int64_t> row(n + 1, 1);
  for (std::size_t k = 1; k <= n; ++k) {
    row[k] = row[k - 1] * static_cast<std::int64_t>(n - k + 1) / static_cast<std::int64_t>(k);
  }
  return row;
}

[[nodiscard]] inline std::int64_t leastMultiple(const std::vector<std::int64_t>& row) {
  std::int64_t multiple = 1;
  for (const std::int64_t number : row) multiple = std::lcm(multiple, number);
  return multiple;
}

/// Multiplies each coefficient by the product of the binomials of its three indices, or divides by
/// it. This gives coefficients of the powers (1 - u)^(n - i) u^i, whose products are convolutions.
template <class T>
void weigh(Bezier<T>& grid, bool divide) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (grid.size[axis] <= 2) continue;  // the binomials are 1
    const std::vector<std::int64_t> row = binomials(grid.size[axis] - 1);
    // Only integers need a common denominator; that of degree 52 exceeds 64 bits.
    const std::int64_t multiple = std::is_same_v<T, BigInteger> ? leastMultiple(row) : 1;
    std::vector<T> factors;
    factors.reserve(row.size());
    for (const std::int64_t binomial : row) {
      const std::int64_t denominator = std::is_same_v<T, BigInteger> ? multiple : binomial;
      factors.push_back(divide ? fraction<T>(denominator / binomial, denominator)
                               : fraction<T>(binomial, 1));
    }
    const std::size_t stride = grid.stride(axis);
    forLines(grid, axis, [&](std::size_t at) {
      for (const T& factor : factors) {
        grid.values[at] = grid.values[at] * factor;
        at += stride;
      }
    });
  }
}

/// sum += factor * a * b, all three in the form that weigh() produces.
template <class T>
void addConvolution(const Bezier<T>& a, const Bezier<T>& b, const T& factor, Bezier<T>& sum) {
  for (std::size_t axis = 0; axis < 3; ++axis) sum.size[axis] = a.size[axis] + b.size[axis] - 1;
  sum.values.resize(sum.size[0] * sum.size[1] * sum.size[2]);
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const T value = factor * a.values[i];
    const std::size_t x = i % a.size[0];
    const std::size_t y = i / a.size[0] % a.size[1];
    const std::size_t z = i / a.size[0] / a.size[1];
    for (std::size_t line = 0; line < b.size[1] * b.size[2]; ++line) {
      const T* const from = &b.values[line * b.size[0]];
      T* const to = &sum.values[x + sum.size[0] * (y + line % b.size[1] +
                                                   sum.size[1] * (z + line / b.size[1]))];
      for (std::size_t s = 0; s < b.size[0]; ++s) addProduct(to[s], value, from[s]);
    }
  }
}

/// The coordinates of the three columns of a Jacobian matrix: [column][coordinate].
template <class T>
using Columns = std::array<std::array<Bezier<T>, 3>, 3>;

template <class T>
[[nodiscard]] Bezier<T> determinantOf(Columns<T> columns) {
  for (auto& column : columns) {
    for (Bezier<T>& coordinate : column) weigh(coordinate, false);
  }
  const T one = fraction<T>(1, 1);
  const T minusOne = fraction<T>(-1, 1);
  Bezier<T> determinant;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    const std::size_t m = (k + 2) % 3;
    Bezier<T> minor;
    addConvolution(columns[1][l], columns[2][m], one, minor);
    addConvolution(columns[1][m], columns[2][l], minusOne, minor);
    addConvolution(columns[0][k], minor, one, determinant);
  }
  weigh(determinant, true);
  return determinant;
}

[[nodiscard]] inline double halved(double sum, std::size_t times, std::size_t /*degree*/) {
  return sum / static_cast<double>(std::uint64_t{1} << times);
}
[[nodiscard]] inline BigInteger halved(const BigInteger& sum, std::size_t times,
                                       std::size_t degree) {
  return sum.shifted(static_cast<int>(degree - times));
}

/// The same polynomial over both halves of the cube (de Casteljau).
template <class T>
[[nodiscard]] std::array<Bezier<T>, 2> halves(const Bezier<T>& whole, std::size_t axis) {
  std::array<Bezier<T>, 2> result = {whole, whole};
  const std::size_t stride = whole.stride(axis);
  const std::size_t degree = whole.size[axis] - 1;
  std::vector<T> line(degree + 1);
  forLines(whole, axis, [&](std::size_t at) {
    for (std::size_t k = 0; k <= degree; ++k) line[k] = whole.values[at + k * stride];
    for (std::size_t step = 0; step <= degree; ++step) {
      result[0].values[at + step * stride] = halved(line[0], step, degree);
      result[1].values[at + (degree - step) * stride] = halved(line[degree - step], step, degree);
      for (std::size_t k = 0; k + step < degree; ++k) line[k] = line[k] + line[k + 1];
    }
  });
  return result;
}

/// Conversion from equidistant nodes to Bezier coefficients.
template <class T>
struct NodeMatrices {
  Matrix<T> values;       ///< of the values at the nodes
  Matrix<T> differences;  ///< of the derivative, from the differences of adjacent nodes
};

/// The Lagrange polynomial of node i is the product of (p u - j) / (i - j); in powers of (1 - u)
/// and u, a factor is ((p - j) u - j (1 - u)) / (i - j): integers over one denominator.
template <class T>
[[nodiscard]] NodeMatrices<T> nodeMatrices(std::size_t order) {
  const std::vector<std::int64_t> row = binomials(order);
  const std::int64_t multiple = leastMultiple(row);
  std::int64_t denominator = multiple;
  for (std::size_t i = 2; i <= order; ++i) denominator *= static_cast<std::int64_t>(i);

  const std::size_t n = order + 1;
  std::vector<std::int64_t> entries(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::int64_t> powers = {(order - i) % 2 == 0 ? 1 : -1};
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i) continue;
      powers.push_back(0);
      for (std::size_t k = powers.size(); k-- > 0;) {
        powers[k] = -static_cast<std::int64_t>(j) * powers[k] +
                    (k > 0 ? static_cast<std::int64_t>(order - j) * powers[k - 1] : 0);
      }
    }
    for (std::size_t k = 0; k < n; ++k)
      entries[k * n + i] = powers[k] * row[i] * (multiple / row[k]);
  }
  NodeMatrices<T> result = {{n, n, {}}, {order, order, {}}};
  for (const std::int64_t entry : entries) {
    result.values.entries.push_back(fraction<T>(entry, denominator));
  }
  for (std::size_t k = 0; k < order; ++k) {
    std::int64_t sum = 0;  // summation by parts
    for (std::size_t i = 0; i < order; ++i) {
      sum -= static_cast<std::int64_t>(order) * (entries[(k + 1) * n + i] - entries[k * n + i]);
      result.differences.entries.push_back(fraction<T>(sum, denominator));
    }
  }
  return result;
}

}  // namespace hexhex::mesh
