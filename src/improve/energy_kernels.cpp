// Compiled for several register widths, like cell_measures.cpp: the entry points for each width
// inline everything that they call.
//
// But for OwnCorners, the terms are those of lagrange_kernels.cpp for order 1. With these, balls of
// which a tenth of the cells is not positive would take 5 % longer for terms of Bezier
// coefficients, and 40 % for terms of corners.
#include <algorithm>
#include <limits>

#include <untangle/regularized.hpp>

#include <base/register_widths.hpp>
#include <improve/energy_kernels.hpp>
#include <mesh/jacobian_lanes.hpp>

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace hexhex::improvement {

namespace {

using Number = TermLanes::Number;
using Vector = LaneVector<Number>;
using mesh::operator+;
using mesh::operator-;
using mesh::scaled;
using untangle::Regularized;
constexpr std::size_t kLanes = TermLanes::kCount;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// 1 / |I|^3, such that the ideal shape has energy 1.
constexpr double kUnit = 0.19245008972987526;  // 1 / (3 sqrt(3))

HEXHEX_INLINE double sumOf(const Number& x) noexcept { return (x[0] + x[1]) + (x[2] + x[3]); }

/// (|J|^3 / (3 sqrt(3) chi))^power
HEXHEX_INLINE Number shapeOf(const Number& square, const Number& byChi, int power) noexcept {
  Number shape = kUnit * square * rootOf(square) * byChi;
  for (; power > 1; power /= 2) shape *= shape;
  return shape;
}

/// What Regularized is for positive determinants without epsilon, bit for bit. Improving a mesh of
/// which a tenth is not positive takes 8 % less time than with its roots and quotients.
struct alignas(TermLanes) Plain {
  Number root;
  HEXHEX_INLINE Plain(double /*epsilon*/, const Number& det) noexcept : root(det) {}
  [[nodiscard]] HEXHEX_INLINE Number inverse() const noexcept { return 1 / root; }
};

template <class Chi>
HEXHEX_INLINE double energyBy(std::span<const TermLanes> terms, const EnergyKind& kind,
                              const Vec3& step) noexcept {
  Number sum{};
  Number least = Number{} + 1;
  const double length = step[0] * step[0] + step[1] * step[1] + step[2] * step[2];
  for (const TermLanes& term : terms) {
    const Number det = term.determinant + term.normal[0] * step[0] + term.normal[1] * step[1] +
                       term.normal[2] * step[2];
    const Number along =
        term.slope[0] * step[0] + term.slope[1] * step[1] + term.slope[2] * step[2];
    const Number square = term.square + 2 * along + term.growth * length;
    const Number byChi = Chi(kind.epsilon, det).inverse();
    sum +=
        term.weight * (shapeOf(square, byChi, kind.power) + kind.volume * (det * det + 1) * byChi);
    least = smaller(least, det);
  }
  if (kind.epsilon > 0) return sumOf(sum);
  const double smallest = std::min({least[0], least[1], least[2], least[3]});
  return smallest > 0 ? sumOf(sum) : kInfinite;
}

HEXHEX_INLINE double energyOf(std::span<const TermLanes> terms, const EnergyKind& kind,
                              const Vec3& step) noexcept {
  return kind.epsilon > 0 ? energyBy<Regularized<Number>>(terms, kind, step)
                          : energyBy<Plain>(terms, kind, step);
}

struct alignas(TermLanes) SlopeSums {
  Number energy{};
  Vector gradient{};
  std::array<Number, 6> hessian{};
  Number diagonal{};
};

template <class Chi>
HEXHEX_INLINE void addSlope(const TermLanes& term, const EnergyKind& kind,
                            SlopeSums& sum) noexcept {
  const Number det = term.determinant;
  const Chi regularized(kind.epsilon, det);
  const Number byRoot = 1 / regularized.root;
  const Number byChi = regularized.inverse();
  const Number bySquare = 1 / term.square;
  const Number energy = term.weight * shapeOf(term.square, byChi, kind.power);
  // Derivatives with respect to |J|^2 and the determinant. That of log(chi) is 1 / root.
  const double power = kind.power;
  const Number all = power * energy;
  const Number gradientQ = 1.5 * all * bySquare;
  const Number qq = (2.25 * power - 1.5) * all * bySquare * bySquare;
  const Number qDet = -1.5 * power * all * bySquare * byRoot;
  Number gradientDet = -all * byRoot;
  Number detDet = (power + 1) * all * byRoot * byRoot;
  sum.energy += energy;
  if (kind.volume > 0) {
    const Number numerator = det * det + 1;
    const Number weight = kind.volume * term.weight * byChi;
    sum.energy += weight * numerator;
    gradientDet += weight * (2 * det - numerator * byRoot);
    // (det^2 + 1) / chi is only convex in det where chi is linear: use a convex part of it.
    const Number a = 1 - det * byRoot;
    detDet += 2 * weight * (a * a + byRoot * byRoot);
  }
  const Vector q = scaled(Number{} + 2, term.slope);
  const Vector& n = term.normal;
  sum.gradient = sum.gradient + scaled(gradientQ, q) + scaled(gradientDet, n);
  const Vector alongQ = scaled(qq, q) + scaled(qDet, n);
  const Vector alongN = scaled(qDet, q) + scaled(detDet, n);
  std::size_t at = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) sum.hessian[at++] += q[i] * alongQ[j] + n[i] * alongN[j];
  }
  sum.diagonal += 2 * gradientQ * term.growth;
}

