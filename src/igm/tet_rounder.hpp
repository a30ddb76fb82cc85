// Rounding to the lattice of corners that do not depend on others: single ones, and those of all
// tets (Section 5.1.3).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <base/pair.hpp>
#include <base/vector3.hpp>
#include <igm/exact_map.hpp>

namespace hexhex {

/// By how much a coordinate changes at most.
/// @param after  in units of the lattice
/// @param resolution  1 / unit, exact
[[nodiscard]] inline double displacementOf(const Vec3& before, const Vec3& after,
                                           double resolution) {
  const Pair xy = magnitudeOf(loadPair(&after[0]) * resolution - loadPair(&before[0]));
  return std::max(std::max(xy[0], xy[1]), std::abs(after[2] * resolution - before[2]));
}

/// What corners are rounded to, in units of the lattice.
class Grains {
 public:
  explicit Grains(double unit) {
    // As nearestMultiples() wants them: for multiples of 1.
    for (Vec3& grains : large_) grains = {0x1p52, 0x1p52, 0x1p52};
    for (std::size_t axis = 0; axis < 3; ++axis) large_[std::size_t{1} << axis][axis] *= unit;
    // Left as they are, and so not displaced.
    large_.back() = {0, 0, 0};
  }
  /// By axis.
  [[nodiscard]] const Vec3& at(Rounding rounding) const noexcept {
    return large_[static_cast<std::size_t>(rounding)];
  }

 private:
  std::array<Vec3, static_cast<std::size_t>(Rounding::ByStar) + 1> large_{};
};

/// Rounds corners at regular and flat vertices.
class CornerRounder {
 public:
  CornerRounder(const TetTopology& topology, double tolerance, DefectCollector& defects,
                ExactMap& map)
      : topology_(topology),
        tolerance_(tolerance),
        defects_(defects),
        map_(map),
        unit_(static_cast<double>(map.unit)),
        resolution_(1 / unit_),
        grains_(unit_) {}

  /// @param rounding  other than by the star
  void run(CornerIndex index, const Vec3& u, Rounding rounding) {
    const Vec3& large = grains_.at(rounding);
    const Pair xy = nearestMultiples(loadPair(&u[0]) * unit_, loadPair(&large[0]));
    const Pair z = nearestMultiples(Pair{u[2], u[2]} * unit_, Pair{large[2], large[2]});
    const Vec3 rounded = {xy[0], xy[1], z[0]};
    LatticePoint& corner = map_.corners[index / 4][index % 4];
    for (std::size_t k = 0; k < 3; ++k) corner[k] = static_cast<std::int64_t>(rounded[k]);
    const double displacement = displacementOf(u, rounded, resolution_);
    maxDisplacement_ = std::max(maxDisplacement_, displacement);
    // The same at all corners of the vertex, and to be reported once.
    const Index vertex = topology_.vertex(index);
    if (displacement > tolerance_ && topology_.vertexTet[vertex] == tetOf(index)) {
      defects_.add(rounding != Rounding::Free ? ErrorCode::BoundaryOffLattice
                                              : ErrorCode::TransitionResidual,
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
  Grains grains_;
  double maxDisplacement_ = 0;
};

struct RoundedTets {
  /// Those with corners that are decided by stars, and those that are not certainly positive; in
  /// ascending order, in lists to be worked on in parallel.
  std::vector<std::vector<Index>> unfinished;
  Int192 sixfoldVolume;  ///< of all others, if asked for
};

/// Rounds corners at regular and flat vertices, and others in vain where a star decides, and
/// updates map.maxDisplacement.
/// @param rounding  per vertex
/// @param tolerance  larger displacements are defects
[[nodiscard]] RoundedTets roundTets(const TetTopology& topology, const LocalParameters& parameters,
                                    std::span<const Rounding> rounding, double tolerance,
                                    bool measureVolume, Stage& stage, DefectCollector& defects,
                                    ExactMap& map);

}  // namespace hexhex
