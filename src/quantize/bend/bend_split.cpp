#include <algorithm>
#include <bit>

#include <quantize/bend/bend_split.hpp>
#include <quantize/bend/edge_turns.hpp>

#include <base/vector3.hpp>

namespace hexhex::quantization {

namespace {

/// How many coordinates of an edge's inner points are fixed, by what is around the edge.
class EdgeReader {
 public:
  EdgeReader(const BendProblem& problem, const adjacency::TetTopology& topology)
      : problem_(problem), topology_(topology) {}

  int fixedCount(Index tet, lattice::CornerMask edge) {
    axes_ = 0;
    const int first = std::countr_zero(unsigned{edge} ^ lattice::kWholeTet);
    if (!turn(tet, edge, first)) turn(tet, edge, adjacency::otherFaceAtEdge(edge, first));
    return std::popcount(axes_);
  }

 private:
  /// @return whether the turn came back to where it began
  bool turn(Index tet, lattice::CornerMask edge, int face) {
    lattice::Transition chart;
    adjacency::EdgeTurn turn(topology_, tet, edge, face);
    while (turn.next() != kNone) {
      chart = problem_.transitions[turn.out()] * chart;
      turn.step();
      if (turn.tet() != tet) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const lattice::Direction d = lattice::direction(axis, 1);
        if (chart(d) != d) axes_ |= 1U << axis;
      }
      return true;
    }
    const BoundaryPlane& plane = problem_.planes[turn.out()];
    if (plane.axis >= 0) axes_ |= lattice::imageOf(1U << plane.axis, chart.rotation.inverse());
    return false;
  }

  const BendProblem& problem_;
  const adjacency::TetTopology& topology_;
  lattice::AxisSet axes_ = 0;  ///< in the chart of the tet
};

/// Edges whose middles are freer than both of their ends.
std::vector<SplitEdge> freeingEdges(const BendProblem& problem,
                                    const adjacency::TetTopology& topology,
                                    const VertexUnknowns& unknowns, std::span<const Index> tets) {
  EdgeReader reader(problem, topology);
  std::vector<SplitEdge> edges;
  for (const Index t : tets) {
    forEachEdgeOf(problem.tets[t], [&](const SplitEdge& edge, lattice::CornerMask corners) {
      const int ends =
          std::min(std::popcount(unknowns.fixed[edge[0]]), std::popcount(unknowns.fixed[edge[1]]));
      if (problem.keptEdges.contains(edge)) return;
      if (ends > 0 && reader.fixedCount(t, corners) < ends) edges.push_back(edge);
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
