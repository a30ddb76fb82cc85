// Charts: where they are, and how those of neighbouring tets differ (Section 5.1.1).
#pragma once

#include <cmath>
#include <vector>

#include <hexhex/types.hpp>

#include <lattice/transition.hpp>
#include <map/tet_topology.hpp>

namespace hexhex {

/// Parameters near the origin. Charts may sit far away (translations of 1e9 occur), which would
/// cost fractional bits: each tet's chart is therefore moved by a multiple of `grid`, exactly. The
/// grid is coarse, so that neighbours in one chart nearly always move alike and identity
/// transitions stay identities.
class LocalParameters {
 public:
  LocalParameters(const TetMapView& map, Stage& stage, DefectCollector& defects);

  [[nodiscard]] Vec3 operator()(Index tet, int corner) const noexcept {
    const TetParameters& parameters = parameters_[tet];
    Vec3 u = parameters[static_cast<std::size_t>(corner)];
    if (!moved_) return u;
    for (std::size_t k = 0; k < 3; ++k) {
      u[k] -= std::nearbyint(parameters[0][k] / grid_) * grid_;
    }
    return u;
  }
  /// Largest magnitude of a coordinate.
  [[nodiscard]] double largest() const noexcept { return largest_; }

 private:
  std::span<const TetParameters> parameters_;
  double grid_ = 0;
  double largest_ = 0;
  bool moved_ = false;
};

struct Transitions {
  /// Per half-face: index in `table` of the transition into the neighbour's chart; 0, the identity,
  /// is by far the most frequent.
  Array<Index> jump;
  std::vector<Transition> table;
  double maxResidual = 0;   ///< largest violation of (IGM1), in parameter units
  std::uint64_t jumps = 0;  ///< inner faces whose transition is not the identity
  std::uint64_t innerFaces = 0;

  /// From the chart of the half-face's tet to that of its mate.
  [[nodiscard]] const Transition& across(HalfFace halfFace) const noexcept {
    return table[jump[halfFace]];
  }
  [[nodiscard]] bool isJump(HalfFace halfFace) const noexcept { return jump[halfFace] != 0; }
};

/// @param rotations  what the caller knows, as in TetMapView; may be empty
/// @param tolerance  residuals above it are defects
[[nodiscard]] Transitions computeTransitions(const TetTopology& topology,
                                             const LocalParameters& parameters,
                                             std::span<const std::array<std::int8_t, 4>> rotations,
                                             double tolerance, Stage& stage,
                                             DefectCollector& defects);

}  // namespace hexhex
