// The result of a sweep over the grid points of a tet: lines of points, each with the simplex whose
// interior contains it.
#pragma once

#include <array>
#include <cstdint>

#include <lattice/tet_geometry.hpp>

namespace hexhex::lattice {

/// The integer grid, shifted by one half along some axes: bit k for axis k. Grid point z names the
/// point it is shifted to: a cell's centre is named by the cell's smallest corner.
using HalfGrid = std::uint8_t;
/// The grids of hex vertices and of cell centres.
inline constexpr HalfGrid kVertexGrid = 0;
inline constexpr HalfGrid kCenterGrid = 7;

/// The order in which a tet is swept: planes of constant coordinate axes[0], in each of them lines
/// of constant axes[1], along axes[2].
struct SweepAxes {
  std::uint8_t index = 0;  ///< among the six permutations

  static constexpr std::array<std::array<std::uint8_t, 3>, 6> kPermutations = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

  [[nodiscard]] constexpr const std::array<std::uint8_t, 3>& operator()() const noexcept {
    return kPermutations[index];
  }
};

/// Range of grid coordinates, inclusive; empty if first > last.
struct GridRange {
  std::int32_t first = 0;
  std::int32_t last = -1;
};

/// The points of a grid in the bounding box of a tet.
struct GridBox {
  std::array<GridRange, 3> range;
  [[nodiscard]] bool empty() const noexcept {
    return range[0].first > range[0].last || range[1].first > range[1].last ||
           range[2].first > range[2].last;
  }
};

/// Fewest planes first, longest lines last; ties in order of the axes. (Section 5.2.1)
[[nodiscard]] inline SweepAxes chooseSweepAxes(const GridBox& box) noexcept {
  std::array<std::int64_t, 3> counts{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    counts[axis] = std::int64_t{box.range[axis].last} - box.range[axis].first;
  }
  // Indexed by which axes have fewer points than others before them: 1 than 0, 2 than 1, 2 than 0.
  constexpr std::array<std::uint8_t, 8> kOrders = {0, 2, 1, 5, 0, 3, 4, 5};
  const unsigned fewer = (counts[1] < counts[0] ? 1U : 0U) | (counts[2] < counts[1] ? 2U : 0U) |
                         (counts[2] < counts[0] ? 4U : 0U);
  return {kOrders[fewer]};
}

/// A non-empty line of grid points of a closed tet, along the third sweep axis.
struct SweptLine {
  std::int32_t level;  ///< coordinate along the first sweep axis
  std::int32_t row;    ///< along the second
  std::int32_t first;  ///< along the third, of the first point
  std::uint32_t count;
  CornerMask left;   ///< simplex of the first point
  CornerMask right;  ///< of the last point
  SweepAxes axes;    ///< the same for all lines of a tet

  /// The simplex of all points in between: the smallest that contains both ends, by convexity.
  /// (Appendix A.1, its six rules in one)
  [[nodiscard]] CornerMask inner() const noexcept { return static_cast<CornerMask>(left | right); }
  /// The simplex of the i-th point.
  [[nodiscard]] CornerMask simplex(std::uint32_t i) const noexcept {
    return i == 0 ? left : (i + 1 == count ? right : inner());
  }
  /// The i-th point.
  [[nodiscard]] GridPoint point(std::uint32_t i) const noexcept {
    const std::array<std::uint8_t, 3>& a = axes();
    GridPoint z{};
    z[a[0]] = level;
    z[a[1]] = row;
    z[a[2]] = first + static_cast<std::int32_t>(i);
    return z;
  }
  /// The index of a grid point on the line; `count` or more if it is not one of the line's points.
  [[nodiscard]] std::uint32_t indexOf(const GridPoint& z) const noexcept {
    return static_cast<std::uint32_t>(z[axes()[2]]) - static_cast<std::uint32_t>(first);
  }
  /// Whether all points lie in the interior of the tet.
  [[nodiscard]] bool allInside() const noexcept { return left == kWholeTet && right == kWholeTet; }
};

}  // namespace hexhex::lattice
