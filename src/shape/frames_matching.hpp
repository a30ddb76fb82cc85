// Which axes of neighbouring frames belong together, and where that makes singular curves.
//
// A rotation of the grid takes coordinates of a tet's frame to those of its neighbour's. Around an
// inner edge they multiply to one: of a quarter about the edge where three or five hexahedra meet,
// of a half (two or six), or about a diagonal of the grid, where none do.
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

/// How well a rotation takes one frame to another: 3 if it does.
[[nodiscard]] double likeness(const Frame& here, const Frame& there, lattice::Rotation rotation);

/// Those that turn least.
void matchFrames(FrameTets& tets, Stage& stage);

/// What happens around an edge.
struct EdgeTurning {
  enum class Kind : std::uint8_t { Regular, Three, Five, HalfTurn, Compound };
  Kind kind = Kind::Regular;
  double alignment = 1;  ///< of the axis of a quarter turn with the edge: the mean cosine
};
/// @param edge  inside
[[nodiscard]] EdgeTurning turningAt(const FrameTets& tets, const EdgeWalks& walks,
                                    std::size_t edge);

/// Hexahedra at an edge of the boundary: 1 to 3; 0 if the boundary turns back there, or about
/// another axis than the edge.
[[nodiscard]] int boundaryValence(const FrameTets& tets, const EdgeWalks& walks, std::size_t edge);

/// The signed axis of a frame that is nearest to a boundary triangle's normal.
[[nodiscard]] lattice::Direction normalDirection(const FrameTets& tets, adjacency::HalfFace h);

/// Whether so many singular curves may meet at a vertex inside, of valence 3 and of valence 5. A
/// curve that goes on counts twice.
[[nodiscard]] bool isNode(int threes, int fives);

/// Why there is no hexahedral mesh along a field.
struct FieldDefect {
  enum class Kind : std::uint8_t {
    Compound,  ///< an edge around which charts turn about a diagonal
    Zipper,    ///< a vertex where curves meet as in no hexahedral mesh, !isNode(): one of valence 3
               ///< becomes one of valence 5, say, or ends
    Boundary,  ///< an edge at which the boundary turns as no hexahedra do
    Flat,      ///< a triangle with three singular edges: no map has all of them along axes
    HalfTurn,  ///< an edge where two curves of one valence have become one, mostly of no use
  };
  Kind kind = Kind::Compound;
  VertexPair edge{};  ///< of a zipper: its vertex twice; of a triangle: one of its edges

  [[nodiscard]] bool operator==(const FieldDefect&) const = default;
};
[[nodiscard]] std::vector<FieldDefect> defectsOf(const FrameTets& tets, const EdgeWalks& walks);

}  // namespace hexhex::shape
