#include <algorithm>
#include <bit>
#include <cmath>

#include <lattice/half_grids.hpp>

namespace hexhex {

void HalfGrids::prepare() noexcept {
  prepared_ = true;
  const double scale = 1.0 / static_cast<double>(unit_);
  const int shift = std::countr_zero(static_cast<std::uint64_t>(unit_));
  std::array<std::array<double, 3>, 4> c;
  double size = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t grid = corners_[0][k] >> shift;
    nearby_[k] = static_cast<double>(grid);
    for (std::size_t i = 0; i < 4; ++i) {
      c[i][k] = static_cast<double>(corners_[i][k] - grid * unit_) * scale;
      size = std::max(size, std::abs(c[i][k]));
    }
  }
  corner_ = c[0];
  std::array<std::array<double, 3>, 3> e;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) e[i][k] = c[i + 1][k] - c[0][k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t m = k == 2 ? 0 : k + 1;
    const std::size_t n = k == 0 ? 2 : k - 1;
    std::array<double, 4>& gradient = gradients_[k];
    gradient[1] = e[1][m] * e[2][n] - e[1][n] * e[2][m];
    gradient[2] = e[2][m] * e[0][n] - e[2][n] * e[0][m];
    gradient[3] = e[0][m] * e[1][n] - e[0][n] * e[1][m];
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);
  }
  volume_ = e[0][0] * gradients_[0][1] + e[0][1] * gradients_[1][1] + e[0][2] * gradients_[2][1];
  // Errors in units of 2^-53: coordinates carry one rounding, so differences of two, of up to
  // 2 size, are known to 4 size; their products to 20 size^2, gradients 1 to 3 (up to 8 size^2) to
  // 48 size^2, and gradient 0 (24 size^2) to 184 size^2. Products of gradients with coordinates of
  // points in the bounding box (48 size^3) are known to 512 size^3, and so is the volume. The sum
  // of three of them and the volume is off by less than 4 * 512 + 432 < 2^12 size^3. 2^13 covers
  // terms of second order as well.
  error_ = 0x1p-40 * size * size * size;
}

bool HalfGrids::tryPoints(const GridBox& box, const MovedAxes& moved, SweepAxes order) noexcept {
  if (!prepared_) prepare();
  const std::array<std::uint8_t, 3>& axes = order();
  std::array<GridRange, 3> ranges;
  std::array<double, 3> zero;  // of coordinates relative to corner 0, by sweep axis
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t axis = axes[k];
    ranges[k] = box.range[axis];
    zero[k] = (moved[axis] ? 0.5 : 0.0) - nearby_[axis];
  }
  tried_ = 0;
  for (std::int32_t level = ranges[0].first; level <= ranges[0].last; ++level) {
    const double x = level + zero[0] - corner_[axes[0]];
    for (std::int32_t row = ranges[1].first; row <= ranges[1].last; ++row) {
      const double y = row + zero[1] - corner_[axes[1]];
      std::array<double, 4> base = {volume_, 0, 0, 0};
      for (std::size_t i = 0; i < 4; ++i) {
        base[i] += gradients_[axes[0]][i] * x + gradients_[axes[1]][i] * y;
      }
      SweptLine line{level, row, 0, 0, kWholeTet, kWholeTet, order};
      for (std::int32_t point = ranges[2].first; point <= ranges[2].last; ++point) {
        const double z = point + zero[2] - corner_[axes[2]];
        std::array<double, 4> weight;
        for (std::size_t i = 0; i < 4; ++i) weight[i] = base[i] + gradients_[axes[2]][i] * z;
        const double least =
            std::min(std::min(weight[0], weight[1]), std::min(weight[2], weight[3]));
        if (least < -error_) continue;
        if (!(least > error_)) return false;
        if (line.count++ == 0) line.first = point;
      }
      if (line.count > 0) lines_[tried_++] = line;
    }
  }
  return true;
}

LatticeTet HalfGrids::movedBack(const MovedAxes& moved) const noexcept {
  LatticeTet back = corners_;
  for (LatticePoint& corner : back) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] -= moved[k] ? unit_ / 2 : 0;
  }
  return back;
}

}  // namespace hexhex