HEXHEX_INLINE void slopeOfAll(std::span<const TermLanes> terms, const EnergyKind& kind,
                              EnergySlope& slope) noexcept {
  SlopeSums sum;
  if (kind.epsilon > 0) {
    for (const TermLanes& term : terms) addSlope<Regularized<Number>>(term, kind, sum);
  } else {
    for (const TermLanes& term : terms) addSlope<Plain>(term, kind, sum);
  }
  slope.energy = sumOf(sum.energy);
  for (std::size_t k = 0; k < 3; ++k) slope.gradient[k] = sumOf(sum.gradient[k]);
  for (std::size_t k = 0; k < 6; ++k) slope.hessian[k] = sumOf(sum.hessian[k]);
  for (const std::size_t k : {0U, 3U, 5U}) slope.hessian[k] += sumOf(sum.diagonal);
}

/// One cell per lane. Unused lanes repeat the last cell, with weight 0.
struct alignas(TermLanes) LaneCells {
  std::array<Vector, 8> at;
  Vector scale;
  Number weight;
};

HEXHEX_INLINE Number gathered(std::span<const MovingCell> cells, const auto& of) noexcept {
  const std::size_t last = cells.size() - 1;
  return Number{of(cells[0]), of(cells[std::min<std::size_t>(1, last)]),
                of(cells[std::min<std::size_t>(2, last)]), of(cells[last])};
}

HEXHEX_INLINE LaneCells laneCells(std::span<const MovingCell> cells) noexcept {
  LaneCells lanes;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t place = 0; place < 8; ++place) {
      lanes.at[place][k] =
          gathered(cells, [&](const MovingCell& cell) { return (*cell.corners[place])[k]; });
    }
    lanes.scale[k] = gathered(cells, [&](const MovingCell& cell) { return cell.scale[k]; });
  }
  for (std::size_t i = 0; i < kLanes; ++i) lanes.weight[i] = i < cells.size() ? 1.0 : 0.0;
  return lanes;
}

/// Edges in units of the ideal box.
HEXHEX_INLINE mesh::CellEdges<Number> edgesOf(const LaneCells& cells) noexcept {
  mesh::CellEdges<Number> edges(cells.at);
  for (std::size_t i = 0; i < 4; ++i) {
    edges.u[i] = scaled(cells.scale[0], edges.u[i]);
    edges.v[i] = scaled(cells.scale[1], edges.v[i]);
    edges.w[i] = scaled(cells.scale[2], edges.w[i]);
  }
  return edges;
}

/// The term at the corner that `edge` connects with the moving one.
HEXHEX_INLINE void besideTerm(const Number& scale, const Vector& edge, const Vector& b,
                              const Vector& c, TermLanes& term) noexcept {
  const Vector cofactor = cross(b, c);
  term.square = dot(edge, edge) + dot(b, b) + dot(c, c);
  term.slope = scaled(-scale, edge);
  term.growth = scale * scale;
  term.determinant = dot(edge, cofactor);
  term.normal = scaled(-scale, cofactor);
}

