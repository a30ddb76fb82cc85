// The unit cells whose open interior a triangle may meet.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <lattice/tet_geometry.hpp>

namespace hexhex {

/// Conservative rasterization of a triangle that is not degenerate: no cell that it meets is left
/// out, some that it does not meet may be in. Cells are named by their smallest corner.
///
/// Columns of cells along the axis in which the triangle is steepest are found in the projection
/// along that axis; in each column the triangle's plane bounds the cells. Limits of the bounding
/// box are exact, so that a triangle in a grid plane meets no cell.
class TriangleCells {
 public:
  /// @param unit  a power of two
  TriangleCells(const std::array<LatticePoint, 3>& corners, std::int64_t unit) noexcept;

  /// Calls visit(GridPoint) for each cell once.
  template <class Visit>
  void run(const Visit& visit) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (first_[k] > last_[k]) return;
    }
    for (std::int32_t u = first_[0]; u <= last_[0]; ++u) {
      const std::array<double, 2> rows = strip(u);
      const std::int32_t firstRow = clampedFloor(rows[0], first_[1], last_[1]);
      const std::int32_t lastRow = clampedFloor(rows[1], first_[1], last_[1]);
      for (std::int32_t v = firstRow; v <= lastRow; ++v) {
        const std::array<double, 2> heights = column(u, v);
        if (heights[1] < first_[2] || heights[0] > last_[2] + 1.0) continue;
        const std::int32_t lowest = clampedFloor(heights[0], first_[2], last_[2]);
        const std::int32_t highest = clampedFloor(heights[1], first_[2], last_[2]);
        for (std::int32_t w = lowest; w <= highest; ++w) visit(cell(u, v, w));
      }
    }
  }

 private:
  /// floor(x) within limits.
  [[nodiscard]] static std::int32_t clampedFloor(double x, std::int32_t low,
                                                 std::int32_t high) noexcept {
    if (!(x > low)) return low;
    return x >= high ? high : static_cast<std::int32_t>(std::floor(x));
  }
  [[nodiscard]] GridPoint cell(std::int32_t u, std::int32_t v, std::int32_t w) const noexcept {
    GridPoint z{};
    z[axes_[0]] = u + origin_[0];
    z[axes_[1]] = v + origin_[1];
    z[axes_[2]] = w + origin_[2];
    return z;
  }
  /// Range of the second coordinate where the first one is in [u, u + 1].
  [[nodiscard]] std::array<double, 2> strip(std::int32_t u) const noexcept;
  /// Range of the third coordinate over the square [u, u + 1] x [v, v + 1].
  [[nodiscard]] std::array<double, 2> column(std::int32_t u, std::int32_t v) const noexcept;

  std::array<std::uint8_t, 3> axes_;    ///< the last one is the steepest
  std::array<std::int32_t, 3> origin_;  ///< grid point near the triangle, by axis
  std::array<std::int32_t, 3> first_;   ///< cells of the bounding box, relative
  std::array<std::int32_t, 3> last_;
  std::array<std::array<double, 3>, 3> p_;  ///< corners, by axis, relative
  std::array<double, 3> plane_;             ///< w = plane[0] + plane[1] u + plane[2] v
  double margin_;                           ///< bound of all rounding errors
};

}  // namespace hexhex
