#include <algorithm>
#include <map>
#include <set>

#include <quantize/complex/arcs_and_patches.hpp>

#include <base/disjoint_sets.hpp>

namespace hexhex::quantization {

namespace {

/// A directed edge of a wall's triangle.
struct WallEdge {
  std::array<Index, 2> key{};  ///< ascending
  Index tail = 0;
  Index head = 0;
  adjacency::HalfFace halfFace = 0;
  [[nodiscard]] auto operator<=>(const WallEdge&) const = default;
};

std::vector<WallEdge> wallEdges(const WallMesh& mesh) {
  std::vector<WallEdge> edges;
  for (adjacency::HalfFace h = 0; h < mesh.mate.size(); ++h) {
    if (!mesh.isWall[h]) continue;
    const auto& c = lattice::kFaceCorners[h % 4];
    const Tet& tet = mesh.tets[adjacency::tetOf(h)];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index tail = tet[static_cast<std::size_t>(c[k])];
      const Index head = tet[static_cast<std::size_t>(c[(k + 1) % 3])];
      edges.push_back({{std::min(tail, head), std::max(tail, head)}, tail, head, h});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Finds the complex's edges, and the arc to which each belongs.
class ArcFinder {
 public:
  ArcFinder(MotorcycleComplex& complex, DisjointSets& sides) : complex_(complex), sides_(sides) {}

  /// Finds the complex's edges, and joins triangle sides that lie in one plane.
  void collect() {
    const std::vector<WallEdge> edges = wallEdges(complex_.mesh);
    adjacency::forEachRun(
        std::span<const WallEdge>(edges),
        [](const WallEdge& a, const WallEdge& b) { return a.key == b.key; },
        [this](std::span<const WallEdge> same) { addEdge(same); });
    linkEdges();
  }

  /// Numbers arcs. Call after collect().
  void follow() {
    for (Index edge = 0; edge < edges_.size(); ++edge) {
      for (const bool fromHead : {false, true}) {
        const Index start = edges_[edge].vertices[fromHead ? 1 : 0];
        if (isNode(start) && edges_[edge].arc == kNone) follow(edge, start);
      }
    }
    for (const Edge& edge : edges_) {
      if (edge.arc == kNone) {
        throw Error(ErrorCode::Internal, "An arc of the motorcycle complex has no nodes.",
                    {PlaceKind::Edge, edge.vertices[0], edge.vertices[1]});
      }
    }
  }

  [[nodiscard]] bool isNode(Index vertex) const {
    if (edgesAt_[vertex].empty()) return false;
    return edgesAt_[vertex].size() != 2 || complex_.mesh.featureVertices.contains(vertex);
  }

  /// Position of a directed edge in its arc.
  struct Position {
    Index arc = kNone;  ///< kNone if it is not an edge of the complex
    bool isForward = true;
    std::int64_t offset = 0;  ///< distance of its tail from the arc's first node
  };
  [[nodiscard]] Position positionOf(Index tail, Index head) const {
    const auto found = byKey_.find({std::min(tail, head), std::max(tail, head)});
    if (found == byKey_.end()) return {};
    const Edge& edge = edges_[found->second];
    const bool isForward = edge.first == tail;
    return {edge.arc, isForward, isForward ? edge.offset : edge.offset + edge.length};
  }

 private:
  struct Edge {
    std::array<Index, 2> vertices{};
    std::int64_t length = 0;
    Index arc = kNone;
    Index first = kNone;      ///< the end closer to the arc's first node
    std::int64_t offset = 0;  ///< of that end, along the arc
  };

  /// Adds an edge, given all wall triangles at it.
  void addEdge(std::span<const WallEdge> same) {
    const WallMesh& mesh = complex_.mesh;
    std::size_t triangles = 0;
    for (const WallEdge& each : same) {
      const adjacency::HalfFace mate = mesh.mate[each.halfFace];
      triangles += mate == kNone || each.halfFace < mate ? 1 : 0;
    }
    if (triangles == 2 && joinIfFlat(same)) return;
    const Index tet = adjacency::tetOf(same[0].halfFace);
    const lattice::LatticePoint along = mesh.at(tet, mesh.cornerOf(tet, same[0].key[1])) -
                                        mesh.at(tet, mesh.cornerOf(tet, same[0].key[0]));
    Edge edge;
    edge.vertices = same[0].key;
    for (const std::int64_t x : along) edge.length += std::abs(x);
    byKey_.emplace(edge.vertices, static_cast<Index>(edges_.size()));
    edges_.push_back(edge);
  }

  /// Joins the two triangles at an edge if they lie in one plane.
  bool joinIfFlat(std::span<const WallEdge> same) {
    for (const WallEdge& each : same) {
      const adjacency::HalfFace other =
          wallOpposite(complex_.mesh, each.halfFace, each.tail, each.head);
      if (other == kNone || sameTriangle(each.halfFace, other)) return false;
    }
    for (const WallEdge& each : same) {
      sides_.unite(each.halfFace, wallOpposite(complex_.mesh, each.halfFace, each.tail, each.head));
    }
    return true;
  }
  [[nodiscard]] bool sameTriangle(adjacency::HalfFace a, adjacency::HalfFace b) const {
    return a == b || complex_.mesh.mate[a] == b;
  }

  void linkEdges() {
    edgesAt_.resize(complex_.mesh.vertexCount());
    for (Index e = 0; e < edges_.size(); ++e) {
      for (const Index v : edges_[e].vertices) edgesAt_[v].push_back(e);
    }
  }
  /// Numbers the arc that starts with an edge.
  void follow(Index edge, Index start) {
    Arc arc;
    arc.nodes[0] = start;
    Index vertex = start;
    while (true) {
      Edge& here = edges_[edge];
      here.arc = static_cast<Index>(complex_.arcs.size());
      here.first = vertex;
      here.offset = arc.length;
      arc.length += here.length;
      arc.isFeature = arc.isFeature || complex_.mesh.featureEdges.contains(here.vertices);
      vertex = here.vertices[0] == vertex ? here.vertices[1] : here.vertices[0];
      if (isNode(vertex)) break;
      edge = edgesAt_[vertex][0] == edge ? edgesAt_[vertex][1] : edgesAt_[vertex][0];
    }
    arc.nodes[1] = vertex;
    complex_.arcs.push_back(arc);
  }

  MotorcycleComplex& complex_;
  DisjointSets& sides_;
  std::vector<Edge> edges_;
  std::map<std::array<Index, 2>, Index> byKey_;
  std::vector<std::vector<Index>> edgesAt_;
};

/// Finds patch sides and their borders.
class PatchFinder {
 public:
  PatchFinder(MotorcycleComplex& complex, const ArcFinder& arcs, DisjointSets& sides)
      : complex_(complex), arcs_(arcs), sides_(sides) {}

  void run() {
    const WallMesh& mesh = complex_.mesh;
    complex_.patchOf.assign(mesh.mate.size(), kNone);
    for (adjacency::HalfFace h = 0; h < mesh.mate.size(); ++h) {
      if (mesh.isWall[h]) addTriangle(h);
    }
    for (std::size_t p = 0; p < borders_.size(); ++p) {
      complex_.patches[p].border.assign(borders_[p].begin(), borders_[p].end());
    }
  }

 private:
  void addTriangle(adjacency::HalfFace h) {
    const adjacency::HalfFace first = sides_.find(h);
    if (first == h) {
      complex_.patchOf[h] = static_cast<Index>(complex_.patches.size());
      complex_.patches.push_back({complex_.blockOf[adjacency::tetOf(h)], h, {}});
      borders_.emplace_back();
    }
    complex_.patchOf[h] = complex_.patchOf[first];
    const auto& c = lattice::kFaceCorners[h % 4];
    for (std::size_t k = 0; k < 3; ++k) {
      addEdge(h, static_cast<std::size_t>(c[k]), static_cast<std::size_t>(c[(k + 1) % 3]));
    }
  }

  /// Adds a directed edge of a triangle if it belongs to an arc.
  void addEdge(adjacency::HalfFace h, std::size_t tail, std::size_t head) {
    const Index tet = adjacency::tetOf(h);
    const WallMesh& mesh = complex_.mesh;
    const auto at = arcs_.positionOf(mesh.tets[tet][tail], mesh.tets[tet][head]);
    if (at.arc == kNone) return;
    const lattice::LatticePoint from = complex_.toBlock[tet](mesh.at(tet, tail));
    const lattice::LatticePoint along = complex_.toBlock[tet](mesh.at(tet, head)) - from;
    ArcSide side;
    side.arc = at.arc;
    while (along[side.axis] == 0) ++side.axis;
    side.sign = along[side.axis] > 0 ? 1 : -1;
    // The distance back to the node where this side of the arc starts.
    const std::int64_t length = complex_.arcs[at.arc].length;
    const std::int64_t behind = at.isForward ? at.offset : length - at.offset;
    side.start = side.end = from;
    side.start[side.axis] -= side.sign * behind;
    side.end[side.axis] += side.sign * (length - behind);
    borders_[complex_.patchOf[h]].insert(side);
    for (const std::size_t corner : {tail, head}) addFeature(tet, corner, side);
  }

  void addFeature(Index tet, std::size_t corner, const ArcSide& side) {
    const Index vertex = complex_.mesh.tets[tet][corner];
    const bool isNode = arcs_.isNode(vertex) && complex_.mesh.featureVertices.contains(vertex);
    if (!isNode && !complex_.arcs[side.arc].isFeature) return;
    const lattice::LatticePoint here = complex_.toBlock[tet](complex_.mesh.at(tet, corner));
    complex_.featureCorners.push_back(
        {tet, corner, isNode ? 3 : std::size_t{side.axis}, isNode ? here : side.start});
  }

  MotorcycleComplex& complex_;
  const ArcFinder& arcs_;
  DisjointSets& sides_;
  std::vector<std::set<ArcSide>> borders_;
};

}  // namespace

void findArcsAndPatches(MotorcycleComplex& complex) {
  complex.arcs.clear();
  complex.patches.clear();
  complex.featureCorners.clear();
  DisjointSets sides(complex.mesh.mate.size());
  ArcFinder arcs(complex, sides);
  arcs.collect();
  arcs.follow();
  PatchFinder(complex, arcs, sides).run();
}

std::vector<bool> findNodes(MotorcycleComplex& complex) {
  DisjointSets sides(complex.mesh.mate.size());
  ArcFinder arcs(complex, sides);
  arcs.collect();
  std::vector<bool> nodes(complex.mesh.vertexCount());
  for (Index v = 0; v < nodes.size(); ++v) nodes[v] = arcs.isNode(v);
  return nodes;
}

}  // namespace hexhex::quantization
