// Decided by the Bezier coefficients of the Jacobian determinant: a cell is positive if all of them
// are, and not positive if one at a corner is not; otherwise it is subdivided. This is the scheme
// of Johnen, Remacle and Geuzaine (Geometrical validity of curvilinear finite elements, 2013), for
// straight cells that of Johnen, Weill and Remacle (Robust and efficient validation of the linear
// hexahedral element, 2017). Signs are taken from doubles beyond an error bound, otherwise from
// integers.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>

#include <base/vector3.hpp>
#include <mesh/cell_validity.hpp>
#include <mesh/jacobian_quotient.hpp>

namespace hexhex::mesh {
namespace {

constexpr double kCellValidityRounding = std::numeric_limits<double>::epsilon() / 2;

/// Maximum number of parts of a cell. One random cell in a million takes more than 300; one that
/// takes them all, because the determinant vanishes along a surface, costs milliseconds.
constexpr std::size_t kMostParts = 4096;

/// The same for the search for a least scaled Jacobian.
constexpr std::size_t kMostPartsOfLeast = 256;

/// Beyond this order, whole determinants are not computed in integers, which would take seconds.
constexpr std::size_t kMostExactOrder = 3;

/// If columns are shorter than this after scaling, products leave the range of doubles.
constexpr double kShortest = 0x1p-200;

bool isAbove(double value, double error) { return value > error; }
bool isAbove(const BigInteger& value, double /*error*/) { return value.sign() > 0; }
bool isBelow(double value, double error) { return value <= -error; }
bool isBelow(const BigInteger& value, double /*error*/) { return value.sign() <= 0; }

std::size_t longestAxis(const CellPart& part) {
  return static_cast<std::size_t>(std::max_element(part.size.begin(), part.size.end()) -
                                  part.size.begin());
}

/// The axis along which the coefficients bend most: bounds differ from values by about as much.
std::size_t axisToHalve(const CellPart& /*part*/, const Bezier<double>& polynomial) {
  std::array<double, 3> bend{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t stride = polynomial.stride(axis);
    const auto& values = polynomial.values;
    forLines(polynomial, axis, [&](std::size_t at) {
      for (std::size_t k = 2; k < polynomial.size[axis]; ++k, at += stride) {
        bend[axis] = std::max(bend[axis], std::abs((values[at + 2 * stride] - values[at + stride]) -
                                                   (values[at + stride] - values[at])));
      }
    });
  }
  return static_cast<std::size_t>(std::max_element(bend.begin(), bend.end()) - bend.begin());
}
std::size_t axisToHalve(const CellPart& part, const Bezier<BigInteger>& /*polynomial*/) {
  return longestAxis(part);
}

/// @param error   of coefficients
/// @param growth  of the error, with each halving
template <class T>
CellCertificate divide(Bezier<T> whole, double error, double growth) {
  struct Piece {
    CellPart part;
    Bezier<T> polynomial;
    double error;
  };
  std::vector<Piece> pieces;
  pieces.push_back({{}, std::move(whole), error});
  for (std::size_t count = 0; !pieces.empty(); ++count) {
    const Piece piece = std::move(pieces.back());
    pieces.pop_back();
    const auto& values = piece.polynomial.values;
    const auto isPositive = [&](const T& value) { return isAbove(value, piece.error); };
    if (std::all_of(values.begin(), values.end(), isPositive)) continue;
    bool unclear = count >= kMostParts;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const T& value = values[piece.polynomial.cornerAt(corner)];
      if (isBelow(value, piece.error)) return {Validity::Refuted, -1, piece.part.corner(corner), 0};
      unclear = unclear || !isPositive(value);
    }
    if (unclear) return {Validity::Undecided, -1, {}, 0};
    const std::size_t axis = axisToHalve(piece.part, piece.polynomial);
    std::array<Bezier<T>, 2> both = halves(piece.polynomial, axis);
    for (std::size_t h = 2; h-- > 0;) {
      pieces.push_back({piece.part.half(axis, h), std::move(both[h]), piece.error + growth});
    }
  }
  return {Validity::Positive, -1, {}, 0};
}

Bezier<double> restricted(Bezier<double> polynomial, const Vec3& place) {
  std::vector<double> scratch;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t degree = polynomial.size[axis] - 1;
    const std::vector<std::int64_t> row = binomials(degree);
    Matrix<double> weights = {1, degree + 1, {}};
    for (std::size_t i = 0; i <= degree; ++i) {
      weights.entries.push_back(static_cast<double>(row[i]) *
                                std::pow(place[axis], static_cast<double>(i)) *
                                std::pow(1 - place[axis], static_cast<double>(degree - i)));
    }
    apply(weights, axis, polynomial, scratch);
  }
  return polynomial;
}

