#include <bit>
#include <limits>

#include <lattice/triangle_cells.hpp>

namespace hexhex {

TriangleCells::TriangleCells(const std::array<LatticePoint, 3>& corners,
                             std::int64_t unit) noexcept {
  const int shift = std::countr_zero(static_cast<std::uint64_t>(unit));
  const double scale = 1.0 / static_cast<double>(unit);
  const LatticePoint a = corners[1] - corners[0];
  const LatticePoint b = corners[2] - corners[0];
  std::array<double, 3> normal{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    // Exact before rounding: the slopes below are as good as doubles get, even of thin triangles.
    normal[k] = signedToDouble(static_cast<Int128>(a[i]) * b[j] - static_cast<Int128>(a[j]) * b[i]);
  }
  std::uint8_t steepest = 0;
  for (std::uint8_t k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[steepest])) steepest = k;
  }
  axes_ = {static_cast<std::uint8_t>((steepest + 1) % 3),
           static_cast<std::uint8_t>((steepest + 2) % 3), steepest};
  double extent = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint8_t axis = axes_[k];
    const auto [low, high] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
    origin_[k] = static_cast<std::int32_t>(low >> shift);
    first_[k] = 0;
    // Open cells below `high`: floor of it, or one less if it is an integer.
    last_[k] = static_cast<std::int32_t>((high - 1) >> shift) - origin_[k];
    for (std::size_t i = 0; i < 3; ++i) {
      p_[i][k] =
          static_cast<double>(corners[i][axis] - (std::int64_t{origin_[k]} << shift)) * scale;
      extent = std::max(extent, std::abs(p_[i][k]));
    }
  }
  plane_[1] = -normal[axes_[0]] / normal[axes_[2]];
  plane_[2] = -normal[axes_[1]] / normal[axes_[2]];
  plane_[0] = p_[0][2] - plane_[1] * p_[0][0] - plane_[2] * p_[0][1];
  // Coordinates are below `extent` and slopes at most 1; some ten roundings each.
  margin_ = 0x1p-46 * extent;
}

std::array<double, 2> TriangleCells::strip(std::int32_t u) const noexcept {
  const double left = u - margin_;
  const double right = u + 1 + margin_;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const auto include = [&](double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& p = p_[i];
    const auto& q = p_[(i + 1) % 3];
    if (p[0] >= left && p[0] <= right) include(p[1]);
    for (const double border : {left, right}) {
      if ((p[0] < border) == (q[0] < border)) continue;
      // The crossing lies between the ends, however badly the quotient is rounded.
      const double t = std::clamp((border - p[0]) / (q[0] - p[0]), 0.0, 1.0);
      const double slack = margin_ * (1 + std::abs(q[1] - p[1]) / std::abs(q[0] - p[0]));
      const double v = p[1] + t * (q[1] - p[1]);
      include(std::max(v - slack, std::min(p[1], q[1])));
      include(std::min(v + slack, std::max(p[1], q[1])));
    }
  }
  return {low - margin_, high + margin_};
}

std::array<double, 2> TriangleCells::column(std::int32_t u, std::int32_t v) const noexcept {
  const double middle = plane_[0] + plane_[1] * (u + 0.5) + plane_[2] * (v + 0.5);
  const double half = (std::abs(plane_[1]) + std::abs(plane_[2])) / 2 + 4 * margin_;
  return {middle - half, middle + half};
}

}  // namespace hexhex
