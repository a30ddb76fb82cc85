// Which coordinates of a seamless map's vertices do the integers fix, and how do all corners follow
// from the others?
//
// Each vertex has a representative: its corner in the smallest tet at it. Transitions carry that
// point to all other corners of the vertex. Where two paths give different transitions (around
// singular edges), the point is a fixed point of the motion between them; boundary triangles fix a
// coordinate. What remains is free along some axes of the representative's chart.
#pragma once

#include <vector>

#include <adjacency/tet_topology.hpp>
#include <quantize/bend/bend.hpp>

namespace hexhex::quantization {

struct VertexUnknowns {
  std::vector<lattice::AxisSet> fixed;  ///< per vertex: fixed axes of the representative's chart
  std::vector<Vec3> fixedPosition;      ///< per vertex: integers along these, 0 along others
  std::vector<lattice::Transition>
      toCorner;                       ///< per corner: from the representative's chart to its own
  std::vector<Index> contradictions;  ///< vertices without such a point, ascending
};

[[nodiscard]] VertexUnknowns findUnknowns(const BendProblem& problem,
                                          const adjacency::TetTopology& topology, Stage& stage);

}  // namespace hexhex::quantization
