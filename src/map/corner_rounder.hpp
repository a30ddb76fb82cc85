// Rounding of single corners to the lattice.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>

#include <base/vector3.hpp>
#include <map/exact_map.hpp>

namespace hexhex {

/// By how much a coordinate changes at most.
/// @param resolution  1 / unit, exact
[[nodiscard]] inline double displacementOf(const Vec3& before, const LatticePoint& after,
                                           double resolution) {
  double displacement = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    displacement =
        std::max(displacement, std::abs(static_cast<double>(after[k]) * resolution - before[k]));
  }
  return displacement;
}

/// Rounds corners at plain vertices, and at others with flat stars.
class CornerRounder {
 public:
  CornerRounder(const TetTopology& topology, double tolerance, DefectCollector& defects,
                ExactMap& map)
      : topology_(topology),
        tolerance_(tolerance),
        defects_(defects),
        map_(map),
        unit_(static_cast<double>(map.unit)),
        resolution_(1 / unit_) {}

  /// @param plane  of the boundary: bit k across axis k, or 0
  void run(CornerIndex index, const Vec3& u, unsigned plane) {
    LatticePoint& corner = map_.corners[index / 4][index % 4];
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = static_cast<std::int64_t>(nearestInteger(u[k] * unit_));
    }
    if (plane != 0) {
      const auto axis = static_cast<std::size_t>(std::countr_zero(plane));
      corner[axis] = static_cast<std::int64_t>(nearestInteger(u[axis])) * map_.unit;
    }
    const double displacement = displacementOf(u, corner, resolution_);
    maxDisplacement_ = std::max(maxDisplacement_, displacement);
    // The same at all corners of the vertex, and to be reported once.
    const Index vertex = topology_.vertex(index);
    if (displacement > tolerance_ && topology_.vertexTet[vertex] == tetOf(index)) {
      defects_.add(plane != 0 ? ErrorCode::BoundaryOffLattice : ErrorCode::TransitionResidual,
                   {PlaceKind::Vertex, vertex}, displacement);
    }
  }

  [[nodiscard]] double maxDisplacement() const noexcept { return maxDisplacement_; }

 private:
  const TetTopology& topology_;
  double tolerance_;
  DefectCollector& defects_;
  ExactMap& map_;
  double unit_;
  double resolution_;
  double maxDisplacement_ = 0;
};

}  // namespace hexhex