/// Measures an edge, in units of the box, by its ideal length: that is near the mean of its own and
/// of the box's (the same, with two derivatives, where these are equal), but 2/3 to 2 of the box's.
/// With the mean itself, which takes a root, improving a ball of positive cells takes 13 % longer.
/// @return  one over that length
HEXHEX_INLINE Number measuredByIdeal(Vector& edge) noexcept {
  const Number square = dot(edge, edge);
  const Number factor = (3 + square) / (2 + 2 * square);
  edge = scaled(factor, edge);
  return factor;
}

/// @param s  derivatives of the first edges with respect to the moving corner, negated
HEXHEX_INLINE void addCornerTerms(const mesh::CellEdges<Number>& edges, const Vector& s,
                                  const Number& weight, TermLanes* terms) noexcept {
  const auto& [u, v, w] = edges;
  const Vector vw = cross(v[0], w[0]);
  TermLanes& at = terms[0];
  at.square = dot(u[0], u[0]) + dot(v[0], v[0]) + dot(w[0], w[0]);
  at.slope = Vector{} - scaled(s[0], u[0]) - scaled(s[1], v[0]) - scaled(s[2], w[0]);
  at.growth = dot(s, s);
  at.determinant = dot(u[0], vw);
  at.normal = Vector{} - scaled(s[0], vw) - scaled(s[1], cross(w[0], u[0])) -
              scaled(s[2], cross(u[0], v[0]));
  besideTerm(s[0], u[0], v[1], w[1], terms[1]);
  besideTerm(s[1], v[0], w[2], u[1], terms[2]);
  besideTerm(s[2], w[0], u[2], v[2], terms[3]);
  for (std::size_t i = 0; i < kCornerTerms; ++i) terms[i].weight = weight;
}

HEXHEX_INLINE void cornerTermsOf(std::span<const MovingCell> list, TermLanes* terms) noexcept {
  const LaneCells cells = laneCells(list);
  addCornerTerms(edgesOf(cells), cells.scale, cells.weight, terms);
}

HEXHEX_INLINE void ownCornerTermsOf(std::span<const MovingCell> list, TermLanes* terms) noexcept {
  LaneCells cells = laneCells(list);
  mesh::CellEdges<Number> edges = edgesOf(cells);
  // The first edges move. No fourth one is at those corners.
  cells.scale[0] *= measuredByIdeal(edges.u[0]);
  cells.scale[1] *= measuredByIdeal(edges.v[0]);
  cells.scale[2] *= measuredByIdeal(edges.w[0]);
  for (const std::size_t i : {1U, 2U}) {
    measuredByIdeal(edges.u[i]);
    measuredByIdeal(edges.v[i]);
    measuredByIdeal(edges.w[i]);
  }
  addCornerTerms(edges, cells.scale, cells.weight, terms);
}

/// Values at places (a, b, c), each coordinate in halves of an axis: index a + 3 b + 9 c.
template <class Value>
struct alignas(TermLanes) ByPlace {
  std::array<Value, 27> values;
  HEXHEX_INLINE Value& operator[](std::size_t at) noexcept { return values[at]; }
  HEXHEX_INLINE const Value& operator[](std::size_t at) const noexcept { return values[at]; }
};

constexpr std::size_t placeAt(std::size_t a, std::size_t b, std::size_t c) noexcept {
  return a + 3 * b + 9 * c;
}

/// Places whose coefficients depend on the corner at (0, 0, 0): at most one coordinate is 2.
constexpr std::array<std::array<std::size_t, 3>, kBezierTerms> kPlaces = {
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1},
     {1, 1, 1}, {2, 0, 0}, {2, 1, 0}, {2, 0, 1}, {2, 1, 1}, {0, 2, 0}, {1, 2, 0},
     {0, 2, 1}, {1, 2, 1}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}, {1, 1, 2}}};

