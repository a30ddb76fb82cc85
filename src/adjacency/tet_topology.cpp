// Stars of vertices, edges, and owners of simplices (Section 5.2: parent tets).
#include <atomic>

#include <adjacency/edge_fan.hpp>

namespace hexhex::adjacency {

namespace {

constexpr std::size_t kTetTopologyGrain = 4096;

}  // namespace

std::optional<TetTopology> manifoldTopology(std::span<const Tet> tets, std::size_t pointCount,
                                            Stage& stage) {
  TetTopology topology;
  topology.tets = tets;
  topology.pointCount = pointCount;
  if (!matchFaces(topology, stage)) return std::nullopt;
  return topology;
}

void addStars(TetTopology& topology, Stage& stage) {
  if (!topology.stars.empty()) return;
  topology.stars = VertexLists<CornerIndex>(topology.pointCount, stage, [&](const auto& add) {
    parallelFor(stage, topology.tetCount(), kTetTopologyGrain, [&](std::size_t t) {
      for (std::size_t i = 0; i < 4; ++i) {
        add(topology.tets[t][i], static_cast<CornerIndex>(4 * t + i));
      }
    });
  });
}

std::uint64_t countEdges(const TetTopology& topology, Stage& stage) {
  std::atomic<std::uint64_t> count{0};
  parallelBlocks(
      stage, topology.pointCount, kTetTopologyGrain,
      [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
        std::vector<Index> ends;  // w of edges (v, w) with v < w
        for (std::size_t v = begin; v < end; ++v) {
          ends.clear();
          for (const CornerIndex corner : topology.star(static_cast<Index>(v))) {
            for (const Index w : topology.tets[corner / 4]) {
              if (w > v) ends.push_back(w);
            }
          }
          std::sort(ends.begin(), ends.end());
          count += static_cast<std::uint64_t>(std::unique(ends.begin(), ends.end()) - ends.begin());
        }
      });
  return count;
}

std::size_t boundaryFacesAt(const TetTopology& topology, std::span<const EdgeCorner> fan) {
  std::size_t count = 0;
  for (const EdgeCorner& at : fan) {
    for (int face = 0; face < 4; ++face) {
      if (face == at.corner0 || face == at.corner1) continue;
      if (topology.isBoundary(halfFaceOf(at.tet, face))) ++count;
    }
  }
  return count;
}

namespace {

/// Calls visit(tet) for the other tets around an edge, until it returns false.
template <class Visit>
void visitOthersAround(const TetTopology& topology, Index tet, lattice::CornerMask edge,
                       const Visit& visit) {
  struct Nothing {};
  visitAroundEdge(
      topology, tet, edge, Nothing{}, [](Nothing nothing, HalfFace /*out*/) { return nothing; },
      [&visit](const auto& turn, Nothing /*nothing*/) { return visit(turn.tet()); });
}

}  // namespace

Index ownerTet(const TetTopology& topology, Index tet, lattice::CornerMask simplex) noexcept {
  switch (lattice::dimension(simplex)) {
    case 3:
      return tet;
    case 2: {
      const HalfFace mate = topology.mate[halfFaceOf(tet, lattice::oppositeCorner(simplex))];
      return mate == kNone ? tet : std::min(tet, tetOf(mate));
    }
    case 1: {
      Index owner = tet;
      visitOthersAround(topology, tet, simplex, [&owner](Index other) {
        owner = std::min(owner, other);
        return true;
      });
      return owner;
    }
    default:
      return topology.vertexTet[topology.tets[tet][lattice::firstCorner(simplex)]];
  }
}

bool ownsSimplex(const TetTopology& topology, Index tet, lattice::CornerMask simplex) noexcept {
  if (lattice::dimension(simplex) != 1) return ownerTet(topology, tet, simplex) == tet;
  bool owns = true;
  visitOthersAround(topology, tet, simplex, [&owns, tet](Index other) {
    owns = tet < other;
    return owns;
  });
  return owns;
}

}  // namespace hexhex::adjacency
