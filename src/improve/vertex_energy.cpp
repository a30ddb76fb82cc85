#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <base/vector3.hpp>
#include <improve/energy_kernels.hpp>
#include <improve/vertex_energy.hpp>

namespace hexhex::improvement {

namespace {

/// The kernels for the widest registers.
const EnergyKernels& kernels() noexcept {
  static const EnergyKernels& widest = energyKernels().back();
  return widest;
}

Vec3 applied(const std::array<double, 6>& m, const Vec3& x) noexcept {
  return {m[0] * x[0] + m[1] * x[1] + m[2] * x[2], m[1] * x[0] + m[3] * x[1] + m[4] * x[2],
          m[2] * x[0] + m[4] * x[1] + m[5] * x[2]};
}

}  // namespace

TermLanes* EnergyTerms::add(std::size_t blocks) {
  const std::size_t first = size_;
  size_ += blocks;
  if (size_ > blocks_.size()) blocks_.resize(size_);
  return blocks_.data() + first;
}

void EnergyTerms::addCells(std::span<const MovingCell> cells, TermKind kind) {
  const auto at = static_cast<std::size_t>(kind);
  for (std::size_t first = 0; first < cells.size(); first += TermLanes::kCount) {
    const auto some = cells.subspan(first, std::min(TermLanes::kCount, cells.size() - first));
    kernels().terms[at](some, add(kTermCounts[at]));
  }
}

double EnergyTerms::leastDeterminantAt(const Vec3& step) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (const TermLanes& block : blocks()) {
    for (std::size_t lane = 0; lane < TermLanes::kCount; ++lane) {
      if (block.weight[lane] == 0) continue;
      double determinant = block.determinant[lane];
      for (std::size_t k = 0; k < 3; ++k) determinant += block.normal[k][lane] * step[k];
      least = std::min(least, determinant);
    }
  }
  return least;
}

double energyAt(const EnergyTerms& terms, const EnergyKind& kind, const Vec3& step) noexcept {
  return kernels().energy(terms.blocks(), kind, step);
}

EnergySlope slopeOf(const EnergyTerms& terms, const EnergyKind& kind) noexcept {
  EnergySlope slope;
  kernels().slope(terms.blocks(), kind, slope);
  return slope;
}

Vec3 newtonStep(const EnergySlope& slope, std::span<const Vec3> directions) noexcept {
  const std::size_t count = directions.size();
  // Cholesky factorization of the Hessian in these directions, shifted slightly away from singular
  // ones.
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
  for (std::size_t i = count; i > 0;) {
    --i;
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

MovingCell movingCell(const std::array<const Vec3*, 8>& corners, std::size_t moving,
                      const IdealBox& box) noexcept {
  // Mirroring along an odd number of axes would invert the cell: then, two axes are swapped.
  const bool isOdd = (std::popcount(moving) & 1) != 0;
  constexpr std::array<std::size_t, 8> kExchanged = {0, 2, 1, 3, 4, 6, 5, 7};
  MovingCell cell;
  for (std::size_t place = 0; place < 8; ++place) {
    cell.corners[place] = corners[(isOdd ? kExchanged[place] : place) ^ moving];
  }
  cell.scale = {1.0 / box[isOdd ? 1 : 0], 1.0 / box[isOdd ? 0 : 1], 1.0 / box[2]};
  return cell;
}

}  // namespace hexhex::improvement
