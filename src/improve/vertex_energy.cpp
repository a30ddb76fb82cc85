#include <algorithm>
#include <cmath>
#include <limits>

#include <base/vector3.hpp>
#include <improve/vertex_energy.hpp>

namespace hexhex {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// 1 / |1|^3: of the ideal shape, the energy is 1.
constexpr double kUnit = 0.19245008972987526;  // 1 / (3 sqrt(3))

double powered(double x, int power) noexcept {
  for (; power > 1; power /= 2) x *= x;
  return x;
}

/// chi, and its derivative by the determinant.
struct Chi {
  double value;
  double slope;
  Chi(double epsilon, double det) noexcept {
    const double root = std::sqrt(epsilon * epsilon + det * det);
    value = det > 0 ? 0.5 * (det + root) : 0.5 * epsilon * epsilon / (root - det);
    slope = root > 0 ? value / root : 0;
  }
};

double shapeOf(double square, double chi) noexcept {
  return kUnit * square * std::sqrt(square) / chi;
}

void addOuter(double factor, const Vec3& a, std::array<double, 6>& matrix) noexcept {
  matrix[0] += factor * a[0] * a[0];
  matrix[1] += factor * a[0] * a[1];
  matrix[2] += factor * a[0] * a[2];
  matrix[3] += factor * a[1] * a[1];
  matrix[4] += factor * a[1] * a[2];
  matrix[5] += factor * a[2] * a[2];
}

/// a b^T + b a^T
void addMixed(double factor, const Vec3& a, const Vec3& b, std::array<double, 6>& matrix) noexcept {
  matrix[0] += 2 * factor * a[0] * b[0];
  matrix[1] += factor * (a[0] * b[1] + a[1] * b[0]);
  matrix[2] += factor * (a[0] * b[2] + a[2] * b[0]);
  matrix[3] += 2 * factor * a[1] * b[1];
  matrix[4] += factor * (a[1] * b[2] + a[2] * b[1]);
  matrix[5] += 2 * factor * a[2] * b[2];
}

void addSlope(const EnergyTerm& term, const EnergyKind& kind, EnergySlope& sum) noexcept {
  const Chi chi(kind.epsilon, term.determinant);
  const double root = std::sqrt(term.square);
  const double f = kUnit * term.square * root / chi.value;
  // By q = |J|^2 and by the determinant.
  const double byQ = 1.5 * f / term.square;
  const double byDet = -f * chi.slope / chi.value;
  const double byQQ = 0.5 * byQ / term.square;
  const double byQDet = -byQ * chi.slope / chi.value;
  const double byDetDet = -2 * byDet * chi.slope / chi.value;
  const double outer = kind.power * powered(f, kind.power) / f;
  const double curvature = outer * (kind.power - 1) / f;
  double gradientQ = outer * byQ;
  double gradientDet = outer * byDet;
  double qq = outer * byQQ + curvature * byQ * byQ;
  double qDet = outer * byQDet + curvature * byQ * byDet;
  double detDet = outer * byDetDet + curvature * byDet * byDet;
  sum.energy += powered(f, kind.power);
  if (kind.volume > 0) {
    const double det = term.determinant;
    const double numerator = det * det + 1;
    sum.energy += kind.volume * numerator / chi.value;
    gradientDet += kind.volume * (2 * det - numerator * chi.slope / chi.value) / chi.value;
    // (det^2 + 1) / chi is convex in det where chi is linear; elsewhere a part that is.
    const double a = 1 - det * chi.slope / chi.value;
    const double b = chi.slope / chi.value;
    detDet += kind.volume * 2 * (a * a + b * b) / chi.value;
  }
  const Vec3 q = times(2, term.slope);
  for (std::size_t k = 0; k < 3; ++k) {
    sum.gradient[k] += gradientQ * q[k] + gradientDet * term.normal[k];
  }
  addOuter(qq, q, sum.hessian);
  addMixed(qDet, q, term.normal, sum.hessian);
  addOuter(detDet, term.normal, sum.hessian);
  const double diagonal = 2 * gradientQ * term.growth;
  sum.hessian[0] += diagonal;
  sum.hessian[3] += diagonal;
  sum.hessian[5] += diagonal;
}

Vec3 applied(const std::array<double, 6>& m, const Vec3& x) noexcept {
  return {m[0] * x[0] + m[1] * x[1] + m[2] * x[2], m[1] * x[0] + m[3] * x[1] + m[4] * x[2],
          m[2] * x[0] + m[4] * x[1] + m[5] * x[2]};
}

/// The edge at a place along an axis, in the direction of that axis.
Vec3 edgeAt(const std::array<Vec3, 8>& corners, std::size_t place, std::size_t axis) noexcept {
  const std::size_t bit = std::size_t{1} << axis;
  return minus(corners[place | bit], corners[place & ~bit]);
}

/// The weight of a corner at a place 0, 1/2 or 1 along an axis.
double weightAt(std::size_t corner, std::size_t axis, std::size_t at) noexcept {
  const double along = 0.5 * static_cast<double>(at);
  return (corner >> axis & 1U) != 0 ? along : 1 - along;
}

/// From the values at 0, 1/2 and 1 along an axis to Bezier coefficients.
void toBezier(std::array<EnergyTerm, 27>& terms, std::size_t stride) noexcept {
  for (std::size_t at = 0; at < 27; ++at) {
    if (at / stride % 3 != 1) continue;
    const EnergyTerm& before = terms[at - stride];
    const EnergyTerm& after = terms[at + stride];
    const auto middle = [](double m, double a, double b) { return 2 * m - 0.5 * (a + b); };
    terms[at].determinant = middle(terms[at].determinant, before.determinant, after.determinant);
    for (std::size_t k = 0; k < 3; ++k) {
      terms[at].normal[k] = middle(terms[at].normal[k], before.normal[k], after.normal[k]);
    }
  }
}

}  // namespace

