// The grid points of one tet, and those of the grid moved by one half along some axes: centres of
// cells, midpoints of edges and faces. What these grids have in common is computed once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include <lattice/line_rasterizer.hpp>

namespace hexhex {

/// The axes along which a grid is moved by one half. Its points are named by what they are moved
/// from.
using MovedAxes = std::array<bool, 3>;

/// Sweeps a tet for the points of one grid after the other.
///
/// Of small boxes every point is tried, in floating point with a proven bound. That is all that
/// most tets of a coarse map take; where a point is not certainly inside or outside, and in larger
/// boxes, lines are found by LineRasterizer.
class HalfGrids {
 public:
  HalfGrids(const LatticeTet& corners, std::int64_t unit) noexcept
      : corners_(corners), unit_(unit), boxes_(gridBoxes(corners, unit)) {}

  /// Calls visit(SweptLine) for every line that meets the closed tet, in sweep order.
  /// @return the order of the sweep
  template <class Visit>
  SweepAxes sweep(const MovedAxes& moved, const Visit& visit) {
    const GridBox box = boxOf(moved);
    if (box.empty()) return {};
    const SweepAxes axes = chooseSweepAxes(box);
    if (countUpTo(box, kFewPoints) <= kFewPoints && tryPoints(box, moved, axes)) {
      for (std::size_t i = 0; i < tried_; ++i) visit(std::as_const(lines_[i]));
    } else {
      const LatticeTet back = movedBack(moved);
      LineRasterizer(back, unit_, box, axes).run(visit);
    }
    return axes;
  }

 private:
  /// Boxes of more points are not small.
  static constexpr std::int64_t kFewPoints = 6;

  [[nodiscard]] GridBox boxOf(const MovedAxes& moved) const noexcept {
    GridBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.range[k] = (moved[k] ? boxes_.centers : boxes_.vertices).range[k];
    }
    return box;
  }
  /// The number of points of a box that is not empty, or any number above the limit.
  [[nodiscard]] static std::int64_t countUpTo(const GridBox& box, std::int64_t limit) noexcept {
    std::int64_t count = 1;
    for (const GridRange& range : box.range) {
      count *= std::int64_t{range.last} - range.first + 1;
      if (count > limit) break;
    }
    return count;
  }
  void prepare() noexcept;
  /// Sets `lines_`.
  /// @return false if a point is neither certainly inside nor certainly outside
  [[nodiscard]] bool tryPoints(const GridBox& box, const MovedAxes& moved, SweepAxes axes) noexcept;
  /// The tet, moved so that the points of the grid become integers.
  [[nodiscard]] LatticeTet movedBack(const MovedAxes& moved) const noexcept;

  const LatticeTet& corners_;
  std::int64_t unit_;
  GridBoxes boxes_;

  // Made when first needed:
  bool prepared_ = false;
  std::array<double, 3> nearby_{};  ///< grid point that corner 0 is relative to
  std::array<double, 3> corner_{};  ///< corner 0
  double volume_ = 0;               ///< six times the tet's, which is the weight of corner 0 there
  /// Of the weight of each corner, by axis, then corner.
  std::array<std::array<double, 4>, 3> gradients_{};
  double error_ = 0;  ///< bound of the error of all weights in the tet's bounding box

  std::array<SweptLine, kFewPoints> lines_;
  std::size_t tried_ = 0;
};

}  // namespace hexhex
