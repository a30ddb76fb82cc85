// Transitions between the charts of neighbouring tets (Section 5.1.1).
#pragma once

#include <span>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <igm/half_face_transition.hpp>
#include <igm/input.hpp>
#include <igm/regular_vertices.hpp>
#include <lattice/grid_motion.hpp>

namespace hexhex::igm {

struct Transitions {
  /// Per half-face: index in `table` of the transition into the neighbour's chart; 0, the identity,
  /// is by far the most frequent.
  Array<Index> ofFace;
  Array<lattice::Transition> table;
  /// Per entry of the table: its half-face. kNone for the identity.
  Array<adjacency::HalfFace> halfFaces;
  /// Per entry of the table: 1 if it carries the triangle's parameters over without rounding. 0 for
  /// the identity, because of triangles for which it is merely the best fit.
  Array<std::uint8_t> isExact;
  double maxResidual = 0;        ///< largest violation of (IGM1), in parameter units
  std::uint64_t nonTrivial = 0;  ///< inner faces whose transition is not the identity
  std::uint64_t innerFaces = 0;

  /// Triangles whose residual is above the tolerance.
  struct Misfit {
    adjacency::HalfFace halfFace;
    double residual;
  };
  std::vector<Misfit> misfits;

  /// From the chart of the half-face's tet to that of its mate.
  [[nodiscard]] const lattice::Transition& across(adjacency::HalfFace halfFace) const noexcept {
    return table[ofFace[halfFace]];
  }
  /// The index in `table` of the inverse: the two are adjacent there.
  [[nodiscard]] static constexpr Index inverse(Index index) noexcept {
    return index == 0 ? 0 : ((index - 1) ^ 1U) + 1;
  }
  [[nodiscard]] bool isNonTrivial(adjacency::HalfFace halfFace) const noexcept {
    return ofFace[halfFace] != 0;
  }
};

/// @param regular  knows where tets differ
/// @param rotations  given by the caller, as in TetMapView; may be empty
/// @param tolerance  larger residuals are misfits
[[nodiscard]] Transitions computeTransitions(const adjacency::TetTopology& topology,
                                             const LocalParameters& parameters,
                                             const RegularVertices& regular,
                                             std::span<const std::array<std::int8_t, 4>> rotations,
                                             double tolerance, Stage& stage);

/// Per half-face. Inexact are all faces of a tet with uncertain sides, and those on which tets
/// disagree unless a transition fits exactly.
/// @param transitions  may be empty: if parameters are too large, they are not known
[[nodiscard]] Array<HalfFaceTransition> findHalfFaceTransitions(
    const adjacency::TetTopology& topology, const RegularVertices& regular,
    const Transitions& transitions, Stage& stage);

/// Reports misfits. Separate, as they are not worth reporting if the mesh is not a manifold.
void collectMisfits(const Transitions& transitions, DefectCollector& defects);

}  // namespace hexhex::igm
