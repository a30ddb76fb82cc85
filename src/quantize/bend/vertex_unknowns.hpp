// Which coordinates of a seamless map's vertices do its integers fix, and how do all corners follow
// from the others?
//
// Each vertex has a representative: its corner in the smallest tet at it. Transitions carry that
// point to all other corners of the vertex. Where two ways around lead to different transitions
// (around singular edges), the point is a fixed point of what is between them; boundary triangles
// fix a coordinate. What remains is free along some axes of the representative's chart.
#pragma once

#include <vector>

#include <adjacency/tet_topology.hpp>
#include <quantize/bend/bend.hpp>

namespace hexhex::quantization {

struct VertexUnknowns {
  std::vector<lattice::AxisSet> fixed;  ///< per vertex: axes of the representative's chart
  std::vector<Vec3> fixedPosition;      ///< per vertex: integers along these, 0 along the others
  std::vector<lattice::Transition>
      toCorner;                       ///< per corner: from the representative's chart into its own
  std::vector<Index> contradictions;  ///< vertices for which there is no such point, ascending
};

[[nodiscard]] VertexUnknowns findUnknowns(const BendProblem& problem,
                                          const adjacency::TetTopology& topology, Stage& stage);

}  // namespace hexhex::quantization
