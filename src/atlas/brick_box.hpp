// Boxes of bricks.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <atlas/brick_grid.hpp>
#include <sweep/tet_lines.hpp>

namespace hexhex {

/// The bricks around the points of a tet.
class BrickBox {
 public:
  /// @param lines  all lines of the tet
  BrickBox(std::span<const SweptLine> lines, const Gauge& gauge) noexcept {
    // Levels ascend.
    SweptLine low = lines.front();
    SweptLine high = lines.back();
    high.first = low.first;
    high.row = low.row;
    for (const SweptLine& line : lines) {
      low.row = std::min(low.row, line.row);
      high.row = std::max(high.row, line.row);
      low.first = std::min(low.first, line.first);
      high.first = std::max(high.first, line.first + static_cast<std::int32_t>(line.count) - 1);
    }
    enclose(gauge(low.point(0)), gauge(high.point(0)));
  }
  BrickBox(const GridBox& box, const Gauge& gauge) noexcept {
    enclose(gauge(GridPoint{box.range[0].first, box.range[1].first, box.range[2].first}),
            gauge(GridPoint{box.range[0].last, box.range[1].last, box.range[2].last}));
  }
  [[nodiscard]] std::uint64_t count() const noexcept {
    // No factor exceeds 2^29; what two make is more than anyone wants.
    const std::uint64_t layer = std::uint64_t{bricks_[0]} * bricks_[1];
    return layer > (std::uint64_t{1} << 32) ? layer : layer * bricks_[2];
  }
  /// Whether the brick of a key is in the box, if the box lies in a chart. May be true of the few
  /// bricks with a key that stands for two.
  [[nodiscard]] bool mayContain(Index chart, BrickKey key) const noexcept {
    if (key == 0) return true;
    bool contains = brickKey(chart, first_) >> 48 == key >> 48;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t steps =
          static_cast<std::uint32_t>(key >> (16 * k)) - first_[k] / kBrickSide;
      contains = contains && (steps & 0xffffU) < bricks_[k];
    }
    return contains;
  }
  /// Calls visit(ChartPoint) with a point of each brick.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (std::uint32_t z = 0; z < bricks_[2]; ++z) {
      for (std::uint32_t y = 0; y < bricks_[1]; ++y) {
        for (std::uint32_t x = 0; x < bricks_[0]; ++x) {
          visit(ChartPoint{first_[0] + x * kBrickSide, first_[1] + y * kBrickSide,
                           first_[2] + z * kBrickSide});
        }
      }
    }
  }

 private:
  /// @param a, b  opposite corners
  void enclose(const ChartPoint& a, const ChartPoint& b) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      // Rotation may have swapped the ends.
      const auto difference = static_cast<std::int32_t>(b[k] - a[k]);
      first_[k] = difference < 0 ? b[k] : a[k];
      const std::uint32_t size = difference < 0 ? 0U - static_cast<std::uint32_t>(difference)
                                                : static_cast<std::uint32_t>(difference);
      bricks_[k] = (first_[k] % kBrickSide + size) / kBrickSide + 1;
    }
  }

  ChartPoint first_{};
  std::array<std::uint32_t, 3> bricks_{};
};

}  // namespace hexhex
