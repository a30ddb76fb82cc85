// Fits the transition between two tets to the parameters of their common corners (Section 5.1.1).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <igm/input.hpp>
#include <lattice/grid_motion.hpp>

namespace hexhex::igm {

/// Two edges of a triangle, in the chart of one tet or the other.
using VectorPair = std::array<Vec3, 2>;

/// argmin over the rotations R of |images[0] - R vectors[0]|^2 + |images[1] - R vectors[1]|^2, as
/// far as rounding can tell; the first if there are several.
[[nodiscard]] lattice::Rotation bestRotation(const VectorPair& vectors,
                                             const VectorPair& images) noexcept;

/// The same by comparing all rotations, for tests.
[[nodiscard]] lattice::Rotation bestRotationOfAll(const VectorPair& vectors,
                                                  const VectorPair& images) noexcept;

/// The three corners of an inner triangle in the charts of both its tets.
struct SharedTriangle : adjacency::SharedCorners<Vec3> {
  SharedTriangle(const adjacency::TetTopology& topology, const LocalParameters& parameters,
                 adjacency::HalfFace halfFace) noexcept
      : SharedCorners(topology, halfFace,
                      [&](Index tet, std::size_t corner) { return parameters.at(tet, corner); }) {}
  SharedTriangle(const adjacency::TetTopology& topology, std::span<const TetParameters> parameters,
                 adjacency::HalfFace halfFace) noexcept
      : SharedCorners(topology, halfFace,
                      [&](Index tet, std::size_t corner) { return parameters[tet][corner]; }) {}
};

/// The best rotation for the triangle's edges at its first corner.
[[nodiscard]] lattice::Rotation bestRotation(const SharedTriangle& triangle) noexcept;

/// The rotation across a half-face, if the caller gave it.
/// @param rotations  as in TetMapView
[[nodiscard]] inline std::optional<lattice::Rotation> knownRotation(
    std::span<const std::array<std::int8_t, 4>> rotations, adjacency::HalfFace halfFace) {
  const int known = rotations.empty() ? -1 : rotations[adjacency::tetOf(halfFace)][halfFace % 4];
  if (known < 0 || known >= lattice::Rotation::kCount) return std::nullopt;
  return lattice::rotationFromAlgoHex(known);
}

/// Whether two tets agree on the parameters of the corners of their common face.
[[nodiscard]] bool agree(const adjacency::TetTopology& topology, const LocalParameters& parameters,
                         adjacency::HalfFace halfFace) noexcept;

/// A transition, and how well it fits.
struct FittedTransition {
  lattice::Transition transition;
  double residual = 0;   ///< largest violation of (IGM1), in parameter units
  bool isExact = false;  ///< whether it carries the corners over without rounding
};

/// From the chart here to that there: the best rotation, and the integers nearest to what it
/// leaves.
[[nodiscard]] FittedTransition fitTransition(const SharedTriangle& triangle) noexcept;

/// The same with a given rotation.
[[nodiscard]] FittedTransition fitTransition(const SharedTriangle& triangle,
                                             lattice::Rotation rotation) noexcept;

/// One with each rotation, smallest residual first.
[[nodiscard]] std::vector<FittedTransition> fitAllTransitions(const SharedTriangle& triangle);

}  // namespace hexhex::igm
