// Tets with few grid points in their bounding boxes: which of them are inside, in floating point
// with a proven bound, and exactly where that leaves it open. That is all that most tets of a
// coarse map take.
#pragma once

#include <array>
#include <vector>

#include <lattice/line_rasterizer.hpp>

namespace hexhex {

class SmallBoxes {
 public:
  /// @param corners  must outlive this
  SmallBoxes(const LatticeTet& corners, std::int64_t unit) noexcept;

  /// Appends the lines of a grid, as LineRasterizer has them.
  /// @param box    of the grid's points, not empty
  /// @param shift  of the points from integers, in all coordinates: 0, or 1/2 for centres of cells
  /// @return false, with nothing appended, if the box is not small
  [[nodiscard]] bool append(const GridBox& box, double shift, std::vector<SweptLine>& lines) const;

 private:
  /// More points take longer one by one than by lines.
  static constexpr std::int64_t kFewPoints = 4;
  using Weights = std::array<double, 4>;  ///< volumes, by the corner opposite to each

  [[nodiscard]] CornerMask simplexOf(const GridPoint& z, double shift) const noexcept;
  [[nodiscard]] CornerMask exactSimplexOf(const LatticePoint& point,
                                          const Weights& weights) const noexcept;

  const LatticeTet& lattice_;
  std::int64_t unit_;
  std::array<double, 3> nearby_;                  ///< grid point that corners are relative to
  std::array<std::array<double, 3>, 4> corners_;  ///< in grid units
  double error_;                                  ///< bound of the error of volumes
};

}  // namespace hexhex
