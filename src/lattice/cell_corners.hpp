// The eight corners of a cell, one by one and as sets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <lattice/rotation.hpp>

namespace hexhex::lattice {

/// Offsets of the corners of a cell from its smallest corner, in VTK order.
inline constexpr std::array<GridPoint, 8> kCellCorners = {
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// A set of corners of a cell, in VTK order: bit i for corner i.
using CellCornerSet = unsigned;
inline constexpr CellCornerSet kAllCellCorners = 0xff;

namespace detail {

/// Images of a cell's corners under each rotation, as corners of the cell's image.
struct TurnedCorners {
  std::array<std::array<std::uint8_t, 8>, Rotation::kCount> corner{};
  std::array<std::array<std::uint8_t, kAllCellCorners + 1>, Rotation::kCount> set{};
};

constexpr std::uint8_t turnedByDefinition(Rotation rotation, std::size_t corner) {
  // The cell rotates about its centre.
  GridPoint fromCenter{};
  for (std::size_t k = 0; k < 3; ++k) fromCenter[k] = 2 * kCellCorners[corner][k] - 1;
  const GridPoint image = rotation(fromCenter);
  std::uint8_t turned = 0;
  for (std::uint8_t c = 0; c < 8; ++c) {
    bool isImage = true;
    for (std::size_t k = 0; k < 3; ++k) {
      isImage = isImage && 2 * kCellCorners[c][k] - 1 == image[k];
    }
    if (isImage) turned = c;
  }
  return turned;
}

constexpr TurnedCorners makeTurnedCorners() {
  TurnedCorners tables;
  for (std::size_t r = 0; r < Rotation::kCount; ++r) {
    for (std::size_t c = 0; c < 8; ++c) {
      const std::uint8_t image = turnedByDefinition(Rotation(static_cast<int>(r)), c);
      tables.corner[r][c] = image;
      // A set whose largest member is c is the set without c, plus c.
      const std::size_t bit = std::size_t{1} << c;
      for (std::size_t rest = 0; rest < bit; ++rest) {
        tables.set[r][rest | bit] = static_cast<std::uint8_t>(tables.set[r][rest] | (1U << image));
      }
    }
  }
  return tables;
}

inline constexpr TurnedCorners kTurnedCorners = makeTurnedCorners();

}  // namespace detail

/// A corner of a cell, as a corner of its image.
[[nodiscard]] constexpr std::size_t turnedCorner(Rotation rotation, std::size_t corner) noexcept {
  return detail::kTurnedCorners.corner[static_cast<std::size_t>(rotation.index())][corner];
}

/// A set of corners of a cell, as corners of its image.
[[nodiscard]] constexpr CellCornerSet turned(Rotation rotation, CellCornerSet corners) noexcept {
  return detail::kTurnedCorners.set[static_cast<std::size_t>(rotation.index())][corners];
}

}  // namespace hexhex::lattice
