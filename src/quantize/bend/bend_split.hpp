// Splits edges whose ends are less free than their midpoints, where a map cannot be bent without
// flipped tets.
#pragma once

#include <span>
#include <vector>

#include <quantize/bend/vertex_unknowns.hpp>

namespace hexhex::quantization {

/// A map during bending.
struct BendState {
  BendProblem problem;
  std::vector<TetParameters> bent;  ///< per tet: where its corners are now; empty at first
  std::vector<Index> parentTet;
  std::vector<tetmap::VertexPair> splitEdges;
};

/// All tets at the vertices of the given ones, ascending. Needs the topology's stars.
[[nodiscard]] std::vector<Index> withNeighbours(const adjacency::TetTopology& topology,
                                                std::span<const Index> tets);

/// Edges of these tets where splitting helps; if there are none, such edges of their neighbours; if
/// there are none either, all edges of the tets. Ascending.
[[nodiscard]] std::vector<tetmap::EdgeInTet> edgesToSplit(const BendProblem& problem,
                                                          const adjacency::TetTopology& topology,
                                                          const VertexUnknowns& unknowns,
                                                          std::span<const Index> tets);

/// Puts a vertex in the middle of each edge, one after another, and cuts the tets around it in two:
/// one keeps its number, the other is appended.
/// @param topology  of the tets; must not be used afterwards
/// @return false, with the remaining edges left as they are, once there are more than `mostTets`
///         tets
bool splitEdges(BendState& state, const adjacency::TetTopology& topology,
                std::span<const tetmap::EdgeInTet> edges, std::size_t mostTets);

}  // namespace hexhex::quantization