HEXHEX_INLINE ByPlace<Number> determinantsOf(const mesh::CellEdges<Number>& edges) noexcept {
  const mesh::JacobianCoefficients<Number> all(edges);
  const std::array<Number, 4> upright = all.upright();
  const std::array<Number, 2> lying = all.lying();
  ByPlace<Number> b;
  b[placeAt(0, 0, 0)] = all.corners[0];
  b[placeAt(2, 0, 0)] = all.corners[1];
  b[placeAt(0, 2, 0)] = all.corners[2];
  b[placeAt(0, 0, 2)] = all.corners[4];
  b[placeAt(1, 0, 0)] = 0.5 * all.u[0];
  b[placeAt(1, 2, 0)] = 0.5 * all.u[1];
  b[placeAt(1, 0, 2)] = 0.5 * all.u[2];
  b[placeAt(0, 1, 0)] = 0.5 * all.v[0];
  b[placeAt(2, 1, 0)] = 0.5 * all.v[1];
  b[placeAt(0, 1, 2)] = 0.5 * all.v[2];
  b[placeAt(0, 0, 1)] = 0.5 * all.w[0];
  b[placeAt(2, 0, 1)] = 0.5 * all.w[1];
  b[placeAt(0, 2, 1)] = 0.5 * all.w[2];
  b[placeAt(1, 0, 1)] = 0.25 * upright[0];
  b[placeAt(1, 2, 1)] = 0.25 * upright[1];
  b[placeAt(0, 1, 1)] = 0.25 * upright[2];
  b[placeAt(2, 1, 1)] = 0.25 * upright[3];
  b[placeAt(1, 1, 0)] = 0.25 * lying[0];
  b[placeAt(1, 1, 2)] = 0.25 * lying[1];
  b[placeAt(1, 1, 1)] = 0.125 * all.centre(upright);
  return b;
}

/// Negated derivatives of the coefficients with respect to the corner at (0, 0, 0). Each
/// coefficient is a sum of triple products of edges (jacobian_lanes.hpp), of which only the first
/// edge along each axis depends on the corner. On faces and in the middle, the same sums hold as
/// for the coefficients themselves.
HEXHEX_INLINE ByPlace<Vector> normalsOf(const mesh::CellEdges<Number>& edges,
                                        const Vector& s) noexcept {
  const auto& [u, v, w] = edges;
  const Vector corner0 = scaled(s[0], cross(v[0], w[0])) + scaled(s[1], cross(w[0], u[0])) +
                         scaled(s[2], cross(u[0], v[0]));
  const Vector corner1 = scaled(s[0], cross(v[1], w[1]));
  const Vector corner2 = scaled(s[1], cross(w[2], u[1]));
  const Vector corner4 = scaled(s[2], cross(u[2], v[2]));
  // Twice those on edges.
  const Vector u0 = scaled(s[0], cross(v[0], w[1]) + cross(v[1], w[0])) +
                    scaled(s[1], cross(w[1], u[0])) + scaled(s[2], cross(u[0], v[1]));
  const Vector v0 = scaled(s[0], cross(v[0], w[2])) +
                    scaled(s[1], cross(w[2], u[0]) + cross(w[0], u[1])) +
                    scaled(s[2], cross(u[1], v[0]));
  const Vector w0 = scaled(s[0], cross(v[2], w[0])) + scaled(s[1], cross(w[0], u[2])) +
                    scaled(s[2], cross(u[0], v[2]) + cross(u[2], v[0]));
  const Vector u1 = scaled(s[1], cross(w[3], u[1]));
  const Vector u2 = scaled(s[2], cross(u[2], v[3]));
  const Vector v1 = scaled(s[0], cross(v[1], w[3]));
  const Vector v2 = scaled(s[2], cross(u[3], v[2]));
  const Vector w1 = scaled(s[0], cross(v[3], w[1]));
  const Vector w2 = scaled(s[1], cross(w[2], u[3]));
  // Four times those on faces.
  const Vector front = u0 + u2 + w0 + w1 - corner0 - corner1 - corner4;
  const Vector back = u1 + w2 - corner2;
  const Vector left = v0 + v2 + w0 + w2 - corner0 - corner2 - corner4;
  const Vector right = v1 + w1 - corner1;
  const Number half = Number{} + 0.5;
  const Number quarter = Number{} + 0.25;
  ByPlace<Vector> n;
  n[placeAt(0, 0, 0)] = corner0;
  n[placeAt(2, 0, 0)] = corner1;
  n[placeAt(0, 2, 0)] = corner2;
  n[placeAt(0, 0, 2)] = corner4;
  n[placeAt(1, 0, 0)] = scaled(half, u0);
  n[placeAt(1, 2, 0)] = scaled(half, u1);
  n[placeAt(1, 0, 2)] = scaled(half, u2);
  n[placeAt(0, 1, 0)] = scaled(half, v0);
  n[placeAt(2, 1, 0)] = scaled(half, v1);
  n[placeAt(0, 1, 2)] = scaled(half, v2);
  n[placeAt(0, 0, 1)] = scaled(half, w0);
  n[placeAt(2, 0, 1)] = scaled(half, w1);
  n[placeAt(0, 2, 1)] = scaled(half, w2);
  n[placeAt(1, 0, 1)] = scaled(quarter, front);
  n[placeAt(1, 2, 1)] = scaled(quarter, back);
  n[placeAt(0, 1, 1)] = scaled(quarter, left);
  n[placeAt(2, 1, 1)] = scaled(quarter, right);
  n[placeAt(1, 1, 0)] = scaled(quarter, u0 + u1 + v0 + v1 - corner0 - corner1 - corner2);
  n[placeAt(1, 1, 2)] = scaled(quarter, u2 + v2 - corner4);
  n[placeAt(1, 1, 1)] = scaled(0.5 * quarter, front + back + left + right - w0 - w1 - w2);
  return n;
}

