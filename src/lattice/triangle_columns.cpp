// Conservative rasterization of a triangle, column by column (for the atlas engine; not in the
// paper).
#include <bit>
#include <limits>

#include <lattice/triangle_columns.hpp>

namespace hexhex::lattice {

TriangleColumns::TriangleColumns(const std::array<LatticePoint, 3>& corners,
                                 std::int64_t unit) noexcept {
  const int shift = std::countr_zero(static_cast<std::uint64_t>(unit));
  const double scale = 1.0 / static_cast<double>(unit);
  const LatticePoint a = corners[1] - corners[0];
  const LatticePoint b = corners[2] - corners[0];
  std::array<double, 3> normal{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    // Exact before rounding: the slopes below are as good as doubles get, even for thin triangles.
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
    const std::int64_t origin = std::int64_t{origin_[k]} << shift;
    first_[k] = firstHalfCell(low - origin, shift);
    last_[k] = lastHalfCell(high - origin, shift);
    for (std::size_t i = 0; i < 3; ++i) {
      p_[i][k] = static_cast<double>(corners[i][axis] - origin) * scale;
      extent = std::max(extent, std::abs(p_[i][k]));
    }
  }
  plane_[1] = -normal[axes_[0]] / normal[axes_[2]];
  plane_[2] = -normal[axes_[1]] / normal[axes_[2]];
  plane_[0] = p_[0][2] - plane_[1] * p_[0][0] - plane_[2] * p_[0][1];
  // Coordinates are below `extent` and slopes at most 1; about ten roundings each.
  margin_ = 0x1p-46 * extent;
}

std::array<double, 2> TriangleColumns::strip(std::int32_t u) const noexcept {
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
      // The intersection lies between the ends, however badly the quotient is rounded.
      const double t = std::clamp((border - p[0]) / (q[0] - p[0]), 0.0, 1.0);
      const double slack = margin_ * (1 + std::abs(q[1] - p[1]) / std::abs(q[0] - p[0]));
      const double v = p[1] + t * (q[1] - p[1]);
      include(std::max(v - slack, std::min(p[1], q[1])));
      include(std::min(v + slack, std::max(p[1], q[1])));
    }
  }
  return {low - margin_, high + margin_};
}

TriangleColumns::Column TriangleColumns::columnAt(std::int32_t u, std::int32_t v) const noexcept {
  // Heights in half cells: at the centre of the column, their differences at the centres of its
  // quarters, and how much they vary within a quarter.
  const double middle = 2 * (plane_[0] + plane_[1] * (u + 0.5) + plane_[2] * (v + 0.5));
  const double sum = (plane_[1] + plane_[2]) / 2;
  const double difference = (plane_[1] - plane_[2]) / 2;
  const double spread = (std::abs(plane_[1]) + std::abs(plane_[2])) / 2 + 8 * margin_;
  const std::array<double, 4> heights = {middle - sum, middle + difference, middle + sum,
                                         middle - difference};
  const auto half = [](double height, std::int32_t low, std::int32_t high) {
    return static_cast<std::int32_t>(std::min<double>(std::max<double>(height, low), high));
  };
  std::array<std::int32_t, 4> first;
  std::array<std::int32_t, 4> count;
  Column column{last_[2], 0};
  for (std::size_t i = 0; i < 4; ++i) {
    first[i] = half(heights[i] - spread, first_[2], last_[2] + 1);
    count[i] = half(heights[i] + spread, first_[2] - 1, last_[2]) + 1 - first[i];
    column.lowest = std::min(column.lowest, first[i]);
  }
  column.lowest >>= 1;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::int32_t halfU = 2 * u + kCellCorners[i][0];
    const std::int32_t halfV = 2 * v + kCellCorners[i][1];
    const bool inBox =
        halfU >= first_[0] && halfU <= last_[0] && halfV >= first_[1] && halfV <= last_[1];
    if (count[i] <= 0 || !inBox) continue;
    // Four bits per layer of half cells, one of them for this quarter. The plane rises by at most
    // two cells in a column, so there are fewer than 16 layers.
    constexpr std::uint64_t kOnePerLayer = 0x1111'1111'1111'1111;
    const std::uint64_t layers = kOnePerLayer >> (64 - 4 * count[i]);
    column.octants |= layers << (4 * (first[i] - 2 * column.lowest) + static_cast<int>(i));
  }
  return column;
}

}  // namespace hexhex::lattice