/// Approximate zero on an edge of a determinant of degree 2 that is positive at corners: there b0
/// b2 is at most b1^2, and b1 is negative. Subdivision would never end at a double root at 1/3.
std::optional<Vec3> zeroOnEdge(const Bezier<BigInteger>& exact, const Bezier<double>& rounded) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t stride = exact.stride(axis);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      if ((corner >> axis & 1U) != 0) continue;
      const std::size_t at = exact.cornerAt(corner);
      const BigInteger& middle = exact.values[at + stride];
      const BigInteger product = exact.values[at] * exact.values[at + 2 * stride];
      if (middle.sign() >= 0 || (middle * middle - product).sign() < 0) continue;
      Vec3 place = CellPart{}.corner(corner);
      const double slope = rounded.values[at] - rounded.values[at + stride];
      const double end = rounded.values[at + 2 * stride] - rounded.values[at + stride];
      const double along = slope / (slope + end);
      place[axis] = along >= 0 && along <= 1 ? along : 0.5;
      return place;
    }
  }
  return std::nullopt;
}

/// Nodes multiplied by a power of two that brings the largest coordinate near 1.
std::vector<Vec3> scaledNodes(std::span<const Vec3> nodes) {
  double largest = 0;
  for (const Vec3& node : nodes) {
    for (const double x : node) largest = std::max(largest, std::abs(x));
  }
  int exponent = 0;
  static_cast<void>(std::frexp(largest, &exponent));
  std::vector<Vec3> result(nodes.begin(), nodes.end());
  for (Vec3& node : result) {
    for (double& x : node) x = std::ldexp(x, -exponent);
  }
  return result;
}

/// The largest row sum of magnitudes.
double normOf(const Matrix<double>& matrix) {
  double norm = 0;
  for (std::size_t row = 0; row < matrix.rows; ++row) {
    double sum = 0;
    for (std::size_t column = 0; column < matrix.columns; ++column) {
      sum += std::abs(matrix.entries[row * matrix.columns + column]);
    }
    norm = std::max(norm, sum);
  }
  return norm;
}

}  // namespace

CellValidity::CellValidity(int order)
    : order_(static_cast<std::size_t>(order)),
      matrices_(nodeMatrices<double>(order_)),
      fineMatrices_(nodeMatrices<Twofold>(order_)),
      exactMatrices_(nodeMatrices<BigInteger>(order_)) {
  const double norm = normOf(matrices_.differences) * std::pow(normOf(matrices_.values), 2);
  // Three sums of at most ten products, each of which is accurate to within 2^-98.
  conversionError_ = order_ == 1 ? 0 : 0x1p-92 * norm;
}

template <class T>
Columns<T> CellValidity::columnsOf(const std::vector<std::array<T, 3>>& nodes,
                                   const NodeMatrices<T>& matrices) const {
  Columns<T> columns;
  std::vector<T> scratch;
  const std::size_t n = order_ + 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < 3; ++k) {
      Bezier<T>& grid = columns[axis][k];
      grid.size = {n, n, n};
      const std::size_t stride = grid.stride(axis);
      grid.size[axis] = order_;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (i / stride % n < order_) grid.values.push_back(nodes[i + stride][k] - nodes[i][k]);
      }
      if (order_ == 1) continue;  // the matrices are 1
      for (std::size_t a = 0; a < 3; ++a) {
        apply(a == axis ? matrices.differences : matrices.values, a, grid, scratch);
      }
    }
  }
  return columns;
}

Columns<double> CellValidity::roundedColumnsOf(const std::vector<Vec3>& nodes) const {
  if (order_ == 1) return columnsOf(nodes, matrices_);
  std::vector<std::array<Twofold, 3>> fineNodes;
  fineNodes.reserve(nodes.size());
  for (const Vec3& node : nodes) fineNodes.push_back({{{node[0], 0}, {node[1], 0}, {node[2], 0}}});
  const Columns<Twofold> fine = columnsOf(fineNodes, fineMatrices_);
  Columns<double> columns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < 3; ++k) {
      columns[axis][k].size = fine[axis][k].size;
      for (const Twofold& value : fine[axis][k].values)
        columns[axis][k].values.push_back(value.high);
    }
  }
  return columns;
}

