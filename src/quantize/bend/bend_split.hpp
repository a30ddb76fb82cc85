// Splits edges whose midpoints are freer than their ends, where a map cannot be bent without
// flipped tets.
#pragma once

#include <span>
#include <vector>

#include <quantize/bend/vertex_unknowns.hpp>

namespace hexhex::quantization {

/// A map during bending.
struct BendState {
  BendProblem problem;
  std::vector<TetParameters> bent;  ///< per tet: current positions of its corners; empty at first
  std::vector<Index> parentTet;
  std::vector<tetmap::VertexPair> splitEdges;
};

/// All tets at the vertices of the given ones, ascending. Needs the topology's stars.
[[nodiscard]] std::vector<Index> withNeighbours(const adjacency::TetTopology& topology,
                                                std::span<const Index> tets);

/// Edges of these tets whose midpoints are freer than their ends; if there are none, such edges of
/// their neighbours; if there are none either, all edges of the tets. Ascending.
[[nodiscard]] std::vector<tetmap::EdgeInTet> edgesToSplit(const BendProblem& problem,
                                                          const adjacency::TetTopology& topology,
                                                          const VertexUnknowns& unknowns,
                                                          std::span<const Index> tets);

/// Splits each edge at its midpoint, one after another, and all tets around it in two: one part
/// keeps the tet's number, the other is appended.
/// @param topology  of the tets; must not be used afterwards
/// @return false, without splitting the remaining edges, once there are more than `mostTets` tets
bool splitEdges(BendState& state, const adjacency::TetTopology& topology,
                std::span<const tetmap::EdgeInTet> edges, std::size_t mostTets);

}  // namespace hexhex::quantization
