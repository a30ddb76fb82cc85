// Faces of a tet in planes of the grid, as all those on the boundary of a map.
#pragma once

#include <array>
#include <cstddef>

#include <lattice/rasterize.hpp>

namespace hexhex {

/// A face across an axis bounds the tet there: no point of the bounding box is outside of it, and
/// those on it are known without arithmetic.
struct BoxLimits {
  unsigned faces = 0;  ///< such faces, by the opposite corners, as bits
  /// The corners opposite those through the first points of the box, and through the last, as bits;
  /// by sweep axis.
  std::array<std::array<unsigned, 2>, 3> corners{};
  bool hold = false;  ///< whether there are points on such faces

  BoxLimits() = default;
  /// Whether a face might be across an axis.
  [[nodiscard]] static bool mayBeAcross(const LatticeTet& tet, std::size_t axis) noexcept {
    // Every face has both of one of these pairs.
    return tet[0][axis] == tet[1][axis] || tet[2][axis] == tet[3][axis];
  }
  /// @param first,last  points of the box, on the lattice
  BoxLimits(const LatticeTet& tet, const LatticePoint& first, const LatticePoint& last,
            SweepAxes axes) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t axis = axes()[k];
      if (!mayBeAcross(tet, axis)) continue;
      for (std::size_t face = 0; face < 4; ++face) {
        const std::array<int, 3>& f = kFaceCorners[face];
        const std::int64_t at = tet[static_cast<std::size_t>(f[0])][axis];
        if (tet[static_cast<std::size_t>(f[1])][axis] != at ||
            tet[static_cast<std::size_t>(f[2])][axis] != at) {
          continue;
        }
        faces |= 1U << face;
        const bool isLast = tet[face][axis] < at;
        // Between points, there is none on it.
        if (at != (isLast ? last : first)[axis]) continue;
        corners[k][isLast ? 1 : 0] = cornerBit(static_cast<int>(face));
        hold = true;
      }
    }
  }

  /// The simplex of a point that lies inside of all other faces.
  /// @param isFirst,isLast  whether it is a first or a last point of the box, by sweep axis
  [[nodiscard]] CornerMask inside(const std::array<bool, 3>& isFirst,
                                  const std::array<bool, 3>& isLast) const noexcept {
    unsigned off = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      off |= corners[k][0] * unsigned{isFirst[k]} | corners[k][1] * unsigned{isLast[k]};
    }
    return static_cast<CornerMask>(kWholeTet & ~off);
  }
};

}  // namespace hexhex
