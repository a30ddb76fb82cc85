#include <algorithm>
#include <cmath>
#include <numbers>

#include <adjacency/vertex_lists.hpp>

#include <base/vector3.hpp>
#include <improve/crease_chains.hpp>
#include <improve/reference_surface.hpp>

namespace hexhex::improvement {

namespace {

/// Minimum number of edges of chains with a dead end that touch bad cells: a single protruding
/// vertex makes two in a row, or three together with a neighbour.
constexpr std::size_t kFewestEdges = 4;
/// Maximum number of edges by which to bridge folds: those around two adjacent vertices.
constexpr std::size_t kMostBridged = 4;
/// Cosine of the angle beyond which the boundary is folded back at bad cells: 120 degrees.
constexpr double kFoldedBack = -0.5;

enum class EdgeKind : std::uint8_t {
  Flat,    ///< no crease, however sharp
  Unsure,  ///< at a fold, where angles mean nothing
  Crease,
  Curve,  ///< regardless of the angle
};

struct SurfaceEdge {
  std::array<Index, 2> vertices;
  EdgeKind kind;

  [[nodiscard]] Index endBeside(Index v) const { return vertices[vertices[0] == v ? 1 : 0]; }
  [[nodiscard]] bool isLine() const { return kind == EdgeKind::Crease || kind == EdgeKind::Curve; }
};

class CreaseGraph {
 public:
  CreaseGraph(const SurfaceParts& parts, std::span<const std::uint8_t> isAtBad, Stage& stage)
      : parts_(parts),
        isAtBad_(isAtBad),
        limit_(std::cos(parts.angle * std::numbers::pi / 180)),
        ends_(parts.corners) {
    std::sort(ends_.begin(), ends_.end());
    for (const std::array<Index, 2>& curve : parts.curves) {
      given_.push_back(ascending(curve[0], curve[1]));
    }
    std::sort(given_.begin(), given_.end());
    forEachEdge(parts.triangles,
                [&](const std::array<Index, 2>& vertices, std::span<const Index> around) {
                  edges_.push_back({vertices, kindOf(vertices, around)});
                });
    edgesAt_ = adjacency::VertexLists<Index>(parts.points.size(), stage, [&](const auto& add) {
      for (std::size_t e = 0; e < edges_.size(); ++e) {
        for (const Index v : edges_[e].vertices) add(v, static_cast<Index>(e));
      }
    });
  }

  /// Extends chains from their dead ends straight across folds to other lines.
  void bridge() {
    std::vector<Index> bridges;
    for (const Index end : deadEnds()) {
      const std::vector<Index> found = bridgeFrom(end);
      bridges.insert(bridges.end(), found.begin(), found.end());
    }
    for (const Index e : bridges) edges_[e].kind = EdgeKind::Crease;
  }

  /// Removes short chains with a dead end that touch bad cells, repeatedly until there are none.
  void prune() {
    for (bool isDone = false; !isDone;) {
      isDone = true;
      std::vector<Index> pruned;
      for (const Index end : deadEnds()) {
        const std::vector<Index> chain = chainFrom(end);
        const bool isAtBad = std::any_of(chain.begin(), chain.end(), [&](Index e) {
          const auto& [a, b] = edges_[e].vertices;
          return isAtBad_[a] != 0 || isAtBad_[b] != 0;
        });
        if (!isAtBad || chain.size() >= kFewestEdges) continue;
        pruned.insert(pruned.end(), chain.begin(), chain.end());
        isDone = false;
      }
      for (const Index e : pruned) edges_[e].kind = EdgeKind::Flat;
    }
  }

  [[nodiscard]] std::vector<std::array<Index, 2>> creases() const {
    std::vector<std::array<Index, 2>> list;
    for (const SurfaceEdge& edge : edges_) {
      if (edge.kind == EdgeKind::Crease) list.push_back(edge.vertices);
    }
    return list;
  }

 private:
  [[nodiscard]] EdgeKind kindOf(const std::array<Index, 2>& vertices,
                                std::span<const Index> around) const {
    const std::vector<FeatureFace>& triangles = parts_.triangles;
    if (around.size() != 2 || triangles[around[0]].tag != triangles[around[1]].tag ||
        std::binary_search(given_.begin(), given_.end(), vertices)) {
      return EdgeKind::Curve;
    }
    if (parts_.groups[around[0]] == parts_.groups[around[1]]) return EdgeKind::Flat;
    if (isFolded(around[0]) || isFolded(around[1])) return EdgeKind::Unsure;
    const double cosine = cosineBetween(normalAt(around[0]), normalAt(around[1]));
    const bool isAtBad = isAtBad_[vertices[0]] != 0 && isAtBad_[vertices[1]] != 0;
    if (isAtBad && cosine < kFoldedBack) return EdgeKind::Unsure;
    return cosine < limit_ ? EdgeKind::Crease : EdgeKind::Flat;
  }

