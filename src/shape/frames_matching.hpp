// Matches axes of neighbouring frames, and finds the singular curves that result.
//
// A rotation of the grid maps coordinates in a tet's frame to those in its neighbour's. The product
// of rotations around an inner edge is the identity unless the edge is singular: a quarter turn
// where three or five hexahedra meet, a half turn (two or six), or a turn about a diagonal of the
// grid, which no hexahedral mesh has.
//
// M. Nieser, U. Reitebuch, K. Polthier, "CubeCover - Parameterization of 3D Volumes", Computer
// Graphics Forum 30 (2011).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <shape/frames_tets.hpp>

#include <hexhex/error.hpp>

#include <lattice/direction.hpp>
#include <lattice/rotation.hpp>

namespace hexhex::shape {

[[nodiscard]] inline Eigen::Vector3d vectorOf(lattice::Direction direction) {
  return lattice::signOf(direction) * Eigen::Vector3d::Unit(lattice::axisOf(direction));
}

/// How well a rotation maps one frame to another; 3 for an exact match.
[[nodiscard]] double likeness(const Frame& here, const Frame& there, lattice::Rotation rotation);

/// Chooses the rotations that turn least.
void matchFrames(FrameTets& tets, Stage& stage);

/// The rotation around an edge.
struct EdgeTurning {
  enum class Kind : std::uint8_t { Regular, Three, Five, HalfTurn, Compound };
  Kind kind = Kind::Regular;
  double alignment = 1;  ///< mean cosine between the edge and the axis of a quarter turn
};
/// @param edge  an inner edge
[[nodiscard]] EdgeTurning turningAt(const FrameTets& tets, const EdgeWalks& walks,
                                    std::size_t edge);

/// Number of hexahedra at a boundary edge, 1 to 3; 0 if the boundary turns back there, or about
/// another axis than the edge.
[[nodiscard]] int boundaryValence(const FrameTets& tets, const EdgeWalks& walks, std::size_t edge);

/// The signed frame axis closest to the normal of a boundary triangle.
[[nodiscard]] lattice::Direction normalDirection(const FrameTets& tets, adjacency::HalfFace h);

/// Whether this many singular curves of valence 3 and 5 may meet at an inner vertex. A curve that
/// passes through counts twice.
[[nodiscard]] bool isNode(int threes, int fives);

/// A reason why no hexahedral mesh follows a field.
struct FieldDefect {
  enum class Kind : std::uint8_t {
    Compound,  ///< an edge with a turn about a diagonal
    Zipper,    ///< a vertex where curves meet as in no hexahedral mesh, !isNode(): one of valence 3
               ///< turns into one of valence 5 or ends, for example
    Boundary,  ///< a boundary edge with a turn that no hexahedra fit
    Flat,      ///< a triangle with three singular edges: they cannot all be parallel to axes
    HalfTurn,  ///< an edge where two curves of equal valence have merged, mostly unusable
  };
  Kind kind = Kind::Compound;
  VertexPair edge{};  ///< of a zipper: its vertex twice; of a triangle: one of its edges

  [[nodiscard]] bool operator==(const FieldDefect&) const = default;
};
[[nodiscard]] std::vector<FieldDefect> defectsOf(const FrameTets& tets, const EdgeWalks& walks);

}  // namespace hexhex::shape
