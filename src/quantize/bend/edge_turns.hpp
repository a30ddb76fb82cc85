// The number of turns of a map around each edge. Positive tets alone do not make it locally
// injective: they may wind twice around an interior edge, which is then singular.
#pragma once

#include <span>
#include <vector>

#include <adjacency/tet_topology.hpp>
#include <quantize/bend/bend.hpp>
#include <quantize/seamless/cut_graph.hpp>

namespace hexhex::quantization {

/// The edges with an irregular number of turns.
/// @tparam Corners  as in quartersAround()
template <class Corners>
[[nodiscard]] IrregularEdges irregularEdges(const adjacency::EdgeFans& edges,
                                            std::span<const Tet> tets,
                                            std::span<const Corners> map) {
  const std::vector<int> quarters = quartersAround(edges, map);
  IrregularEdges irregular;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (quarters[e] == regularQuarters(edges, e)) continue;
    const adjacency::EdgeCorner& at = edges(e).front();
    irregular[{tets[at.tet][at.corner0], at.other}] = quarters[e];
  }
  return irregular;
}

/// Passes the turns of a split edge on to both halves.
/// @param middle  the new vertex
void splitIrregular(const tetmap::VertexPair& edge, Index middle, IrregularEdges& irregular);

/// Tets at edges around which a map makes a different number of turns than expected, ascending.
/// Boundary triangles must lie in grid planes, so that turns are multiples of a right angle. Needs
/// the topology's stars.
[[nodiscard]] std::vector<Index> tetsAtOtherTurns(const adjacency::TetTopology& topology,
                                                  const IrregularEdges& expected,
                                                  std::span<const TetParameters> map, Stage& stage);

}  // namespace hexhex::quantization