double EnergyTerm::squareAt(const Vec3& d) const noexcept {
  return square + 2 * dot(slope, d) + growth * dot(d, d);
}
double EnergyTerm::determinantAt(const Vec3& d) const noexcept {
  return determinant + dot(normal, d);
}

double energyAt(const std::vector<EnergyTerm>& terms, const EnergyKind& kind,
                const Vec3& step) noexcept {
  double sum = 0;
  for (const EnergyTerm& term : terms) {
    const double det = term.determinantAt(step);
    if (kind.epsilon == 0 && !(det > 0)) return kInfinity;
    const double chi = kind.epsilon == 0 ? det : Chi(kind.epsilon, det).value;
    sum += powered(shapeOf(term.squareAt(step), chi), kind.power);
    if (kind.volume > 0) sum += kind.volume * (det * det + 1) / chi;
  }
  return sum;
}

EnergySlope slopeOf(const std::vector<EnergyTerm>& terms, const EnergyKind& kind) noexcept {
  EnergySlope sum;
  for (const EnergyTerm& term : terms) addSlope(term, kind, sum);
  return sum;
}

Vec3 newtonStep(const EnergySlope& slope, std::span<const Vec3> directions) noexcept {
  const std::size_t count = directions.size();
  // Cholesky's factors of the matrix in these directions, lifted a little off singular ones.
  std::array<std::array<double, 3>, 3> a{};
  Vec3 right{};
  double trace = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 column = applied(slope.hessian, directions[i]);
    for (std::size_t j = 0; j <= i; ++j) a[i][j] = dot(column, directions[j]);
    right[i] = -dot(slope.gradient, directions[i]);
    trace += a[i][i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    a[i][i] += 1e-10 * trace;
    for (std::size_t j = 0; j <= i; ++j) {
      for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      if (j < i) a[i][j] /= a[j][j];
    }
    if (!(a[i][i] > 0)) return {};
    a[i][i] = std::sqrt(a[i][i]);
    for (std::size_t k = 0; k < i; ++k) right[i] -= a[i][k] * right[k];
    right[i] /= a[i][i];
  }
  for (std::size_t i = count; i-- > 0;) {
    for (std::size_t k = i + 1; k < count; ++k) right[i] -= a[k][i] * right[k];
    right[i] /= a[i][i];
  }
  Vec3 step{};
  for (std::size_t i = 0; i < count; ++i) step = plus(step, times(right[i], directions[i]));
  return step;
}

