// Tets with few grid points in their bounding boxes: which of them are inside, in floating point
// with a proven bound, and exactly where that leaves it open. That is all that most tets of a
// coarse map take.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <base/pair.hpp>
#include <lattice/line_rasterizer.hpp>

namespace hexhex {

class SmallBoxes {
 public:
  /// @param corners  must outlive this
  SmallBoxes(const LatticeTet& corners, std::int64_t unit) noexcept;

  /// Appends the lines of a grid, as LineRasterizer has them.
  /// @param box    of the grid's points, not empty
  /// @param shift  of the points from integers, in all coordinates, in units of the lattice: 0, or
  ///               half a unit for centres of cells
  /// @return false, with nothing appended, if the box is not small
  [[nodiscard]] bool append(const GridBox& box, std::int64_t shift,
                            std::vector<SweptLine>& lines) const;

 private:
  /// More points take longer one by one than by lines.
  static constexpr std::int64_t kFewPoints = 32;

  /// Something for each face, by the corner opposite to it: of faces 0 and 1, and of 2 and 3.
  using PerFace = std::array<Pair, 2>;

  [[nodiscard]] static PerFace moved(const PerFace& values, const PerFace& normals,
                                     double distance) noexcept {
    return {values[0] + normals[0] * distance, values[1] + normals[1] * distance};
  }
  [[nodiscard]] static double leastOf(const PerFace& values) noexcept {
    const Pair lesser = smaller(values[0], values[1]);
    return std::min(lesser[0], lesser[1]);
  }

  [[nodiscard]] std::uint32_t candidates(const GridBox& box, std::int64_t shift) const noexcept;
  [[nodiscard]] CornerMask simplexOf(const GridPoint& z, std::int64_t shift) const noexcept;
  [[nodiscard]] CornerMask exactSimplexOf(const LatticePoint& point,
                                          const PerFace& values) const noexcept;

  const LatticeTet& lattice_;
  std::int64_t unit_;
  double unitLength_;                   ///< the same
  std::array<std::int64_t, 3> origin_;  ///< a grid point near the tet; the rest is relative to it
  std::array<PerFace, 3> normals_;      ///< of faces, inward, by axis
  PerFace offsets_;                     ///< of faces' planes: their values at the origin
  double error_;                        ///< bound of the error of values at points of the box
};

}  // namespace hexhex
