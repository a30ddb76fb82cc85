// Tables of rotations for directions to be covered and boundary planes.
#pragma once

#include <array>
#include <cstdint>

#include <hexhex/types.hpp>

#include <igm/plain_vertices.hpp>
#include <lattice/rotation.hpp>

namespace hexhex {

/// The direction that is to be covered once, by the rotation that was applied to it.
inline constexpr std::array<Vec3, Rotation::kCount> kTurnedDirections = [] {
  std::array<Vec3, Rotation::kCount> turned{};
  for (int r = 0; r < Rotation::kCount; ++r) {
    turned[static_cast<std::size_t>(r)] = Rotation(r)(kGeneralDirection);
  }
  return turned;
}();

/// Where rotations send axes.
inline constexpr std::array<std::array<std::uint8_t, 3>, Rotation::kCount> kImagesOfAxes = [] {
  std::array<std::array<std::uint8_t, 3>, Rotation::kCount> images{};
  for (int r = 0; r < Rotation::kCount; ++r) {
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
      images[static_cast<std::size_t>(r)][axis] =
          static_cast<std::uint8_t>(axisOf(Rotation(r)(direction(axis, 1))));
    }
  }
  return images;
}();

}  // namespace hexhex
