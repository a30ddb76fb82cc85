// The six directions of the integer grid, and the axes behind them.
#pragma once

#include <array>
#include <cstdint>

namespace hexhex::lattice {

/// A signed coordinate direction: 0 +x, 1 -x, 2 +y, 3 -y, 4 +z, 5 -z.
using Direction = std::uint8_t;

inline constexpr int kDirections = 6;

[[nodiscard]] constexpr int axisOf(Direction d) noexcept { return d >> 1; }
[[nodiscard]] constexpr int signOf(Direction d) noexcept { return (d & 1) != 0 ? -1 : 1; }
[[nodiscard]] constexpr Direction opposite(Direction d) noexcept {
  return static_cast<Direction>(d ^ 1);
}
[[nodiscard]] constexpr Direction direction(int axis, int sign) noexcept {
  return static_cast<Direction>(2 * axis + (sign < 0 ? 1 : 0));
}

/// Cross product of two perpendicular directions.
[[nodiscard]] constexpr Direction cross(Direction a, Direction b) noexcept {
  const int axisA = axisOf(a);
  const int axisB = axisOf(b);
  const int cyclic = (axisA + 1) % 3 == axisB ? 1 : -1;
  return direction(3 - axisA - axisB, cyclic * signOf(a) * signOf(b));
}

/// Integer point of the grid, in some tet's chart.
using GridPoint = std::array<std::int32_t, 3>;

[[nodiscard]] constexpr GridPoint step(GridPoint z, Direction d) noexcept {
  z[static_cast<std::size_t>(axisOf(d))] += signOf(d);
  return z;
}

}  // namespace hexhex::lattice
