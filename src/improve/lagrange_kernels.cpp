// Compiled for several register widths, like energy_kernels.cpp.
#include <limits>

#include <base/register_widths.hpp>
#include <improve/lagrange_kernels.hpp>

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace hexhex::improvement {

namespace {

using curved::kCellLanes;
using curved::LagrangeCells;
using curved::LagrangeScratch;
using Number = curved::CellNumber;
using Vector = LaneVector<Number>;
using mesh::operator+;
using mesh::scaled;
static_assert(sizeof(Number) == sizeof(TermLanes::Number));

constexpr std::size_t kMostPlaces = 9;  // along an axis: for order 3
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// The Lagrange polynomial of the moving node and its derivative, along one axis.
struct alignas(TermLanes) Polynomial {
  std::array<Number, kMostPlaces> value;
  std::array<Number, kMostPlaces> derivative;
};

HEXHEX_INLINE std::array<Polynomial, 3> polynomialsOf(const LagrangeGrid& grid,
                                                      const MovingNode& moving) noexcept {
  const auto& [value, derivative] = grid.columns;
  std::array<Polynomial, 3> polynomials;
  for (std::size_t lane = 0; lane < kCellLanes; ++lane) {
    std::size_t node = moving.node[lane];
    for (Polynomial& along : polynomials) {
      for (std::size_t row = 0; row < value.rows; ++row) {
        along.value[row][lane] = value.entries[row * value.columns + node % value.columns];
        along.derivative[row][lane] =
            derivative.entries[row * value.columns + node % value.columns];
      }
      node /= value.columns;
    }
  }
  return polynomials;
}

HEXHEX_INLINE void termsOf(const LagrangeGrid& grid, const MovingNode& moving,
                           LagrangeScratch& scratch, TermLanes* terms) {
  const std::array<Polynomial, 3> along = polynomialsOf(grid, moving);
  struct alignas(TermLanes) {
    Vector scale;
    Number weight;
  } cells;
  for (std::size_t lane = 0; lane < kCellLanes; ++lane) {
    for (std::size_t k = 0; k < 3; ++k) cells.scale[k][lane] = moving.scale[lane][k];
    cells.weight[lane] = lane < moving.count ? 1 : 0;
  }
  TermLanes* next = terms;
  curved::forColumns(grid.columns, moving.cells, scratch,
                     [&](const auto& row, const Vector& xu, const Vector& xv, const Vector& xw) {
                       const Vector u = scaled(cells.scale[0], xu);
                       const Vector v = scaled(cells.scale[1], xv);
                       const Vector w = scaled(cells.scale[2], xw);
                       const Number& a = along[0].value[row[0]];
                       const Number& b = along[1].value[row[1]];
                       const Number& c = along[2].value[row[2]];
                       // The derivatives of the columns with respect to the node are these times
                       // the identity.
                       const Number byU = cells.scale[0] * along[0].derivative[row[0]] * b * c;
                       const Number byV = cells.scale[1] * along[1].derivative[row[1]] * a * c;
                       const Number byW = cells.scale[2] * along[2].derivative[row[2]] * a * b;
                       const Vector vw = cross(v, w);
                       TermLanes& term = *next++;
                       term.square = dot(u, u) + dot(v, v) + dot(w, w);
                       term.slope = scaled(byU, u) + scaled(byV, v) + scaled(byW, w);
                       term.growth = byU * byU + byV * byV + byW * byW;
                       term.determinant = dot(u, vw);
                       term.normal =
                           scaled(byU, vw) + scaled(byV, cross(w, u)) + scaled(byW, cross(u, v));
                       term.weight = cells.weight;
                     });
  if (grid.toBezier.rows == 0) return;
  const auto atEach = [&](const auto& numberOf) {
    curved::convert(grid.toBezier,
                    [&](std::size_t place) -> Number& { return numberOf(terms[place]); });
  };
  atEach([](TermLanes& term) -> Number& { return term.determinant; });
  atEach([](TermLanes& term) -> Number& { return term.normal[0]; });
  atEach([](TermLanes& term) -> Number& { return term.normal[1]; });
  atEach([](TermLanes& term) -> Number& { return term.normal[2]; });
}

HEXHEX_INLINE std::array<double, kCellLanes> leastSharesOf(const LagrangeGrid& grid,
                                                           const LagrangeCells& cells,
                                                           LagrangeScratch& scratch) {
  struct alignas(TermLanes) {
    std::array<Number, kMostPlaces * kMostPlaces * kMostPlaces> numbers;
  } all;
  std::size_t count = 0;
  curved::forColumns(grid.columns, cells, scratch,
                     [&](const auto& /*row*/, const Vector& u, const Vector& v, const Vector& w) {
                       all.numbers[count++] = dot(u, cross(v, w));
                     });
  curved::convert(grid.toBezier, [&](std::size_t place) -> Number& { return all.numbers[place]; });
  struct alignas(TermLanes) {
    Number least;
    Number largest;
  } bounds = {Number{} + kUnbounded, Number{} - kUnbounded};
  for (std::size_t i = 0; i < count; ++i) {
    bounds.least = smaller(all.numbers[i], bounds.least);
    bounds.largest = larger(all.numbers[i], bounds.largest);
  }
  std::array<double, kCellLanes> shares{};
  for (std::size_t lane = 0; lane < kCellLanes; ++lane) {
    if (bounds.largest[lane] > 0) shares[lane] = bounds.least[lane] / bounds.largest[lane];
  }
  return shares;
}

}  // namespace

std::span<const LagrangeKernels> lagrangeKernels() noexcept {
  static constexpr std::array<LagrangeKernels, 2> kBoth = {
      {{termsOf, leastSharesOf}, {kWide<termsOf>, kWide<leastSharesOf>}}};
  return runnable(kBoth);
}

}  // namespace hexhex::improvement
