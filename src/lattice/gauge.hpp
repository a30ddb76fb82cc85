// Gauges: transitions from the charts of tets into a chart that many tets share.
//
// Coordinates there are integers modulo 2^32: they never overflow, however many tets the chart is
// glued from. Two points that coincide modulo 2^32 are just another overlap of the chart, and the
// atlas resolves overlaps anyway (atlas/overlaps.hpp).
#pragma once

#include <array>
#include <cstdint>

#include <lattice/grid_motion.hpp>

namespace hexhex::lattice {

/// Grid point of a common chart.
using ChartPoint = std::array<std::uint32_t, 3>;
using Gauge = GridMotion<std::uint32_t>;

/// The point at an offset.
[[nodiscard]] constexpr ChartPoint plus(ChartPoint c, const GridPoint& offset) noexcept {
  for (std::size_t k = 0; k < 3; ++k) c[k] += static_cast<std::uint32_t>(offset[k]);
  return c;
}

/// The point `steps` grid units from c in a direction.
[[nodiscard]] constexpr ChartPoint moved(ChartPoint c, Direction d, std::uint32_t steps) noexcept {
  c[static_cast<std::size_t>(axisOf(d))] += signOf(d) > 0 ? steps : 0U - steps;
  return c;
}

[[nodiscard]] constexpr ChartPoint plus(const ChartPoint& a, const ChartPoint& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

}  // namespace hexhex::lattice