  [[nodiscard]] Vec3 normalAt(Index triangle) const {
    const auto& [a, b, c] = parts_.triangles[triangle].vertices;
    return normalOf({parts_.points[a], parts_.points[b], parts_.points[c]});
  }

  /// Whether the corners of a triangle's quad do not all face the same way.
  [[nodiscard]] bool isFolded(Index triangle) const {
    const Index first = parts_.groups[triangle];
    const std::array<Index, 3>& v = parts_.triangles[first].vertices;
    const Quad quad = {v[0], v[1], v[2], parts_.triangles[first + 1].vertices[2]};
    const Vec3 normal = plus(normalAt(first), normalAt(first + 1));
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 corner = normalOf({parts_.points[quad[i]], parts_.points[quad[(i + 1) % 4]],
                                    parts_.points[quad[(i + 3) % 4]]});
      if (dot(corner, normal) <= 0) return true;
    }
    return false;
  }

  [[nodiscard]] std::size_t countLines(Index v) const {
    const std::span<const Index> at = edgesAt_(v);
    return static_cast<std::size_t>(
        std::count_if(at.begin(), at.end(), [&](Index e) { return edges_[e].isLine(); }));
  }

  /// A line at a vertex other than the given edge.
  [[nodiscard]] Index lineBeside(Index v, Index edge) const {
    for (const Index e : edgesAt_(v)) {
      if (e != edge && edges_[e].isLine()) return e;
    }
    return kNone;
  }

  /// Vertices at which a crease is the only line.
  [[nodiscard]] std::vector<Index> deadEnds() const {
    std::vector<Index> list;
    for (Index v = 0; v < parts_.points.size(); ++v) {
      if (countLines(v) != 1 || std::binary_search(ends_.begin(), ends_.end(), v)) continue;
      if (edges_[lineBeside(v, kNone)].kind == EdgeKind::Crease) list.push_back(v);
    }
    return list;
  }

  /// Edges at folds that lead from a dead end straight to another line; empty if there are none.
  [[nodiscard]] std::vector<Index> bridgeFrom(Index v) const {
    std::vector<Index> edges;
    Index last = lineBeside(v, kNone);
    while (edges.size() < kMostBridged) {
      last = straightOn(v, last);
      if (last == kNone) return {};
      edges.push_back(last);
      v = edges_[last].endBeside(v);
      if (countLines(v) > 0) return edges;
    }
    return {};
  }

  [[nodiscard]] Index straightOn(Index v, Index edge) const {
    const Vec3 step = minus(parts_.points[v], parts_.points[edges_[edge].endBeside(v)]);
    Index best = kNone;
    double most = limit_;
    for (const Index e : edgesAt_(v)) {
      if (edges_[e].kind != EdgeKind::Unsure || e == edge) continue;
      const double cosine =
          cosineBetween(step, minus(parts_.points[edges_[e].endBeside(v)], parts_.points[v]));
      if (cosine < most) continue;
      most = cosine;
      best = e;
    }
    return best;
  }

  /// The chain from a dead end to a curve, or to where the number of lines is not two.
  [[nodiscard]] std::vector<Index> chainFrom(Index v) const {
    std::vector<Index> chain;
    for (Index e = lineBeside(v, kNone); edges_[e].kind == EdgeKind::Crease;) {
      chain.push_back(e);
      v = edges_[e].endBeside(v);
      if (countLines(v) != 2) break;
      e = lineBeside(v, e);
    }
    return chain;
  }

  const SurfaceParts& parts_;
  std::span<const std::uint8_t> isAtBad_;
  double limit_;
  std::vector<Index> ends_;  ///< vertices where lines may end
  std::vector<std::array<Index, 2>> given_;
  std::vector<SurfaceEdge> edges_;
  adjacency::VertexLists<Index> edgesAt_;
};

}  // namespace

std::vector<std::array<Index, 2>> creaseChains(const SurfaceParts& parts,
                                               std::span<const std::uint8_t> isAtBad,
                                               Stage& stage) {
  CreaseGraph graph(parts, isAtBad, stage);
  graph.bridge();
  graph.prune();
  return graph.creases();
}

}  // namespace hexhex::improvement
