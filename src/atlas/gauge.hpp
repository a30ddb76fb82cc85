// Gauges prepared for the points of a sweep.
#pragma once

#include <array>
#include <cstdint>

#include <lattice/gauge.hpp>

namespace hexhex {

/// The points of one tet's sweep in its chart: as a gauge, but prepared for many points.
class SweepFrame {
 public:
  SweepFrame(const Gauge& gauge, const std::array<std::uint8_t, 3>& axes) noexcept
      : origin_(gauge.translation) {
    for (std::uint8_t k = 0; k < 3; ++k) {
      directions_[k] = gauge.rotation(direction(axes[k], 1));
      const auto axis = static_cast<std::size_t>(axisOf(directions_[k]));
      source_[axis] = k;
      sign_[axis] = signOf(directions_[k]) > 0 ? 1U : ~0U;
    }
  }
  [[nodiscard]] ChartPoint operator()(std::int32_t level, std::int32_t row,
                                      std::int32_t point) const noexcept {
    const ChartPoint swept = {static_cast<std::uint32_t>(level), static_cast<std::uint32_t>(row),
                              static_cast<std::uint32_t>(point)};
    ChartPoint c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = origin_[k] + sign_[k] * swept[source_[k]];
    return c;
  }
  /// The direction of a sweep axis in the chart.
  [[nodiscard]] Direction along(std::size_t axis) const noexcept { return directions_[axis]; }

 private:
  ChartPoint origin_;
  std::array<Direction, 3> directions_{};
  std::array<std::uint8_t, 3> source_{};  ///< per axis of the chart: the sweep axis behind it
  std::array<std::uint32_t, 3> sign_{};   ///< 1 or -1
};

}  // namespace hexhex
