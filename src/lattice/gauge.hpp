// Gauges: transitions from the charts of tets into a chart that many tets share.
//
// Coordinates there are integers modulo 2^32: they never overflow, however many tets the chart is
// glued from. Two points that the modulus makes equal are one more overlap of the chart, and the
// atlas resolves overlaps anyway (atlas/overlaps.hpp).
#pragma once

#include <array>
#include <cstdint>

#include <lattice/transition.hpp>

namespace hexhex::lattice {

/// Grid point of a common chart.
using ChartPoint = std::array<std::uint32_t, 3>;

struct Gauge {
  Rotation rotation;
  ChartPoint translation{};

  /// Not defaulted, as GCC would call memcmp.
  [[nodiscard]] constexpr bool operator==(const Gauge& other) const noexcept {
    std::uint32_t difference = rotation == other.rotation ? 0 : 1;
    for (std::size_t k = 0; k < 3; ++k) difference |= translation[k] ^ other.translation[k];
    return difference == 0;
  }

  [[nodiscard]] constexpr ChartPoint operator()(const ChartPoint& z) const noexcept {
    ChartPoint image = rotation(z);
    for (std::size_t k = 0; k < 3; ++k) image[k] += translation[k];
    return image;
  }
  [[nodiscard]] constexpr ChartPoint operator()(const GridPoint& z) const noexcept {
    return (*this)(ChartPoint{static_cast<std::uint32_t>(z[0]), static_cast<std::uint32_t>(z[1]),
                              static_cast<std::uint32_t>(z[2])});
  }

  /// Where the cell with smallest corner z goes, by its smallest corner there.
  template <class Point>
  [[nodiscard]] constexpr ChartPoint cell(const Point& z) const noexcept {
    ChartPoint image = (*this)(z);
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
      const Direction d = rotation(direction(axis, 1));
      if (signOf(d) < 0) --image[static_cast<std::size_t>(axisOf(d))];
    }
    return image;
  }

  /// (gauge * transition)(u) = gauge(transition(u)).
  friend constexpr Gauge operator*(const Gauge& gauge, const Transition& transition) noexcept {
    return {gauge.rotation * transition.rotation, gauge(transition.translation)};
  }

  /// (a * b)(u) = a(b(u)).
  friend constexpr Gauge operator*(const Gauge& a, const Gauge& b) noexcept {
    return {a.rotation * b.rotation, a(b.translation)};
  }

  /// (a / b)(b(u)) = a(u).
  friend constexpr Gauge operator/(const Gauge& a, const Gauge& b) noexcept {
    Gauge quotient{a.rotation * b.rotation.inverse(), a.translation};
    const ChartPoint image = quotient.rotation(b.translation);
    for (std::size_t k = 0; k < 3; ++k) quotient.translation[k] -= image[k];
    return quotient;
  }
};

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
