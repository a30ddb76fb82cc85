// Where a map cannot be bent without flipped tets, edges are split whose ends are less free than
// their middles.
#pragma once

#include <span>
#include <vector>

#include <quantize/bend/vertex_unknowns.hpp>

namespace hexhex::quantization {

/// A map while it is bent.
struct BendState {
  BendProblem problem;
  std::vector<TetParameters> bent;  ///< per tet: where its corners are now; empty at first
  std::vector<Index> parentTet;
  std::vector<tetmap::VertexPair> splitEdges;
};

/// All tets at the vertices of some, ascending. Needs the stars of the topology.
[[nodiscard]] std::vector<Index> withNeighbours(const adjacency::TetTopology& topology,
                                                std::span<const Index> tets);

/// Edges at which splitting helps, of these tets or, if there are none, of their neighbours; all
/// edges of the tets if there are none, either. Ascending.
[[nodiscard]] std::vector<tetmap::EdgeInTet> edgesToSplit(const BendProblem& problem,
                                                          const adjacency::TetTopology& topology,
                                                          const VertexUnknowns& unknowns,
                                                          std::span<const Index> tets);

/// Puts a vertex in the middle of each edge, one after the other, and cuts the tets at it in two:
/// one keeps its number, the other is appended.
/// @param topology  of the tets; must not be used afterwards
/// @return false if there are more than `mostTets` then: the rest of the edges are left
bool splitEdges(BendState& state, const adjacency::TetTopology& topology,
                std::span<const tetmap::EdgeInTet> edges, std::size_t mostTets);

}  // namespace hexhex::quantization