CellValidity::Form CellValidity::formOf(std::span<const Vec3> nodes) const {
  Form form;
  const std::vector<Vec3> scaled = scaledNodes(nodes);
  form.columns = roundedColumnsOf(scaled);
  form.determinant = determinantOf(form.columns);
  for (const double value : form.determinant.values)
    form.size = std::max(form.size, std::abs(value));

  // Largest components of columns, with their errors.
  std::array<double, 3> largest{};
  std::array<double, 3> errors{};
  const std::size_t n = order_ + 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t stride = axis == 0 ? 1 : (axis == 1 ? n : n * n);
    double difference = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (i / stride % n == order_) continue;
      const Vec3 d = minus(scaled[i + stride], scaled[i]);
      for (const double x : d) difference = std::max(difference, std::abs(x));
    }
    const auto& [x, y, z] = form.columns[axis];
    double longest = 0;
    for (std::size_t i = 0; i < x.values.size(); ++i) {
      const Vec3 column = {x.values[i], y.values[i], z.values[i]};
      for (const double c : column) largest[axis] = std::max(largest[axis], std::abs(c));
      longest = std::max(longest, length(column));
    }
    errors[axis] = kCellValidityRounding * largest[axis] + conversionError_ * difference;
    form.largestLengths *= (1 + 16 * kCellValidityRounding) * (longest + 2 * errors[axis]);
    largest[axis] += errors[axis];
    if (largest[axis] < kShortest) form.error = std::numeric_limits<double>::infinity();
  }
  // A coefficient is a mean of determinants of six products of components each. Sums have at most
  // (p + 1)^3 terms twice, and 40 exceeds all other roundings; doubled for safety.
  const double terms = 2 * std::pow(static_cast<double>(n), 3) + 40;
  const double product = largest[0] * largest[1] * largest[2];
  form.error += 2 * 6 *
                (terms * kCellValidityRounding * product + errors[0] * largest[1] * largest[2] +
                 largest[0] * errors[1] * largest[2] + largest[0] * largest[1] * errors[2]);
  return form;
}

CellCertificate CellValidity::decide(std::span<const Vec3> nodes, const Form& form) const {
  const double growth = static_cast<double>(3 * order_ + 2) * kCellValidityRounding * form.size;
  CellCertificate result = {Validity::Undecided, -1, {}, 0};
  if (std::isfinite(form.error)) result = divide(form.determinant, form.error, growth);
  if (result.validity == Validity::Undecided) result = decideExactly(nodes, form);
  if (result.validity == Validity::Refuted) {
    Vec3 lengths{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Vec3 column{};
      for (std::size_t k = 0; k < 3; ++k) {
        column[k] = restricted(form.columns[axis][k], result.place).values[0];
      }
      lengths[axis] = length(column);
    }
    const double value = restricted(form.determinant, result.place).values[0];
    result.scaledJacobian =
        std::min(0.0, scaledDeterminant(value, lengths[0] * lengths[1] * lengths[2]));
  }
  return result;
}

CellCertificate CellValidity::decideExactly(std::span<const Vec3> nodes, const Form& form) const {
  // All coordinates as multiples of the lowest bit of any.
  int shift = std::numeric_limits<int>::min();
  for (const Vec3& node : nodes) {
    for (const double x : node) {
      if (x == 0) continue;
      int exponent = 0;
      const double fraction = std::frexp(x, &exponent);
      const auto bits = static_cast<std::uint64_t>(std::ldexp(std::abs(fraction), 53));
      shift = std::max(shift, 53 - exponent - std::countr_zero(bits));
    }
  }
  std::vector<std::array<BigInteger, 3>> integers;
  for (const Vec3& node : nodes) {
    integers.push_back(
        {BigInteger(node[0], shift), BigInteger(node[1], shift), BigInteger(node[2], shift)});
  }
  const Columns<BigInteger> columns = columnsOf(integers, exactMatrices_);
  for (std::size_t corner = 0; corner < 8; ++corner) {  // most cells that get here are flat there
    Columns<BigInteger> there;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Bezier<BigInteger>& all = columns[axis][k];
        there[axis][k] = {{1, 1, 1}, {all.values[all.cornerAt(corner)]}};
      }
    }
    if (determinantOf(there).values[0].sign() > 0) continue;
    return {Validity::Refuted, -1, CellPart{}.corner(corner), 0};
  }
  if (order_ > kMostExactOrder) return {Validity::Undecided, -1, {}, 0};
  Bezier<BigInteger> determinant = determinantOf(columns);
  if (order_ == 1) {
    if (const std::optional<Vec3> zero = zeroOnEdge(determinant, form.determinant)) {
      return {Validity::Refuted, -1, *zero, 0};
    }
  }
  return divide(std::move(determinant), 0, 0);
}

