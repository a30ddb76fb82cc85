// Where the grid points of one tet lie in space. Both engines take positions from here, so they
// agree in every bit.
#pragma once

#include <hexhex/types.hpp>

#include <igm/igm.hpp>
#include <lattice/tet_rasterizer.hpp>

namespace hexhex::sweep {

/// The inverse of the map in one tet.
class TetPositions {
 public:
  /// @param axes  of the sweep that finds the tet's points
  TetPositions(const igm::PreparedMap& map, Index tet, lattice::SweepAxes axes);

  /// The preimage of a grid point in the interior of a simplex of the tet: a vertex itself, on the
  /// segment at edges, in the plane of the three corners at faces.
  [[nodiscard]] Vec3 at(lattice::CornerMask simplex, const lattice::GridPoint& z) const;

  /// Preimages of `count` grid points in the interior of the tet, along the third sweep axis.
  void alongLine(std::int32_t level, std::int32_t row, std::int32_t first, std::uint32_t count,
                 Vec3* positions) const;

 private:
  [[nodiscard]] Vec3 inside(std::int32_t level, std::int32_t row, std::int32_t point) const;
  [[nodiscard]] Vec3 rowOrigin(std::int32_t level, std::int32_t row) const;
  [[nodiscard]] Vec3 insideExactly(const lattice::GridPoint& z) const;
  [[nodiscard]] Vec3 onFace(lattice::CornerMask face, const lattice::GridPoint& z) const;
  [[nodiscard]] Vec3 onEdge(lattice::CornerMask edge, const lattice::GridPoint& z) const;
  [[nodiscard]] Vec3 combine(const std::array<double, 4>& weights) const;

  const lattice::LatticeTet& corners_;
  std::int64_t unit_;
  std::array<std::uint8_t, 3> axes_;
  std::array<std::int32_t, 3> first_;  ///< of the box, by sweep axis
  std::array<Vec3, 4> points_;
  Vec3 origin_{};                ///< preimage of the box's first point
  std::array<Vec3, 3> steps_{};  ///< change of the preimage along each sweep axis
  bool illConditioned_ = false;  ///< nearly flat in the map: the affine form would lose digits
};

}  // namespace hexhex::sweep
