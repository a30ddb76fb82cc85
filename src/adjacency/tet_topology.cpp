#include <atomic>

#include <adjacency/edge_turn.hpp>
#include <adjacency/tet_topology.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 4096;

/// The w of all edges (v, w) with v < w, ascending.
void collectEdges(const TetTopology& topology, Index v, std::vector<Index>& ends) {
  ends.clear();
  for (const CornerIndex corner : topology.star(v)) {
    for (const Index w : topology.tets[corner / 4]) {
      if (w > v) ends.push_back(w);
    }
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
}

}  // namespace

void addStars(TetTopology& topology, Stage& stage) {
  if (!topology.stars.empty()) return;
  topology.stars = VertexLists<CornerIndex>(topology.pointCount, stage, [&](const auto& add) {
    parallelFor(stage, topology.tetCount(), kGrain, [&](std::size_t t) {
      for (std::size_t i = 0; i < 4; ++i) {
        add(topology.tets[t][i], static_cast<CornerIndex>(4 * t + i));
      }
    });
  });
}

void addEdges(TetTopology& topology, Stage& stage) {
  if (!topology.edgeBegin.empty()) return;
  addStars(topology, stage);
  const std::size_t vertices = topology.pointCount;
  topology.edgeBegin.assign(vertices + 1, 0);
  // Blocks gather their edges in order, so that joining them in order is the lexicographic list.
  std::vector<std::vector<Index>> blocks(blockCount(vertices, kGrain));
  parallelBlocks(stage, vertices, kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   std::vector<Index> ends;
                   for (std::size_t v = begin; v < end; ++v) {
                     collectEdges(topology, static_cast<Index>(v), ends);
                     topology.edgeBegin[v] = ends.size();
                     blocks[block].insert(blocks[block].end(), ends.begin(), ends.end());
                   }
                 });
  topology.edgeEnd.resize(exclusiveScan(std::span(topology.edgeBegin)));
  parallelFor(stage, blocks.size(), 1, [&](std::size_t block) {
    std::copy(
        blocks[block].begin(), blocks[block].end(),
        topology.edgeEnd.begin() + static_cast<std::ptrdiff_t>(topology.edgeBegin[block * kGrain]));
  });
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

std::uint64_t TetTopology::edgeIndex(Index a, Index b) const noexcept {
  const Index v = std::min(a, b);
  const auto first = edgeEnd.begin() + static_cast<std::ptrdiff_t>(edgeBegin[v]);
  const auto last = edgeEnd.begin() + static_cast<std::ptrdiff_t>(edgeBegin[v + 1]);
  return static_cast<std::uint64_t>(std::lower_bound(first, last, std::max(a, b)) -
                                    edgeEnd.begin());
}

namespace {

/// Calls visit(tet) for the other tets around an edge, until it returns false.
template <class Visit>
void visitOthersAround(const TetTopology& topology, Index tet, CornerMask edge,
                       const Visit& visit) {
  const int first = otherFaceAtEdge(edge, -1);
  // In one direction, and from a boundary in the other, too.
  for (const int face : {first, otherFaceAtEdge(edge, first)}) {
    EdgeTurn turn(topology, tet, edge, face);
    while (turn.next() != kNone) {
      turn.step();
      if (turn.tet() == tet || !visit(turn.tet())) return;
    }
  }
}

}  // namespace

Index ownerTet(const TetTopology& topology, Index tet, CornerMask simplex) noexcept {
  switch (dimension(simplex)) {
    case 3:
      return tet;
    case 2: {
      const HalfFace mate = topology.mate[halfFaceOf(tet, oppositeCorner(simplex))];
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
      return topology.vertexTet[topology.tets[tet][firstCorner(simplex)]];
  }
}

bool ownsSimplex(const TetTopology& topology, Index tet, CornerMask simplex) noexcept {
  if (dimension(simplex) != 1) return ownerTet(topology, tet, simplex) == tet;
  bool owns = true;
  visitOthersAround(topology, tet, simplex, [&owns, tet](Index other) {
    owns = tet < other;
    return owns;
  });
  return owns;
}

}  // namespace hexhex
