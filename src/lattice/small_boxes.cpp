#include <algorithm>
#include <bit>
#include <cmath>

#include <base/vector3.hpp>
#include <lattice/small_boxes.hpp>

namespace hexhex {

SmallBoxes::SmallBoxes(const LatticeTet& corners, std::int64_t unit) noexcept {
  const double scale = 1.0 / static_cast<double>(unit);
  const int shift = std::countr_zero(static_cast<std::uint64_t>(unit));
  double size = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t grid = corners[0][k] >> shift;
    nearby_[k] = static_cast<double>(grid);
    for (std::size_t i = 0; i < 4; ++i) {
      corners_[i][k] = static_cast<double>(corners[i][k] - grid * unit) * scale;
      size = std::max(size, std::abs(corners_[i][k]));
    }
  }
  // Points of the bounding box are within 2 size of a corner in each axis. Differences of that
  // length carry two roundings, and each of the six products of three of them in a volume (at most
  // 8 size^3) three more besides the five of the sum: errors below 6 * 8 * 14 * 2^-53 size^3, which
  // is less than 2^-43 size^3. 2^-42 leaves a factor of two.
  error_ = 0x1p-42 * size * size * size;
}

/// By the volumes of the four tets that the point makes with the faces.
SmallBoxes::Side SmallBoxes::sideOf(const std::array<double, 3>& point) const noexcept {
  const Vec3 a = minus(corners_[0], point);
  const Vec3 b = minus(corners_[1], point);
  const Vec3 c = minus(corners_[2], point);
  const Vec3 d = minus(corners_[3], point);
  const Vec3 ab = cross(a, b);
  const Vec3 cd = cross(c, d);
  const double least =
      std::min(std::min(dot(b, cd), -dot(a, cd)), std::min(dot(d, ab), -dot(c, ab)));
  if (least < -error_) return Side::Outside;
  return least > error_ ? Side::Inside : Side::Unsure;
}

bool SmallBoxes::append(const GridBox& box, double shift, std::vector<SweptLine>& lines) const {
  std::int64_t count = 1;
  for (const GridRange& range : box.range) {
    count *= std::int64_t{range.last} - range.first + 1;
    if (count > kFewPoints) return false;
  }
  std::array<GridPoint, kFewPoints> inside;
  std::size_t found = 0;
  for (std::int32_t x = box.range[0].first; x <= box.range[0].last; ++x) {
    for (std::int32_t y = box.range[1].first; y <= box.range[1].last; ++y) {
      for (std::int32_t z = box.range[2].first; z <= box.range[2].last; ++z) {
        const Side side =
            sideOf({x + shift - nearby_[0], y + shift - nearby_[1], z + shift - nearby_[2]});
        if (side == Side::Unsure) return false;
        if (side == Side::Inside) inside[found++] = {x, y, z};
      }
    }
  }
  if (found == 0) return true;
  const SweepAxes order = chooseSweepAxes(box);
  const std::array<std::uint8_t, 3>& axes = order();
  for (std::size_t i = 0; i < found; ++i) {
    inside[i] = {inside[i][axes[0]], inside[i][axes[1]], inside[i][axes[2]]};
  }
  std::sort(inside.begin(), inside.begin() + static_cast<std::ptrdiff_t>(found));
  for (std::size_t i = 0; i < found; ++i) {
    const auto& [level, row, point] = inside[i];
    // Tets are convex: what they have of a line is consecutive.
    if (i > 0 && level == inside[i - 1][0] && row == inside[i - 1][1]) {
      ++lines.back().count;
    } else {
      lines.push_back({level, row, point, 1, kWholeTet, kWholeTet, order});
    }
  }
  return true;
}

}  // namespace hexhex
