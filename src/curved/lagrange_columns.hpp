// Jacobian matrices of Lagrange cells on grids of places, of four cells at once.
//
// The functions here take everything inline, so that callers compile them for wide registers.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/types.hpp>

#include <base/lanes.hpp>
#include <mesh/bezier.hpp>
#include <mesh/jacobian_lanes.hpp>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // all is inline
#endif

namespace hexhex::curved {

/// Lagrange polynomials of one order, and their derivatives, at places along an axis.
struct LagrangeColumns {
  // A row per place, a column per polynomial.
  mesh::Matrix<double> value;
  mesh::Matrix<double> derivative;

  /// @param places  in [0, 1], the same along each axis
  LagrangeColumns(int order, const std::vector<double>& places);

  [[nodiscard]] std::size_t placeCount() const noexcept {
    return value.rows * value.rows * value.rows;
  }
};

/// The points from 0 to 1 in `order` equal steps.
[[nodiscard]] std::vector<double> equidistant(int order);

/// Four cells, one per lane.
inline constexpr std::size_t kCellLanes = 4;
using CellNumber = Lanes<double, kCellLanes>;
struct alignas(kCellLanes * sizeof(double)) CellVector {
  LaneVector<CellNumber> at;
};

/// Nodes of up to four cells, the first axis fastest; of fewer, the last stands in for the others.
struct LagrangeCells {
  const Vec3* points;
  std::array<const Index*, kCellLanes> nodes;

  /// @param nodesOf  of (i) for i < count, which is 1 to 4: a pointer
  template <class NodesOf>
  LagrangeCells(const Vec3* points_, std::size_t count, const NodesOf& nodesOf) : points(points_) {
    for (std::size_t i = 0; i < kCellLanes; ++i) nodes[i] = nodesOf(std::min(i, count - 1));
  }
};

/// Of the functions below. One per thread.
using LagrangeScratch = std::vector<CellVector>;

/// A row of a matrix with n columns times values that are so far apart.
[[gnu::always_inline]] inline LaneVector<CellNumber> combined(std::size_t n,
                                                              const mesh::Matrix<double>& matrix,
                                                              std::size_t row,
                                                              const CellVector* values,
                                                              std::size_t stride) noexcept {
  const double* const factors = &matrix.entries[row * n];
  LaneVector<CellNumber> sum{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += factors[i] * values[i * stride].at[k];
  }
  return sum;
}

/// @param n  nodes along an axis
template <class Visit>
[[gnu::always_inline]] inline void forColumns(std::size_t n, const LagrangeColumns& grid,
                                              const LagrangeCells& cells, LagrangeScratch& scratch,
                                              const Visit& visit) {
  const std::size_t m = grid.value.rows;
  const std::size_t nodeCount = n * n * n;
  scratch.resize(nodeCount + 2 * n * n + 3 * n);
  CellVector* const nodes = scratch.data();
  CellVector* const layer = nodes + nodeCount;  // at one place of the last axis
  CellVector* const layerW = layer + n * n;     // its derivative along that axis
  CellVector* const line = layerW + n * n;      // at one place of the last two
  CellVector* const lineV = line + n;
  CellVector* const lineW = lineV + n;
  for (std::size_t i = 0; i < nodeCount; ++i) {
    for (std::size_t lane = 0; lane < kCellLanes; ++lane) {
      const Vec3& point = cells.points[cells.nodes[lane][i]];
      for (std::size_t k = 0; k < 3; ++k) nodes[i].at[k][lane] = point[k];
    }
  }
  for (std::size_t w = 0; w < m; ++w) {
    for (std::size_t i = 0; i < n * n; ++i) {
      layer[i].at = combined(n, grid.value, w, nodes + i, n * n);
      layerW[i].at = combined(n, grid.derivative, w, nodes + i, n * n);
    }
    for (std::size_t v = 0; v < m; ++v) {
      for (std::size_t i = 0; i < n; ++i) {
        line[i].at = combined(n, grid.value, v, layer + i, n);
        lineV[i].at = combined(n, grid.derivative, v, layer + i, n);
        lineW[i].at = combined(n, grid.value, v, layerW + i, n);
      }
      for (std::size_t u = 0; u < m; ++u) {
        visit(std::array<std::size_t, 3>{u, v, w}, combined(n, grid.derivative, u, line, 1),
              combined(n, grid.value, u, lineV, 1), combined(n, grid.value, u, lineW, 1));
      }
    }
  }
}

/// Calls visit(rows along u, v and w, x_u, x_v, x_w) for all places, the first axis fastest.
template <class Visit>
[[gnu::always_inline]] inline void forColumns(const LagrangeColumns& grid,
                                              const LagrangeCells& cells, LagrangeScratch& scratch,
                                              const Visit& visit) {
  // Constants make loops straight lines, which takes half the time.
  const std::size_t n = grid.value.columns;
  if (n == 3) return forColumns(3, grid, cells, scratch, visit);
  if (n == 4) return forColumns(4, grid, cells, scratch, visit);
  return forColumns(n, grid, cells, scratch, visit);
}

/// @param m  rows and columns
template <class NumberAt>
[[gnu::always_inline]] inline void convert(std::size_t m, const mesh::Matrix<double>& matrix,
                                           const NumberAt& numberAt) noexcept {
  struct alignas(CellVector) Line {
    std::array<CellNumber, 3 * kMaxOrder> numbers;
  } line;
  std::size_t stride = 1;
  for (int axis = 0; axis < 3; ++axis, stride *= m) {
    for (std::size_t at = 0; at < m * m; ++at) {
      const std::size_t first = at % stride + at / stride * stride * m;
      for (std::size_t i = 0; i < m; ++i) line.numbers[i] = numberAt(first + i * stride);
      for (std::size_t row = 0; row < m; ++row) {
        const double* const factors = &matrix.entries[row * m];
        CellNumber sum{};
        for (std::size_t i = 0; i < m; ++i) sum += factors[i] * line.numbers[i];
        numberAt(first + row * stride) = sum;
      }
    }
  }
}

/// Multiplies numbers at places by a matrix along all three axes, in place.
/// @param numberAt  of (place): a reference
template <class NumberAt>
[[gnu::always_inline]] inline void convert(const mesh::Matrix<double>& matrix,
                                           const NumberAt& numberAt) noexcept {
  if (matrix.rows == 6) return convert(6, matrix, numberAt);  // as above, for order 2
  return convert(matrix.rows, matrix, numberAt);
}

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

}  // namespace hexhex::curved
