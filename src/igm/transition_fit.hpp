// The transition between two tets that fits the parameters of their common corners best.
#pragma once

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <igm/local_parameters.hpp>
#include <lattice/transition.hpp>

namespace hexhex {

/// Whether two tets agree on the parameters of the corners of their common face.
[[nodiscard]] bool agree(const TetTopology& topology, const LocalParameters& parameters,
                         HalfFace here, HalfFace there);

/// A transition, and how well it does.
struct FittedTransition {
  Transition transition;
  double residual = 0;   ///< largest violation of (IGM1), in parameter units
  bool isExact = false;  ///< whether it carries the corners over without rounding
};

/// From the chart of the tet `here` belongs to, to that of its mate: the best rotation, and the
/// integers nearest to what is left then (Section 5.1.1).
[[nodiscard]] FittedTransition fitTransition(const TetTopology& topology,
                                             const LocalParameters& parameters, HalfFace here,
                                             HalfFace there);

/// The same with a rotation that is known.
[[nodiscard]] FittedTransition fitTransition(const TetTopology& topology,
                                             const LocalParameters& parameters, HalfFace here,
                                             HalfFace there, Rotation rotation);

}  // namespace hexhex
