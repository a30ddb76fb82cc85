// Which transitions fit a triangle.
#pragma once

#include <array>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <igm/local_parameters.hpp>
#include <lattice/transition.hpp>

namespace hexhex {

/// The three corners of a triangle in the charts of both its tets.
struct FacingTriangles {
  std::array<Vec3, 3> here;
  std::array<Vec3, 3> there;
};

/// @param halfFace  inner
[[nodiscard]] FacingTriangles facingTriangles(const TetTopology& topology,
                                              const LocalParameters& parameters, HalfFace halfFace);

struct FittedTransition {
  double residual = 0;  ///< largest distance of a coordinate
  Transition transition;
};

/// The integer translation that fits best with a rotation, and what remains.
[[nodiscard]] FittedTransition fitTransition(const FacingTriangles& triangles, Rotation rotation);

/// The same for all rotations, best first.
[[nodiscard]] std::vector<FittedTransition> fitAllTransitions(const FacingTriangles& triangles);

}  // namespace hexhex
