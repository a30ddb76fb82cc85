// The octants of unit cells that a triangle may meet, column by column.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <lattice/cell_corners.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex::lattice {

/// The first half cell of a bounding box that begins at `low`. Half cells are open at grid points,
/// where cells meet, but contain the cells' centre planes, where octants meet.
[[nodiscard]] inline std::int32_t firstHalfCell(std::int64_t low, int shift) noexcept {
  const std::int64_t half = (2 * low) >> shift;
  const bool onPlane = (half << shift) == 2 * low;
  return static_cast<std::int32_t>(onPlane && half % 2 != 0 ? half - 1 : half);
}

/// The last half cell of a bounding box that ends at `high`.
[[nodiscard]] inline std::int32_t lastHalfCell(std::int64_t high, int shift) noexcept {
  const std::int64_t half = (2 * high) >> shift;
  const bool onPlane = (half << shift) == 2 * high;
  return static_cast<std::int32_t>(onPlane && half % 2 == 0 ? half - 1 : half);
}

/// Conservative rasterization of a non-degenerate triangle: misses no cell that the triangle meets,
/// but may visit others. Cells are named by their smallest corner.
///
/// The columns of cells along the axis of the largest component of the triangle's normal are found
/// in the projection along that axis; in each column the triangle's plane bounds the cells, and in
/// each quarter of a column the octants of cells. The limits of the bounding box are exact, so that
/// a triangle in a grid plane meets no cell.
class TriangleColumns {
 public:
  /// @param unit  a power of two
  TriangleColumns(const std::array<LatticePoint, 3>& corners, std::int64_t unit) noexcept;

  /// Calls visit(GridPoint, CellCornerSet) once per cell with octants that the triangle may meet;
  /// the octants are named by the cell's corners.
  template <class Visit>
  void run(const Visit& visit) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (first_[k] > last_[k]) return;
    }
    const Rotation toOwn = Rotation::fromAxes(direction(axes_[0], 1), direction(axes_[1], 1));
    for (std::int32_t u = first_[0] >> 1; u <= last_[0] >> 1; ++u) {
      const std::array<double, 2> rows = strip(u);
      const std::int32_t firstRow = clampedFloor(rows[0], first_[1] >> 1, last_[1] >> 1);
      const std::int32_t lastRow = clampedFloor(rows[1], first_[1] >> 1, last_[1] >> 1);
      for (std::int32_t v = firstRow; v <= lastRow; ++v) {
        Column column = columnAt(u, v);
        for (; column.octants != 0; column.octants >>= 8, ++column.lowest) {
          const auto octants = static_cast<CellCornerSet>(column.octants & kAllCellCorners);
          if (octants != 0) visit(cell(u, v, column.lowest), turned(toOwn, octants));
        }
      }
    }
  }

 private:
  /// Consecutive cells along the third axis, with the octants that the triangle's plane may meet.
  struct Column {
    std::int32_t lowest;
    std::uint64_t octants;  ///< those of the lowest cell in the lowest byte
  };

  /// floor(x), clamped to limits that are not negative.
  [[nodiscard]] static std::int32_t clampedFloor(double x, std::int32_t low,
                                                 std::int32_t high) noexcept {
    if (!(x > low)) return low;
    return x >= high ? high : static_cast<std::int32_t>(x);
  }
  [[nodiscard]] GridPoint cell(std::int32_t u, std::int32_t v, std::int32_t w) const noexcept {
    GridPoint z{};
    z[axes_[0]] = u + origin_[0];
    z[axes_[1]] = v + origin_[1];
    z[axes_[2]] = w + origin_[2];
    return z;
  }
  /// Range of the second coordinate where the first is in [u, u + 1].
  [[nodiscard]] std::array<double, 2> strip(std::int32_t u) const noexcept;
  [[nodiscard]] Column columnAt(std::int32_t u, std::int32_t v) const noexcept;

  std::array<std::uint8_t, 3> axes_;    ///< cyclic; the normal is largest along the last one
  std::array<std::int32_t, 3> origin_;  ///< grid point near the triangle, per axis
  std::array<std::int32_t, 3> first_;   ///< half cells of the bounding box, relative
  std::array<std::int32_t, 3> last_;
  std::array<std::array<double, 3>, 3> p_;  ///< corners, per axis, relative
  std::array<double, 3> plane_;             ///< w = plane[0] + plane[1] u + plane[2] v
  double margin_;                           ///< bound of all rounding errors
};

}  // namespace hexhex::lattice
