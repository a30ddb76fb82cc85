#include <algorithm>
#include <bit>

#include <adjacency/edge_fan.hpp>
#include <quantize/bend/bend_split.hpp>
#include <quantize/bend/edge_turns.hpp>

#include <base/vector3.hpp>

namespace hexhex::quantization {

namespace {

/// How many coordinates of an edge's inner points are fixed, by what is around the edge.
int fixedCount(const BendProblem& problem, const adjacency::TetTopology& topology, Index tet,
               lattice::CornerMask edge) {
  lattice::AxisSet axes = 0;  // in the chart of the tet
  const auto addPlanes = [&](Index t, lattice::CornerMask ends, const lattice::Transition& chart) {
    for (int face = 0; face < 4; ++face) {
      const adjacency::HalfFace h = adjacency::halfFaceOf(t, face);
      const BoundaryPlane& plane = problem.planes[h];
      if (lattice::contains(ends, face) || !topology.isBoundary(h) || plane.axis < 0) continue;
      axes |= lattice::imageOf(1U << plane.axis, chart.rotation.inverse());
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
  for (int axis = 0; axis < 3; ++axis) {
    const lattice::Direction d = lattice::direction(axis, 1);
    if (loop && (*loop)(d) != d) axes |= 1U << axis;
  }
  return std::popcount(axes);
}

/// Edges whose middles are freer than both of their ends.
std::vector<SplitEdge> freeingEdges(const BendProblem& problem,
                                    const adjacency::TetTopology& topology,
                                    const VertexUnknowns& unknowns, std::span<const Index> tets) {
  std::vector<SplitEdge> edges;
  for (const Index t : tets) {
    forEachEdgeOf(problem.tets[t], [&](const SplitEdge& edge, lattice::CornerMask corners) {
      const int ends =
          std::min(std::popcount(unknowns.fixed[edge[0]]), std::popcount(unknowns.fixed[edge[1]]));
      if (problem.keptEdges.contains(edge)) return;
      if (ends > 0 && fixedCount(problem, topology, t, corners) < ends) edges.push_back(edge);
    });
  }
  sortOut(edges);
  return edges;
}

/// What a tet that was cut and its second half, the last one, have of it.
void carryCut(BendState& state, Index t, std::size_t a, std::size_t b) {
  BendProblem& problem = state.problem;
  for (std::vector<TetParameters>* corners : {&problem.reference, &state.bent}) {
    const Vec3 between = middle((*corners)[t][a], (*corners)[t][b]);
    corners->push_back((*corners)[t]);
    (*corners)[t][b] = between;
    corners->back()[a] = between;
  }
  state.parentTet.push_back(state.parentTet[t]);
  // Both halves keep what is across their faces; between them there is one chart.
  const std::size_t second = problem.tets.size() - 1;
  for (std::size_t face = 0; face < 4; ++face) {
    problem.transitions.push_back(problem.transitions[4 * t + face]);
    problem.planes.push_back(problem.planes[4 * t + face]);
  }
  for (const std::size_t inner : {4 * std::size_t{t} + a, 4 * second + b}) {
    problem.transitions[inner] = {};
    problem.planes[inner] = {};
  }
  if (auto fixed = problem.fixedCorners.extract(static_cast<adjacency::CornerIndex>(4 * t + b))) {
    fixed.key() = static_cast<adjacency::CornerIndex>(4 * second + b);
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
  sortOut(around);
  return around;
}

std::vector<SplitEdge> edgesToSplit(const BendProblem& problem,
                                    const adjacency::TetTopology& topology,
                                    const VertexUnknowns& unknowns, std::span<const Index> tets) {
  std::vector<SplitEdge> edges = freeingEdges(problem, topology, unknowns, tets);
  if (!edges.empty()) return edges;
  edges = freeingEdges(problem, topology, unknowns, withNeighbours(topology, tets));
  if (!edges.empty()) return edges;
  for (const Index t : tets) {
    forEachEdgeOf(problem.tets[t], [&](const SplitEdge& edge, lattice::CornerMask /*corners*/) {
      if (!problem.keptEdges.contains(edge)) edges.push_back(edge);
    });
  }
  sortOut(edges);
  return edges;
}

bool splitEdges(BendState& state, std::span<const SplitEdge> edges, std::size_t mostTets) {
  BendProblem& problem = state.problem;
  EdgeSplitter splitter(problem.points, problem.tets);
  for (const SplitEdge& edge : edges) {
    if (problem.tets.size() > mostTets) return false;
    const Index vertex = splitter.split(
        edge, [&](Index t, std::size_t a, std::size_t b) { carryCut(state, t, a, b); });
    splitIrregular(edge, vertex, problem.irregularEdges);
    state.splitEdges.push_back(edge);
  }
  return problem.tets.size() <= mostTets;
}

}  // namespace hexhex::quantization
