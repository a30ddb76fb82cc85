// The unit cells in which a triangle may cut half diagonals, the segments from a cell's centre to
// its corners.
#pragma once

#include <array>
#include <cstdint>

#include <lattice/cell_corners.hpp>
#include <lattice/tet_geometry.hpp>
#include <lattice/triangle_columns.hpp>

namespace hexhex::lattice {

/// The half diagonals of cells that a triangle may cut, in floating point with a proven bound.
class HalfDiagonalCuts {
 public:
  HalfDiagonalCuts() = default;
  /// @param corners  relative to a grid point; not negative, may carry one rounding
  /// @param size     at least 1, and no smaller than any coordinate
  HalfDiagonalCuts(const std::array<std::array<double, 3>, 3>& corners, double size) noexcept
      : corners_(corners) {
    // With u = 2^-53 and s = `size` + 1: relative to the centre of a cell around the triangle,
    // corners are less than s away and off by 2 u s along each axis. Components of their products,
    // up to 2 s^2, are off by 12 u s^2; the sum of three of them, up to 6 s^2, by 46 u s^2; and the
    // sum of three such sums by 168 u s^2. The determinant is off by 12 u s^3 for the corner, by 36
    // u s^3 for the product, and by 16 u s^3 for roundings. 2^-44 is 512 u.
    const double s = size + 1;
    error_ = 0x1p-44 * s * s;
    determinantError_ = error_ * s;
  }

  /// The corners of a cell whose half diagonals, including the centre, may meet the triangle.
  /// @param z  the cell's smallest corner, relative to the same grid point; not negative, with the
  ///           centre at most at `size` + 1
  [[nodiscard]] CellCornerSet cutIn(const GridPoint& z) const noexcept;

 private:
  std::array<std::array<double, 3>, 3> corners_;
  double error_;             ///< error bound of weights, and of their sums
  double determinantError_;  ///< and of the determinant of the triangle's corners
};

/// Finds cells: those in the bounding box of a small triangle, column by column for a larger one.
/// The limits of the box are exact, so that a triangle in a grid plane cuts nothing. Cells are
/// named by their smallest corner.
class TriangleCells {
 public:
  /// @param corners  of a triangle that is not degenerate; must outlive this
  /// @param unit     a power of two
  TriangleCells(const std::array<LatticePoint, 3>& corners, std::int64_t unit) noexcept;

  /// Calls visit(GridPoint, CellCornerSet) once per cell, with at least those of its corners whose
  /// half diagonals, including the centre but not the corner, meet the triangle. Skips cells
  /// without such corners.
  template <class Visit>
  void run(const Visit& visit) const {
    if (cells_ == 0) return;
    if (cells_ > kFewCells) {
      TriangleColumns(triangle_, unit_).run([&](const GridPoint& z, CellCornerSet octants) {
        const CellCornerSet corners = octants & cuts_.cutIn(minus(z, origin_));
        if (corners != 0) visit(z, corners);
      });
      return;
    }
    GridPoint z{};
    for (z[2] = first_[2] >> 1; z[2] <= last_[2] >> 1; ++z[2]) {
      for (z[1] = first_[1] >> 1; z[1] <= last_[1] >> 1; ++z[1]) {
        for (z[0] = first_[0] >> 1; z[0] <= last_[0] >> 1; ++z[0]) {
          const CellCornerSet corners = octantsInBox(z) & cuts_.cutIn(z);
          if (corners != 0) visit(plus(z, origin_), corners);
        }
      }
    }
  }

 private:
  /// Up to this many cells, testing each takes less time than finding columns.
  static constexpr std::int64_t kFewCells = 24;

  [[nodiscard]] static GridPoint plus(const GridPoint& a, const GridPoint& b) noexcept {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  }
  [[nodiscard]] static GridPoint minus(const GridPoint& a, const GridPoint& b) noexcept {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  [[nodiscard]] CellCornerSet octantsInBox(const GridPoint& z) const noexcept {
    // Per axis: the corners with coordinate 0, and those with 1.
    constexpr std::array<std::array<CellCornerSet, 2>, 3> kSides = {
        {{0x99, 0x66}, {0x33, 0xcc}, {0x0f, 0xf0}}};
    CellCornerSet octants = kAllCellCorners;
    for (std::size_t k = 0; k < 3; ++k) {
      if (2 * z[k] < first_[k]) octants &= kSides[k][1];
      if (2 * z[k] + 1 > last_[k]) octants &= kSides[k][0];
    }
    return octants;
  }

  const std::array<LatticePoint, 3>& triangle_;
  std::int64_t unit_;
  GridPoint origin_;                   ///< near the triangle
  std::array<std::int32_t, 3> first_;  ///< half cells of the bounding box, relative
  std::array<std::int32_t, 3> last_;
  std::int64_t cells_;  ///< in the box
  HalfDiagonalCuts cuts_;
};

}  // namespace hexhex::lattice
