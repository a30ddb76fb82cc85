// Certificates of cells of order 2 and 3 against exact subdivision by independent code: polynomials
// in powers of u, v, w with integer coefficients, and from these to Bezier coefficients.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <optional>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <mesh/cell_validity.hpp>
#include <mesh/grid_meshes.hpp>

#include "support/effort.hpp"

namespace hexhex::mesh {
namespace {

using testing::Random;
using WideInteger = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
    512, 512, boost::multiprecision::signed_magnitude, boost::multiprecision::unchecked, void>>;

/// Lagrange polynomials of equidistant nodes in powers of u, times 1 (order 2) or 2 (order 3).
const std::vector<std::vector<int>>& lagrange(std::size_t order) {
  static const std::vector<std::vector<int>> two = {{1, -3, 2}, {0, 4, -4}, {0, -1, 2}};
  static const std::vector<std::vector<int>> three = {
      {2, -11, 18, -9}, {0, 18, -45, 27}, {0, -9, 36, -27}, {0, 2, -9, 9}};
  return order == 2 ? two : three;
}

/// n numbers along each axis, the first axis fastest.
struct Grid {
  std::size_t n;
  std::vector<WideInteger> values;

  explicit Grid(std::size_t size) : n(size), values(size * size * size) {}
  [[nodiscard]] std::size_t stride(std::size_t axis) const {
    return axis == 0 ? 1 : (axis == 1 ? n : n * n);
  }
};

/// Replaces the numbers along an axis: change(line) gets and changes n of them.
template <class Change>
void changeLines(Grid& grid, std::size_t axis, const Change& change) {
  const std::size_t stride = grid.stride(axis);
  std::vector<WideInteger> line(grid.n);
  for (std::size_t at = 0; at < grid.values.size(); ++at) {
    if (at / stride % grid.n != 0) continue;
    for (std::size_t i = 0; i < grid.n; ++i) line[i] = grid.values[at + i * stride];
    change(line);
    for (std::size_t i = 0; i < grid.n; ++i) grid.values[at + i * stride] = line[i];
  }
}

Grid product(const Grid& a, const Grid& b) {
  Grid result(a.n);
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    if (a.values[i] == 0) continue;
    for (std::size_t j = 0; j < b.values.size(); ++j) {
      if (b.values[j] != 0) result.values[i + j] += a.values[i] * b.values[j];
    }
  }
  return result;
}

using Node = std::array<std::int64_t, 3>;

/// Bezier coefficients of the determinant, times a positive number.
Grid coefficientsOf(std::size_t order, const std::vector<Node>& nodes) {
  const std::size_t n = 3 * order;  // degree 3 p - 1: so do all products fit
  std::array<std::vector<Grid>, 3> columns;
  for (std::size_t k = 0; k < 3; ++k) {
    Grid position(n);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::size_t m = order + 1;
      position.values[i % m + n * (i / m % m + n * (i / m / m))] = nodes[i][k];
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      changeLines(position, axis, [&](std::vector<WideInteger>& line) {
        std::vector<WideInteger> powers(n);
        for (std::size_t i = 0; i <= order; ++i) {
          for (std::size_t a = 0; a <= order; ++a) powers[a] += lagrange(order)[i][a] * line[i];
        }
        line = powers;
      });
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns[axis].push_back(position);
      changeLines(columns[axis].back(), axis, [&](std::vector<WideInteger>& line) {
        for (std::size_t a = 0; a + 1 < n; ++a) line[a] = WideInteger(a + 1) * line[a + 1];
        line[n - 1] = 0;
      });
    }
  }
  Grid result(n);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    const std::size_t m = (k + 2) % 3;
    const Grid plus = product(columns[0][k], product(columns[1][l], columns[2][m]));
    const Grid minus = product(columns[0][k], product(columns[1][m], columns[2][l]));
    for (std::size_t i = 0; i < result.values.size(); ++i) {
      result.values[i] += plus.values[i] - minus.values[i];
    }
  }
  // u^k is the sum over i >= k of (i over k) / (d over k) times the i-th Bernstein polynomial.
  std::vector<std::vector<std::int64_t>> over(n, std::vector<std::int64_t>(n));
  std::int64_t multiple = 1;
  for (std::size_t i = 0; i < n; ++i) {
    over[i][0] = 1;
    for (std::size_t k = 1; k <= i; ++k) over[i][k] = over[i - 1][k - 1] + over[i - 1][k];
  }
  for (const std::int64_t binomial : over[n - 1]) multiple = std::lcm(multiple, binomial);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    changeLines(result, axis, [&](std::vector<WideInteger>& line) {
      std::vector<WideInteger> bezier(n);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k <= i; ++k) {
          bezier[i] += WideInteger(over[i][k] * (multiple / over[n - 1][k])) * line[k];
        }
      }
      line = bezier;
    });
  }
  return result;
}

