// From the chart of a tet to the chart of the atlas that the tet belongs to.
//
// Coordinates in a chart of the atlas are integers modulo 2^32: they never overflow, however long
// the chain of tets that a chart is glued from. Two places of a chart that the modulus makes equal
// are nothing but another overlap, which the atlas has to stand anyway.
#pragma once

#include <array>
#include <cstdint>

#include <lattice/transition.hpp>

namespace hexhex {

/// Grid point of a chart of the atlas.
using ChartPoint = std::array<std::uint32_t, 3>;

struct Gauge {
  Rotation rotation;
  ChartPoint translation{};

  [[nodiscard]] constexpr bool operator==(const Gauge&) const = default;

  [[nodiscard]] constexpr ChartPoint operator()(const GridPoint& z) const noexcept {
    ChartPoint image =
        rotation(ChartPoint{static_cast<std::uint32_t>(z[0]), static_cast<std::uint32_t>(z[1]),
                            static_cast<std::uint32_t>(z[2])});
    for (std::size_t k = 0; k < 3; ++k) image[k] += translation[k];
    return image;
  }

  /// The cell whose smallest corner is z, by its smallest corner in the atlas.
  [[nodiscard]] constexpr ChartPoint cell(const GridPoint& z) const noexcept {
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
};

}  // namespace hexhex
