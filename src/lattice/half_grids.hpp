// The grid points of one tet, and those of the grid moved by one half along some axes: centres of
// cells, midpoints of edges and faces. All of them are points of the grid of half the width, and
// what finding them has in common is done once.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <lattice/line_rasterizer.hpp>

namespace hexhex {

/// A grid, moved by one half along some axes: bit k for axis k. Its points are named by what they
/// are moved from.
using HalfGrid = std::uint8_t;

/// A set of such grids: bit g for grid g.
using HalfGridSet = std::uint8_t;

[[nodiscard]] constexpr HalfGridSet halfGridBit(HalfGrid grid) noexcept {
  return static_cast<HalfGridSet>(1U << grid);
}

/// Which grids are to be swept, and where their points are in small boxes of the grid of half the
/// width. Made once for many tets.
class HalfGridSearch {
 public:
  /// Boxes of more points along some axis are not in the table.
  static constexpr std::int32_t kSide = 4;

  explicit HalfGridSearch(HalfGridSet wanted);

  [[nodiscard]] HalfGridSet wanted() const noexcept { return wanted_; }

  /// Places in a box, relative to its first point: two bits per axis.
  struct Places {
    std::uint8_t count = 0;
    std::array<std::uint8_t, kSide * kSide * kSide> places{};
  };
  /// The wanted points of a box.
  /// @param first  its first point, in halves
  /// @param size   its number of points minus one, by axis, each less than kSide
  [[nodiscard]] const Places& placesIn(const std::array<std::int32_t, 3>& first,
                                       const std::array<std::int32_t, 3>& size) const noexcept {
    std::size_t key = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      key = key * 8 + static_cast<std::size_t>(2 * size[k] + (first[k] & 1));
    }
    return places_[key];
  }

 private:
  HalfGridSet wanted_;
  std::vector<Places> places_;
};

/// Sweeps a tet for the points of one grid after the other.
///
/// Small tets are compared with all points of their bounding box first, in floating point with a
/// proven bound: that is all that most tets of a coarse map take. Grids of which a point is not
/// certainly inside or outside then, and those of larger tets, are swept by LineRasterizer.
class HalfGrids {
 public:
  /// @param search  for the grids that may be swept
  HalfGrids(const LatticeTet& corners, std::int64_t unit, const HalfGridSearch& search) noexcept;

  /// The wanted grids that may have points in the tet.
  [[nodiscard]] HalfGridSet occupied() const noexcept { return occupied_; }

  /// Calls visit(SweptLine) for every line of a wanted grid that meets the closed tet, in sweep
  /// order.
  /// @return the order of the sweep; any, if there are no lines
  template <class Visit>
  SweepAxes sweep(HalfGrid grid, const Visit& visit) {
    if ((occupied_ & halfGridBit(grid)) == 0) return {};
    const GridBox box = boxOf(grid);
    const SweepAxes axes = chooseSweepAxes(box);
    if ((unsure_ & halfGridBit(grid)) == 0) {
      SweepPoints points;
      visitLines(std::span(points).first(sortInside(grid, axes, points)), axes, visit);
    } else if (!box.empty()) {
      const LatticeTet back = movedBack(grid);
      LineRasterizer(back, unit_, box, axes).run(visit);
    }
    return axes;
  }

 private:
  static constexpr std::size_t kMostPlaces =
      std::tuple_size_v<decltype(HalfGridSearch::Places::places)>;

  /// A point that is certainly inside.
  struct Inside {
    GridPoint z;
    HalfGrid grid;
  };

  [[nodiscard]] bool comparePoints(const HalfGridSearch& search) noexcept;
  /// Coordinates of points by sweep axis, in sweep order.
  using SweepPoints = std::array<std::array<std::int32_t, 3>, kMostPlaces>;
  /// The points of a grid that is not unsure.
  /// @return their number
  std::size_t sortInside(HalfGrid grid, SweepAxes axes, SweepPoints& points) const noexcept;
  template <class Visit>
  static void visitLines(std::span<const std::array<std::int32_t, 3>> points, SweepAxes axes,
                         const Visit& visit) {
    for (std::size_t i = 0; i < points.size();) {
      const auto& [level, row, first] = points[i];
      // Tets are convex: what they have of a line is consecutive.
      std::uint32_t count = 0;
      while (i < points.size() && points[i][0] == level && points[i][1] == row) ++count, ++i;
      const SweptLine line{level, row, first, count, kWholeTet, kWholeTet, axes};
      visit(line);
    }
  }
  [[nodiscard]] GridBox boxOf(HalfGrid grid) noexcept;
  /// The tet, moved so that the points of the grid become integers.
  [[nodiscard]] LatticeTet movedBack(HalfGrid grid) const noexcept;

  const LatticeTet& corners_;
  std::int64_t unit_;
  HalfGridSet occupied_ = 0;
  HalfGridSet unsure_ = 0;  ///< grids that take an exact sweep
  std::size_t insideCount_ = 0;
  std::optional<GridBoxes> boxes_;              ///< made when first needed
  std::array<Inside, kMostPlaces + 1> inside_;  ///< of the grids that are not unsure
};

}  // namespace hexhex
