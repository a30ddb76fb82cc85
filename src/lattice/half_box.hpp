// The grid of half the width: grid points, and what lies halfway between them along some axes.
#pragma once

#include <array>
#include <cstdint>

#include <lattice/rasterize.hpp>

namespace hexhex {

/// A grid, moved by one half along some axes: bit k for axis k. Its points are named by what they
/// are moved from.
using HalfGrid = std::uint8_t;

/// A set of such grids: bit g for grid g.
using HalfGridSet = std::uint8_t;

[[nodiscard]] constexpr HalfGridSet halfGridBit(HalfGrid grid) noexcept {
  return static_cast<HalfGridSet>(1U << grid);
}

/// The points of the grid of half the width in the bounding box of a tet, in halves.
struct HalfBox {
  std::array<std::int32_t, 3> first;
  std::array<std::int32_t, 3> steps;  ///< from the first to the last; -1 if there are none

  HalfBox() = default;
  /// @param unit  a power of two, at least 2
  HalfBox(const LatticeTet& corners, std::int64_t unit) noexcept;

  /// The grids that have points in the box.
  [[nodiscard]] HalfGridSet grids() const noexcept {
    constexpr std::array<unsigned, 3> kMoved = {0xaa, 0xcc, 0xf0};  ///< grids by axis
    unsigned set = 0xff;
    for (std::size_t k = 0; k < 3; ++k) {
      // One point along the axis is of one half of the grids, two points are of both.
      const unsigned odd = 0U - static_cast<unsigned>(first[k] & 1);
      const unsigned ofFirst = ~(kMoved[k] ^ odd);
      set &= steps[k] > 0 ? 0xffU : ofFirst & ~static_cast<unsigned>(steps[k]);
    }
    return static_cast<HalfGridSet>(set);
  }
  /// The points of one grid that has some.
  [[nodiscard]] GridBox of(HalfGrid grid) const noexcept {
    GridBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t moved = (grid >> k) & 1;
      const std::int32_t last = first[k] + steps[k];
      box.range[k] = {(first[k] + ((first[k] ^ moved) & 1)) >> 1,
                      (last - ((last ^ moved) & 1)) >> 1};
    }
    return box;
  }
};

}  // namespace hexhex
