#include <algorithm>
#include <bit>

#include <quantize/bend_split.hpp>
#include <quantize/edge_turns.hpp>

#include <base/vector3.hpp>

namespace hexhex::quantization {

namespace {

Vec3 middle(const Vec3& a, const Vec3& b) {
  return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
}

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

SplitEdge sorted(Index v, Index w) { return {std::min(v, w), std::max(v, w)}; }

/// Calls visit(edge, corners) for the six edges of a tet.
template <class Visit>
void forEachEdgeOf(const Tet& tet, const Visit& visit) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      visit(sorted(tet[i], tet[j]), static_cast<lattice::CornerMask>((1U << i) | (1U << j)));
    }
  }
}

void sortOut(std::vector<SplitEdge>& edges) {
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

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

/// Which tets are at each vertex, while they are cut.
using Stars = std::vector<std::vector<Index>>;

void cutTet(BendState& state, Stars& stars, Index t, const SplitEdge& edge, Index vertex) {
  BendProblem& problem = state.problem;
  const auto second = static_cast<Index>(problem.tets.size());
  const auto a = static_cast<std::size_t>(adjacency::localCorner(problem.tets[t], edge[0]));
  const auto b = static_cast<std::size_t>(adjacency::localCorner(problem.tets[t], edge[1]));
  problem.tets.push_back(problem.tets[t]);
  problem.tets[t][b] = vertex;
  problem.tets[second][a] = vertex;
  for (std::vector<TetParameters>* corners : {&problem.reference, &state.bent}) {
    const Vec3 between = middle((*corners)[t][a], (*corners)[t][b]);
    corners->push_back((*corners)[t]);
    (*corners)[t][b] = between;
    corners->back()[a] = between;
  }
  state.parentTet.push_back(state.parentTet[t]);
  // Both halves keep what is across their faces; between them there is one chart.
  for (std::size_t face = 0; face < 4; ++face) {
    problem.transitions.push_back(problem.transitions[4 * t + face]);
    problem.planes.push_back(problem.planes[4 * t + face]);
  }
  for (const std::size_t inner : {4 * std::size_t{t} + a, 4 * std::size_t{second} + b}) {
    problem.transitions[inner] = {};
    problem.planes[inner] = {};
  }
  if (auto fixed = problem.fixedCorners.extract(static_cast<adjacency::CornerIndex>(4 * t + b))) {
    fixed.key() = static_cast<adjacency::CornerIndex>(4 * second + b);
    problem.fixedCorners.insert(std::move(fixed));
  }
  for (const Index v : problem.tets[second]) stars[v].push_back(second);
  stars[vertex].push_back(t);
  std::erase(stars[edge[1]], t);
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
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
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
  Stars stars(problem.points.size());
  for (Index t = 0; t < problem.tets.size(); ++t) {
    for (const Index v : problem.tets[t]) stars[v].push_back(t);
  }
  for (const SplitEdge& edge : edges) {
    if (problem.tets.size() > mostTets) return false;
    const auto vertex = static_cast<Index>(problem.points.size());
    problem.points.push_back(middle(problem.points[edge[0]], problem.points[edge[1]]));
    stars.emplace_back();
    const std::vector<Index> star = stars[edge[0]];
    for (const Index t : star) {
      const Tet& tet = problem.tets[t];
      if (std::find(tet.begin(), tet.end(), edge[1]) != tet.end()) {
        cutTet(state, stars, t, edge, vertex);
      }
    }
    splitIrregular(edge, vertex, problem.irregularEdges);
    state.splitEdges.push_back(edge);
  }
  return problem.tets.size() <= mostTets;
}

}  // namespace hexhex::quantization
