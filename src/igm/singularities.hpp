// Singular edges and vertices of a map, from the sums of parametric dihedral angles
// (Section 5.1.2).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <adjacency/tet_topology.hpp>
#include <tetmap/freedom.hpp>

#include <hexhex/types.hpp>

#include <igm/irregular_vertices.hpp>

namespace hexhex::igm {

/// A tet edge with a number of hexahedra around it other than 4 (inside) or 2 (on the boundary).
struct SingularEdge {
  Index vertex0;  ///< smaller
  Index vertex1;
  Index tet;  ///< the smallest tet at the edge
  std::uint8_t corner0;
  std::uint8_t corner1;
  bool boundary;
  std::int32_t valence;
};

struct Singularities {
  std::vector<SingularEdge> edges;  ///< in lexicographic order of vertices

  /// By vertex (+1): where its edges begin in `incident`. Empty until they are known.
  Array<Index> begin;
  Array<Index> incident;  ///< indices of edges, at each of their two vertices, ascending there

  [[nodiscard]] bool areKnown() const noexcept { return !begin.empty(); }

  [[nodiscard]] std::span<const Index> at(Index vertex) const noexcept {
    return std::span(incident).subspan(begin[vertex], degree(vertex));
  }
  [[nodiscard]] Index degree(Index vertex) const noexcept {
    return begin[vertex + 1] - begin[vertex];
  }

  [[nodiscard]] bool isNode(Index vertex) const noexcept {
    return tetmap::FixedAxes::isNode(degree(vertex));
  }
};

/// Examines the stars of irregular vertices. Returns nothing if an edge or vertex turns out not to
/// be manifold.
/// @param vertices  from classifyVertices()
/// @param known  valence offsets given by the caller, or empty
[[nodiscard]] std::optional<Singularities> computeSingularities(
    const adjacency::TetTopology& topology, const LocalParameters& parameters,
    const RegularVertices& regular, std::span<const HalfFaceTransition> faceTransitions,
    const VertexKinds& vertices, std::span<const EdgeValence> known, Stage& stage);

}  // namespace hexhex::igm
