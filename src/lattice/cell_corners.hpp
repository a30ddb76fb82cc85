// The eight corners of a cell, one by one and as sets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <lattice/rotation.hpp>

namespace hexhex {

/// Offsets of the corners of a cell from its smallest corner, in VTK order.
inline constexpr std::array<GridPoint, 8> kCellCorners = {
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// A set of corners of a cell, in VTK order: bit i for corner i.
using CellCornerSet = unsigned;
inline constexpr CellCornerSet kAllCellCorners = 0xff;

namespace detail {

/// Where a rotation takes the corner of a cell, as a corner of the cell's image.
constexpr std::size_t turnedCorner(Rotation rotation, std::size_t corner) {
  // The cell turns about its centre.
  GridPoint fromCenter{};
  for (std::size_t k = 0; k < 3; ++k) fromCenter[k] = 2 * kCellCorners[corner][k] - 1;
  const GridPoint image = rotation(fromCenter);
  std::size_t turned = 0;
  while (2 * kCellCorners[turned][0] - 1 != image[0] ||
         2 * kCellCorners[turned][1] - 1 != image[1] ||
         2 * kCellCorners[turned][2] - 1 != image[2]) {
    ++turned;
  }
  return turned;
}

constexpr auto makeTurnedCorners() {
  std::array<std::array<std::uint8_t, kAllCellCorners + 1>, Rotation::kCount> table{};
  for (int r = 0; r < Rotation::kCount; ++r) {
    auto& images = table[static_cast<std::size_t>(r)];
    for (std::size_t c = 0; c < 8; ++c) {
      const std::size_t bit = std::size_t{1} << c;
      const std::size_t image = std::size_t{1} << turnedCorner(Rotation(r), c);
      // A set with c as its largest member is the set without it, and c.
      for (std::size_t rest = 0; rest < bit; ++rest) {
        images[rest | bit] = static_cast<std::uint8_t>(images[rest] | image);
      }
    }
  }
  return table;
}

inline constexpr auto kTurnedCorners = makeTurnedCorners();

}  // namespace detail

/// Corners of a cell as those of its image.
[[nodiscard]] constexpr CellCornerSet turned(Rotation rotation, CellCornerSet corners) noexcept {
  return detail::kTurnedCorners[static_cast<std::size_t>(rotation.index())][corners];
}

}  // namespace hexhex