CellCertificate CellValidity::examine(std::span<const Vec3> nodes, Form& form) const {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (isFinite(nodes[i])) continue;
    form.error = std::numeric_limits<double>::infinity();
    const auto p = static_cast<double>(order_);
    const std::size_t n = order_ + 1;
    const std::array<std::size_t, 3> at = {i % n, i / n % n, i / n / n};
    CellCertificate result = {Validity::Refuted, -1, {}, 0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.place[axis] = static_cast<double>(at[axis]) / p;
    }
    return result;
  }
  form = formOf(nodes);
  CellCertificate result = decide(nodes, form);
  if (std::isfinite(form.error)) {
    const double least = leastOf(form.determinant) - form.error;
    if (least > 0) result.minimum = scaledDeterminant(least, form.largestLengths);
  }
  return result;
}

CellCertificate CellValidity::examine(std::span<const Vec3> nodes) const {
  Form form;
  return examine(nodes, form);
}

CellCertificate CellValidity::findLeast(std::span<const Vec3> nodes, double target) const {
  Form form;
  CellCertificate result = examine(nodes, form);
  if (!std::isfinite(form.error)) return result;
  if (result.validity != Validity::Refuted) result.scaledJacobian = 1;

  // Sums of as many products as a convolution has, in the squares and in their products, of columns
  // whose lengths are also off by a few roundings.
  const double rounding =
      64 * static_cast<double>(form.determinant.values.size()) * kCellValidityRounding;
  const double growth = static_cast<double>(3 * order_ + 2) * kCellValidityRounding * form.size;
  const auto isLess = [](const JacobianQuotient& a, const JacobianQuotient& b) {
    return a.bound > b.bound;
  };
  std::priority_queue<JacobianQuotient, std::vector<JacobianQuotient>, decltype(isLess)> parts(
      isLess);
  const auto add = [&](JacobianQuotient quotient, double error) {
    quotient.error = error;
    quotient.close(rounding);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const double value = quotient.determinant.values[quotient.determinant.cornerAt(corner)];
      const double lengths = quotient.lengths.values[quotient.lengths.cornerAt(corner)];
      const double scaled = scaledDeterminant(value, std::sqrt(lengths));
      if (scaled >= result.scaledJacobian) continue;
      // The place reported for a refuted cell must be certainly bad.
      if (result.validity == Validity::Refuted && value >= -error) continue;
      result.scaledJacobian = scaled;
      result.place = quotient.part.corner(corner);
    }
    parts.push(std::move(quotient));
  };
  add({{},
       form.determinant,
       productOf(form.determinant, form.determinant),
       productOf(productOf(squareOf(form.columns[0]), squareOf(form.columns[1])),
                 squareOf(form.columns[2])),
       0,
       -1},
      form.error);
  const std::size_t most = kMostPartsOfLeast / (order_ * order_);
  for (std::size_t count = 0;; ++count) {
    const JacobianQuotient& worst = parts.top();
    result.minimum = worst.bound;
    const double wanted = std::min(target, result.scaledJacobian) - kMinimumTolerance;
    if (worst.bound >= wanted || count >= most) return result;
    const double error = worst.error + growth;
    std::array<JacobianQuotient, 2> halves = worst.halved(longestAxis(worst.part));
    parts.pop();
    for (JacobianQuotient& half : halves) add(std::move(half), error);
  }
}

Vec3 CellValidity::pointAt(std::span<const Vec3> nodes, const Vec3& place) const {
  const std::size_t n = order_ + 1;
  Vec3 point{};
  std::vector<double> scratch;
  for (std::size_t k = 0; k < 3; ++k) {
    Bezier<double> grid = {{n, n, n}, {}};
    for (const Vec3& node : nodes) grid.values.push_back(node[k]);
    for (std::size_t axis = 0; axis < 3 && order_ > 1; ++axis) {
      apply(matrices_.values, axis, grid, scratch);
    }
    point[k] = restricted(std::move(grid), place).values[0];
  }
  return point;
}

}  // namespace hexhex::mesh