IdealBox idealBox(const Vec3& lengths) noexcept {
  constexpr double kThinnest = 1e-4;
  const double longest = std::max({lengths[0], lengths[1], lengths[2]});
  IdealBox box{};
  for (std::size_t k = 0; k < 3; ++k) {
    box[k] = static_cast<float>(longest > 0 ? std::max(lengths[k], kThinnest * longest) : 1);
  }
  return box;
}

EnergyTerm termOf(const std::array<Vec3, 3>& columns, const Vec3& weights) noexcept {
  const std::array<Vec3, 3> cofactors = {
      cross(columns[1], columns[2]), cross(columns[2], columns[0]), cross(columns[0], columns[1])};
  EnergyTerm term;
  term.determinant = dot(columns[0], cofactors[0]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    term.square += dot(columns[axis], columns[axis]);
    for (std::size_t k = 0; k < 3; ++k) {
      term.slope[k] += weights[axis] * columns[axis][k];
      term.normal[k] += weights[axis] * cofactors[axis][k];
    }
    term.growth += weights[axis] * weights[axis];
  }
  return term;
}

void addCornerTerms(const std::array<Vec3, 8>& corners, std::size_t moving, const IdealBox& box,
                    std::vector<EnergyTerm>& terms) {
  const Vec3 scale = {1.0 / box[0], 1.0 / box[1], 1.0 / box[2]};
  for (std::size_t neighbour = 0; neighbour <= 3; ++neighbour) {
    // The corner itself, then those across an edge of it.
    const std::size_t place =
        neighbour == 0 ? moving : moving ^ (std::size_t{1} << (neighbour - 1));
    std::array<Vec3, 3> edges;
    Vec3 weights{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      edges[axis] = times(scale[axis], edgeAt(corners, place, axis));
      if (neighbour != 0 && axis != neighbour - 1) continue;
      weights[axis] = (moving >> axis & 1U) != 0 ? scale[axis] : -scale[axis];
    }
    terms.push_back(termOf(edges, weights));
  }
}

void addBezierTerms(const std::array<Vec3, 8>& corners, std::size_t moving, const IdealBox& box,
                    std::vector<EnergyTerm>& terms) {
  const Vec3 scale = {1.0 / box[0], 1.0 / box[1], 1.0 / box[2]};
  std::array<EnergyTerm, 27> all;
  for (std::size_t at = 0; at < 27; ++at) {
    const std::array<std::size_t, 3> place = {at % 3, at / 3 % 3, at / 9};
    std::array<Vec3, 3> columns{};
    Vec3 weights{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t bit = std::size_t{1} << axis;
      const auto weightOf = [&](std::size_t corner) {
        const std::size_t b = (axis + 1) % 3;
        const std::size_t c = (axis + 2) % 3;
        return scale[axis] * weightAt(corner, b, place[b]) * weightAt(corner, c, place[c]);
      };
      for (std::size_t corner = 0; corner < 8; ++corner) {
        if ((corner & bit) != 0) continue;
        const double weight = weightOf(corner);
        const Vec3 edge = minus(corners[corner | bit], corners[corner]);
        for (std::size_t k = 0; k < 3; ++k) columns[axis][k] += weight * edge[k];
      }
      weights[axis] = (moving & bit) != 0 ? weightOf(moving) : -weightOf(moving);
    }
    all[at] = termOf(columns, weights);
  }
  for (const std::size_t stride : {1U, 3U, 9U}) toBezier(all, stride);
  for (const EnergyTerm& term : all) {
    if (term.growth > 0) terms.push_back(term);
  }
}

}  // namespace hexhex