/// One column of J at the nine places along the two other axes: its square, minus half the
/// derivative of that with respect to the corner, and half the second derivative.
struct alignas(TermLanes) Column {
  std::array<Number, 9> square;
  std::array<Vector, 9> slope;
  std::array<Number, 9> growth;

  /// @param edges  interpolated bilinearly
  HEXHEX_INLINE Column(const std::array<Vector, 4>& edges, const Number& scale) noexcept {
    const Number half = Number{} + 0.5;
    std::array<Vector, 9> at;
    at[0] = edges[0];
    at[2] = edges[1];
    at[6] = edges[2];
    at[8] = edges[3];
    for (const std::size_t row : {0U, 6U}) at[row + 1] = scaled(half, at[row] + at[row + 2]);
    for (std::size_t i = 0; i < 3; ++i) at[3 + i] = scaled(half, at[i] + at[6 + i]);
    constexpr std::array<double, 3> kWeights = {1, 0.5, 0};
    for (std::size_t i = 0; i < 9; ++i) {
      const Number weight = kWeights[i % 3] * kWeights[i / 3] * scale;
      square[i] = dot(at[i], at[i]);
      slope[i] = scaled(weight, at[i]);
      growth[i] = weight * weight;
    }
  }
};

HEXHEX_INLINE void bezierTermsOf(std::span<const MovingCell> list, TermLanes* terms) noexcept {
  const LaneCells cells = laneCells(list);
  const mesh::CellEdges<Number> edges = edgesOf(cells);
  const ByPlace<Number> determinants = determinantsOf(edges);
  const ByPlace<Vector> normals = normalsOf(edges, cells.scale);
  const Column u(edges.u, cells.scale[0]);
  const Column v(edges.v, cells.scale[1]);
  const Column w(edges.w, cells.scale[2]);
  for (std::size_t i = 0; i < kBezierTerms; ++i) {
    const auto [a, b, c] = kPlaces[i];
    const std::size_t bc = b + 3 * c;
    const std::size_t ac = a + 3 * c;
    const std::size_t ab = a + 3 * b;
    TermLanes& term = terms[i];
    term.square = u.square[bc] + v.square[ac] + w.square[ab];
    term.slope = Vector{} - u.slope[bc] - v.slope[ac] - w.slope[ab];
    term.growth = u.growth[bc] + v.growth[ac] + w.growth[ab];
    term.determinant = determinants[placeAt(a, b, c)];
    term.normal = Vector{} - normals[placeAt(a, b, c)];
    term.weight = cells.weight;
  }
}

}  // namespace

std::span<const EnergyKernels> energyKernels() noexcept {
  static constexpr std::array<EnergyKernels, 2> kBoth = {
      {{{cornerTermsOf, ownCornerTermsOf, bezierTermsOf}, energyOf, slopeOfAll},
       {{kWide<cornerTermsOf>, kWide<ownCornerTermsOf>, kWide<bezierTermsOf>},
        kWide<energyOf>,
        kWide<slopeOfAll>}}};
  return runnable(kBoth);
}

}  // namespace hexhex::improvement
