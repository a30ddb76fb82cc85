#include <algorithm>
#include <bit>

#include <adjacency/edge_fan.hpp>
#include <quantize/bend/bend_split.hpp>
#include <quantize/bend/edge_turns.hpp>
#include <tetmap/freedom.hpp>
#include <tetmap/tetmap.hpp>

#include <base/vector3.hpp>

namespace hexhex::quantization {

namespace {

/// Number of coordinates of an edge's inner points that boundary planes and transitions around the
/// edge fix.
int fixedCount(const BendProblem& problem, const adjacency::TetTopology& topology, Index tet,
               lattice::CornerMask edge) {
  tetmap::FixedAxes fixed;  // in the chart of the tet
  const auto addPlanes = [&](Index t, lattice::CornerMask ends, const lattice::Transition& chart) {
    for (int face = 0; face < 4; ++face) {
      const adjacency::HalfFace h = adjacency::halfFaceOf(t, face);
      const BoundaryPlane& plane = problem.planes[h];
      if (lattice::contains(ends, face) || !topology.isBoundary(h) || plane.axis < 0) continue;
      fixed.addPlane(plane.axis, chart.rotation);
    }
  };
  addPlanes(tet, edge, {});
  const auto loop = adjacency::visitAroundEdge(
      topology, tet, edge, lattice::Transition{},
      [&](const lattice::Transition& chart, adjacency::HalfFace out) {
        return problem.transitions[out] * chart;
      },
      [&](const auto& turn, const lattice::Transition& chart) {
        addPlanes(turn.tet(), turn.edge(), chart);
        return true;
      });
  if (loop) fixed.addTurn(loop->rotation);
  return std::popcount(fixed.axes());
}

/// Edges whose midpoints have fewer fixed coordinates than both of their ends.
std::vector<tetmap::EdgeInTet> freeingEdges(const BendProblem& problem,
                                            const adjacency::TetTopology& topology,
                                            const VertexUnknowns& unknowns,
                                            std::span<const Index> tets) {
  std::vector<tetmap::EdgeInTet> edges;
  for (const Index t : tets) {
    tetmap::forEachEdgeOf(problem.tets[t],
                          [&](const tetmap::VertexPair& edge, lattice::CornerMask corners) {
                            const int ends = std::min(std::popcount(unknowns.fixed[edge[0]]),
                                                      std::popcount(unknowns.fixed[edge[1]]));
                            if (problem.keptEdges.contains(edge)) return;
                            if (ends > 0 && fixedCount(problem, topology, t, corners) < ends)
                              edges.push_back({edge, t});
                          });
  }
  sortUnique(edges);
  return edges;
}

/// Carries the data of a tet over to both of its parts, which share its chart.
void carryCut(BendState& state, const tetmap::Cut& cut) {
  BendProblem& problem = state.problem;
  tetmap::carryCorners(cut, problem.reference);
  tetmap::carryCorners(cut, state.bent);
  tetmap::carryTet(cut, state.parentTet);
  tetmap::carryFaces(cut, {}, problem.transitions);
  tetmap::carryFaces(cut, {}, problem.planes);
  const auto b = static_cast<adjacency::CornerIndex>(cut.b);
  if (auto fixed = problem.fixedCorners.extract(4 * cut.first + b)) {
    fixed.key() = 4 * cut.second + b;
    problem.fixedCorners.insert(std::move(fixed));
  }
}

}  // namespace

std::vector<Index> withNeighbours(const adjacency::TetTopology& topology,
                                  std::span<const Index> tets) {
  std::vector<Index> around;
  for (const Index t : tets) {
    for (const Index v : topology.tets[t]) {
      for (const adjacency::CornerIndex corner : topology.star(v))
        around.push_back(adjacency::tetOf(corner));
    }
  }
  sortUnique(around);
  return around;
}

std::vector<tetmap::EdgeInTet> edgesToSplit(const BendProblem& problem,
                                            const adjacency::TetTopology& topology,
                                            const VertexUnknowns& unknowns,
                                            std::span<const Index> tets) {
  std::vector<tetmap::EdgeInTet> edges = freeingEdges(problem, topology, unknowns, tets);
  if (!edges.empty()) return edges;
  edges = freeingEdges(problem, topology, unknowns, withNeighbours(topology, tets));
  if (!edges.empty()) return edges;
  for (const Index t : tets) {
    tetmap::forEachEdgeOf(problem.tets[t],
                          [&](const tetmap::VertexPair& edge, lattice::CornerMask /*corners*/) {
                            if (!problem.keptEdges.contains(edge)) edges.push_back({edge, t});
                          });
  }
  sortUnique(edges);
  return edges;
}

bool splitEdges(BendState& state, const adjacency::TetTopology& topology,
                std::span<const tetmap::EdgeInTet> edges, std::size_t mostTets) {
  BendProblem& problem = state.problem;
  tetmap::MutableTets mesh(std::move(problem.tets), topology.mate, problem.points.size());
  for (const tetmap::EdgeInTet& edge : edges) {
    if (mesh.tetCount() > mostTets) break;
    const auto [v, w] = edge.vertices;
    const std::vector<tetmap::Cut> cuts = mesh.splitEdge(edge);
    problem.points.push_back(tetmap::middleOf(problem.points[v], problem.points[w]));
    for (const tetmap::Cut& cut : cuts) carryCut(state, cut);
    splitIrregular(edge.vertices, static_cast<Index>(mesh.vertexCount() - 1),
                   problem.irregularEdges);
    state.splitEdges.push_back(edge.vertices);
  }
  problem.tets = std::move(mesh.tets);
  return problem.tets.size() <= mostTets;
}

}  // namespace hexhex::quantization
