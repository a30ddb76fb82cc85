// Classifies the vertices that are not certainly regular, by their stars (Section 5.1.2).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <igm/regular_vertices.hpp>
#include <igm/vertex_star.hpp>

namespace hexhex::igm {

enum class VertexKind : std::uint8_t {
  Regular,   ///< as RegularVertices finds it, or isolated
  Flat,      ///< regular, except that charts differ
  Irregular  ///< everything else: singular, between boundary planes, or not certainly regular
};

/// How the corners at a vertex are rounded to the lattice.
enum class Rounding : std::uint8_t {
  Free = 0,    ///< each on its own
  Plane0 = 1,  ///< likewise, but to an integer along axis 0,
  Plane1 = 2,  ///< 1,
  Plane2 = 4,  ///< or 2, in all charts
  ByStar = 8   ///< corner by corner, as the star says
};

/// The stars of the irregular vertices in a range of vertices.
struct StarBlock {
  std::vector<Index> vertices;
  /// Per vertex: the axes across its boundary faces in the chart of its first member.
  std::vector<lattice::AxisSet> planes;
  std::vector<std::size_t> ends;  ///< per vertex: where its members end
  Array<VertexStar::Member> members;

  /// A corner at a flat vertex on the boundary, and how it is rounded in its chart.
  struct PlaneCorner {
    adjacency::CornerIndex corner;
    Rounding rounding;
  };
  std::vector<PlaneCorner> planeCorners;

  std::size_t cornersSeen = 0;  ///< in the stars of all irregular and flat vertices

  /// Makes room for this many vertices.
  void reserve(std::size_t count) {
    vertices.reserve(count);
    planes.reserve(count);
    ends.reserve(count);
  }
  void add(Index vertex, std::span<const VertexStar::Member> star, lattice::AxisSet planesOfStar) {
    vertices.push_back(vertex);
    planes.push_back(planesOfStar);
    members.insert(members.end(), star.begin(), star.end());
    ends.push_back(members.size());
  }
  [[nodiscard]] std::span<const VertexStar::Member> star(std::size_t i) const noexcept {
    const std::size_t begin = i == 0 ? 0 : ends[i - 1];
    return std::span(members).subspan(begin, ends[i] - begin);
  }
};

struct VertexKinds {
  Array<VertexKind> kind;         ///< per vertex
  Array<Rounding> rounding;       ///< per vertex
  std::vector<StarBlock> blocks;  ///< ascending
};

/// Finds the flat vertices, and keeps the stars of the irregular ones.
///
/// A star is flat if its tets, brought into one chart by exact transitions, are those of a regular
/// vertex (regular_vertices.hpp): the transitions carry the parameters of common corners over
/// without rounding, all paths through the star lead to the same chart, and the boundary is in one
/// axis-parallel plane through the vertex. Everything said of regular vertices then holds. Only the
/// direction that must be covered once is brought into that chart, by rotations, which is exact.
/// Rounding to the lattice commutes with exact transitions, so corners may be rounded each in its
/// own chart. (Without this test, whole extractions take 6 to 17 % longer where hexahedra are few.)
///
/// @param known  valence offsets given by the caller, or empty; their vertices become irregular
/// @param findFlat  if false, flat stars count as irregular
[[nodiscard]] VertexKinds classifyVertices(const adjacency::TetTopology& topology,
                                           const LocalParameters& parameters,
                                           const RegularVertices& regular,
                                           std::span<const HalfFaceTransition> faceTransitions,
                                           std::span<const EdgeValence> known, bool findFlat,
                                           Stage& stage);

}  // namespace hexhex::igm
