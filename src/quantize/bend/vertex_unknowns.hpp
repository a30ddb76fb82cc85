// The coordinates of vertices that integers leave free, and how the positions of corners follow
// from them.
//
// Each vertex has a representative: its corner in the smallest tet at it. Transitions carry that
// point to all other corners of the vertex. Where two paths give different transitions (around
// singular edges), the point is a fixed point of the motion between them; boundary triangles fix a
// coordinate. The point is free along the remaining axes of the representative's chart.
#pragma once

#include <vector>

#include <adjacency/tet_topology.hpp>
#include <quantize/bend/bend.hpp>

namespace hexhex::quantization {

struct VertexUnknowns {
  std::vector<lattice::AxisSet> fixed;  ///< per vertex: fixed axes of the representative's chart
  std::vector<Vec3> fixedPosition;      ///< per vertex: integers along fixed axes, 0 along others
  std::vector<lattice::Transition>
      toCorner;                       ///< per corner: from the representative's chart to its own
  std::vector<Index> contradictions;  ///< vertices without such a solution, ascending
};

[[nodiscard]] VertexUnknowns findUnknowns(const BendProblem& problem,
                                          const adjacency::TetTopology& topology, Stage& stage);

}  // namespace hexhex::quantization
