// The ways from the centres of cells to their corners that a triangle may cut, in floating point
// with a proven bound.
#pragma once

#include <array>

#include <lattice/cell_corners.hpp>

namespace hexhex {

class TriangleWays {
 public:
  TriangleWays() = default;
  /// @param corners  relative to a grid point; not negative, may carry one rounding
  /// @param size     no coordinate is larger; at least 1
  TriangleWays(const std::array<std::array<double, 3>, 3>& corners, double size) noexcept
      : corners_(corners) {
    // With u = 2^-53 and s, one more than `size`: relative to the centre of a cell around the
    // triangle, corners are less than s away and known to 2 u s in each axis. Components of their
    // products, up to 2 s^2, err by 12 u s^2. The sum of three of them, up to 6 s^2, errs by 46 u
    // s^2, and the sum of three such sums by 168 u s^2. The determinant errs by 12 u s^3 for the
    // corner, by 36 u s^3 for the product, and by 16 u s^3 for roundings. 2^-44 is 512 u.
    const double s = size + 1;
    error_ = 0x1p-44 * s * s;
    determinantError_ = error_ * s;
  }

  /// The corners of a cell to which the straight way from its centre, with the centre, may meet the
  /// triangle.
  /// @param z  the cell's smallest corner, relative to the same grid point; not negative, the
  ///           centre at most `size` + 1
  [[nodiscard]] CellCornerSet cutIn(const GridPoint& z) const noexcept;

 private:
  std::array<std::array<double, 3>, 3> corners_;
  double error_;             ///< bound of the error of weights, and their sums
  double determinantError_;  ///< and of the determinant of the triangle's corners
};

}  // namespace hexhex
