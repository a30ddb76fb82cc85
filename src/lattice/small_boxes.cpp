#include <algorithm>
#include <bit>
#include <cmath>

#include <base/vector3.hpp>
#include <lattice/small_boxes.hpp>

namespace hexhex {

SmallBoxes::SmallBoxes(const LatticeTet& corners, std::int64_t unit) noexcept
    : lattice_(corners), unit_(unit) {
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

/// The simplex whose interior contains a point of a grid, or kNoSimplex outside: by the volumes of
/// the four tets that the point makes with the faces.
CornerMask SmallBoxes::simplexOf(const GridPoint& z, double shift) const noexcept {
  const Vec3 point = {z[0] + shift - nearby_[0], z[1] + shift - nearby_[1],
                      z[2] + shift - nearby_[2]};
  const Vec3 a = minus(corners_[0], point);
  const Vec3 b = minus(corners_[1], point);
  const Vec3 c = minus(corners_[2], point);
  const Vec3 d = minus(corners_[3], point);
  const Vec3 ab = cross(a, b);
  const Vec3 cd = cross(c, d);
  const Weights weights = {dot(b, cd), -dot(a, cd), dot(d, ab), -dot(c, ab)};
  const double least = std::min(std::min(weights[0], weights[1]), std::min(weights[2], weights[3]));
  if (least < -error_) return kNoSimplex;
  if (least > error_) return kWholeTet;
  const std::int64_t half = shift == 0 ? 0 : unit_ / 2;
  return exactSimplexOf({z[0] * unit_ + half, z[1] * unit_ + half, z[2] * unit_ + half}, weights);
}

/// The same for a point close to some face: most of them are corners.
CornerMask SmallBoxes::exactSimplexOf(const LatticePoint& point,
                                      const Weights& weights) const noexcept {
  for (std::size_t i = 0; i < 4; ++i) {
    if (lattice_[i] == point) return cornerBit(static_cast<int>(i));
  }
  CornerMask simplex = kNoSimplex;
  for (std::size_t face = 0; face < 4; ++face) {
    const int side = weights[face] > error_ ? 1 : sideOfFace(lattice_, face, point);
    if (side < 0) return kNoSimplex;
    // A point off the face opposite a corner has a positive barycentric coordinate there.
    if (side > 0) simplex = static_cast<CornerMask>(simplex | cornerBit(static_cast<int>(face)));
  }
  return simplex;
}

bool SmallBoxes::append(const GridBox& box, double shift, std::vector<SweptLine>& lines) const {
  std::int64_t count = 1;
  for (const GridRange& range : box.range) {
    count *= std::int64_t{range.last} - range.first + 1;
    if (count > kFewPoints) return false;
  }
  struct Found {
    GridPoint at;  ///< by sweep axis in the end
    CornerMask simplex;
  };
  std::array<Found, kFewPoints> inside;
  std::size_t found = 0;
  for (std::int32_t x = box.range[0].first; x <= box.range[0].last; ++x) {
    for (std::int32_t y = box.range[1].first; y <= box.range[1].last; ++y) {
      for (std::int32_t z = box.range[2].first; z <= box.range[2].last; ++z) {
        const CornerMask simplex = simplexOf({x, y, z}, shift);
        if (simplex != kNoSimplex) inside[found++] = {{x, y, z}, simplex};
      }
    }
  }
  if (found == 0) return true;
  const SweepAxes order = chooseSweepAxes(box);
  const std::array<std::uint8_t, 3>& axes = order();
  for (std::size_t i = 0; i < found; ++i) {
    const GridPoint z = inside[i].at;
    inside[i].at = {z[axes[0]], z[axes[1]], z[axes[2]]};
  }
  std::sort(inside.begin(), inside.begin() + static_cast<std::ptrdiff_t>(found),
            [](const Found& a, const Found& b) { return a.at < b.at; });
  for (std::size_t i = 0; i < found; ++i) {
    const auto& [level, row, point] = inside[i].at;
    // Tets are convex: what they have of a line is consecutive.
    if (i > 0 && level == inside[i - 1].at[0] && row == inside[i - 1].at[1]) {
      ++lines.back().count;
      lines.back().right = inside[i].simplex;
    } else {
      lines.push_back({level, row, point, 1, inside[i].simplex, inside[i].simplex, order});
    }
  }
  return true;
}

}  // namespace hexhex
