// Places in charts: straight rows of points, and bricks of 8 x 8 x 8 points.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include <hexhex/types.hpp>

#include <lattice/gauge.hpp>

namespace hexhex::atlas {

/// The points of one tet's sweep in its chart: as a gauge, but prepared for many points.
class SweepFrame {
 public:
  SweepFrame(const lattice::Gauge& gauge, const std::array<std::uint8_t, 3>& axes) noexcept
      : origin_(gauge.translation) {
    for (std::uint8_t k = 0; k < 3; ++k) {
      directions_[k] = gauge.rotation(lattice::direction(axes[k], 1));
      const auto axis = static_cast<std::size_t>(lattice::axisOf(directions_[k]));
      source_[axis] = k;
      sign_[axis] = lattice::signOf(directions_[k]) > 0 ? 1U : ~0U;
    }
  }
  [[nodiscard]] lattice::ChartPoint operator()(std::int32_t level, std::int32_t row,
                                               std::int32_t point) const noexcept {
    const lattice::ChartPoint swept = {static_cast<std::uint32_t>(level),
                                       static_cast<std::uint32_t>(row),
                                       static_cast<std::uint32_t>(point)};
    lattice::ChartPoint c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = origin_[k] + sign_[k] * swept[source_[k]];
    return c;
  }
  /// The direction of a sweep axis in the chart.
  [[nodiscard]] lattice::Direction along(std::size_t axis) const noexcept {
    return directions_[axis];
  }

 private:
  lattice::ChartPoint origin_;
  std::array<lattice::Direction, 3> directions_{};
  std::array<std::uint8_t, 3> source_{};  ///< per axis of the chart: the sweep axis behind it
  std::array<std::uint32_t, 3> sign_{};   ///< 1 or -1
};

/// Points along each side of a brick, and in all of it.
inline constexpr std::uint32_t kBrickSide = 8;
inline constexpr std::size_t kBrickPoints = std::size_t{kBrickSide} * kBrickSide * kBrickSide;

/// Names a brick: chart and brick coordinates, modulo 2^16 each. Charts and places that the modulus
/// makes equal overlap, no more (see lattice/gauge.hpp). What it takes off coordinates changes the
/// chart, or tets longer than 2^19 grid units would overlap themselves.
using BrickKey = std::uint64_t;
inline constexpr BrickKey kNoBrick = std::numeric_limits<BrickKey>::max();

[[nodiscard]] constexpr BrickKey brickKey(Index chart, const lattice::ChartPoint& c) noexcept {
  const auto part = [](std::uint32_t value) { return std::uint64_t{value & 0xffffU}; };
  const std::uint32_t sheet = chart ^ c[0] >> 17 ^ c[1] >> 15;  // and c[2] >> 19
  const BrickKey key = (std::uint64_t{sheet} << 48 ^ std::uint64_t{c[2] / kBrickSide} << 32) |
                       part(c[1] / kBrickSide) << 16 | part(c[0] / kBrickSide);
  return key == kNoBrick ? 0 : key;
}
[[nodiscard]] constexpr std::size_t placeInBrick(const lattice::ChartPoint& c) noexcept {
  return (c[2] % kBrickSide * kBrickSide + c[1] % kBrickSide) * kBrickSide + c[0] % kBrickSide;
}

/// From the place of a point to that of its neighbour in a direction, in the same brick.
[[nodiscard]] constexpr std::ptrdiff_t strideInBrick(lattice::Direction d) noexcept {
  constexpr std::array<std::ptrdiff_t, 3> kStrides = {1, kBrickSide, kBrickSide * kBrickSide};
  return lattice::signOf(d) * kStrides[static_cast<std::size_t>(lattice::axisOf(d))];
}

/// A table of recently used bricks has one entry for all bricks with the same coordinates modulo 8.
inline constexpr std::size_t kRecentBricks = 512;
[[nodiscard]] constexpr std::size_t recentBrick(const lattice::ChartPoint& c) noexcept {
  return (c[0] / kBrickSide % 8) | (c[1] / kBrickSide % 8) << 3 | (c[2] / kBrickSide % 8) << 6;
}

/// A straight row of points in a chart, in steps of one grid unit.
struct ChartRow {
  Index chart;
  lattice::ChartPoint start;
  lattice::Direction along;
  std::uint32_t count;

  /// Calls visit(point, offset, count, stride) for each part of the row within one brick: its first
  /// point, its offset in the row, its number of points, and the distance of their places.
  template <class Visit>
  void forEachPart(const Visit& visit) const {
    const auto axis = static_cast<std::size_t>(lattice::axisOf(along));
    const std::ptrdiff_t stride = strideInBrick(along);
    const bool forward = lattice::signOf(along) > 0;
    lattice::ChartPoint c = start;
    for (std::uint32_t offset = 0; offset < count;) {
      const std::uint32_t inBrick = c[axis] % kBrickSide;
      const std::uint32_t room = forward ? kBrickSide - inBrick : inBrick + 1;
      const std::uint32_t part = std::min(room, count - offset);
      visit(std::as_const(c), offset, part, stride);
      offset += part;
      c[axis] += forward ? part : 0U - part;
    }
  }
};

}  // namespace hexhex::atlas