/// Half of the cell, times 2 to the degree.
Grid half(Grid whole, std::size_t axis, bool upper) {
  changeLines(whole, axis, [&](std::vector<WideInteger>& line) {
    if (upper) std::reverse(line.begin(), line.end());
    std::vector<WideInteger> part;
    std::vector<WideInteger> row = line;
    for (std::size_t step = 0; step < line.size(); ++step) {
      part.push_back(row[0] << (line.size() - 1 - step));
      for (std::size_t i = 0; i + 1 < row.size(); ++i) row[i] += row[i + 1];
      row.pop_back();
    }
    line = part;
    if (upper) std::reverse(line.begin(), line.end());
  });
  return whole;
}

/// Whether it is positive everywhere, if so many levels of eight parts tell.
std::optional<bool> isPositive(const Grid& c, int levels) {
  if (std::all_of(c.values.begin(), c.values.end(), [](const WideInteger& x) { return x > 0; })) {
    return true;
  }
  for (std::size_t corner = 0; corner < 8; ++corner) {
    std::size_t at = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1U) != 0) at += (c.n - 1) * c.stride(axis);
    }
    if (c.values[at] <= 0) return false;
  }
  if (levels == 0) return std::nullopt;
  std::optional<bool> all = true;
  for (unsigned octant = 0; octant < 8; ++octant) {
    Grid part = c;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      part = half(std::move(part), axis, (octant >> axis & 1U) != 0);
    }
    const std::optional<bool> known = isPositive(part, levels - 1);
    if (known == std::optional(false)) return false;
    if (!known) all = std::nullopt;
  }
  return all;
}

/// Nodes on a grid, moved by up to a share of their distance: coarsely in every other cell, so that
/// determinants are exactly, or nearly, zero at some points.
std::vector<Node> draw(std::size_t order, std::size_t number, Random& random) {
  constexpr std::int64_t kUnit = std::int64_t{1} << 44;
  const std::size_t n = order + 1;
  const bool isCoarse = number % 2 == 0;
  const double share = std::array{0.15, 0.3, 0.5, 0.8}[number / 2 % 4];
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < n * n * n; ++i) {
    const std::array<std::size_t, 3> place = {i % n, i / n % n, i / n / n};
    Node node;
    for (std::size_t k = 0; k < 3; ++k) {
      const double step = share * (2 * random.real() - 1) * kUnit;
      node[k] = static_cast<std::int64_t>(place[k]) * kUnit +
                (isCoarse ? std::llround(step / (kUnit / 4)) * (kUnit / 4) : std::llround(step));
    }
    nodes.push_back(node);
  }
  // Hardly anything, beside a coarse cell.
  if (number % 4 == 2) nodes[random.below(nodes.size())][random.below(3)] += 1;
  return nodes;
}

/// HEXHEX_TEST_EFFORT=N takes N times as many.
TEST(Certificates, OfCurvedCellsAreRight) {
  const double effort = test::effort();
  for (const std::size_t order : {2U, 3U}) {
    const CellValidity cells(static_cast<int>(order));
    Random random(order);
    std::array<std::size_t, 3> verdicts{};
    std::size_t unknown = 0;
    const auto count = static_cast<std::size_t>((order == 2 ? 200 : 24) * effort);
    for (std::size_t i = 0; i < count; ++i) {
      const std::vector<Node> nodes = draw(order, i, random);
      std::vector<Vec3> points;
      for (const Node& node : nodes) {
        points.push_back({static_cast<double>(node[0]), static_cast<double>(node[1]),
                          static_cast<double>(node[2])});
      }
      const Validity verdict = cells.examine(points).validity;
      const std::optional<bool> truth = isPositive(coefficientsOf(order, nodes), 6);
      ++verdicts[static_cast<std::size_t>(verdict)];
      if (!truth) ++unknown;
      EXPECT_FALSE(truth == std::optional(false) && verdict == Validity::Positive) << i;
      EXPECT_FALSE(truth == std::optional(true) && verdict == Validity::Refuted) << i;
    }
    std::cout << "order " << order << ": " << count << " cells, "
              << verdicts[static_cast<std::size_t>(Validity::Positive)] << " positive, "
              << verdicts[static_cast<std::size_t>(Validity::Refuted)] << " refuted, "
              << verdicts[static_cast<std::size_t>(Validity::Undecided)] << " undecided, here "
              << unknown << "\n";
    if (effort < 1) continue;
    EXPECT_GT(verdicts[static_cast<std::size_t>(Validity::Positive)], count / 20);
    EXPECT_GT(verdicts[static_cast<std::size_t>(Validity::Refuted)], count / 20);
  }
}

}  // namespace
}  // namespace hexhex::mesh
