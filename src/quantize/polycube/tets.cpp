#include <algorithm>

#include <quantize/polycube/tets.hpp>
#include <tetmap/mutable_tets.hpp>

#include <base/vector3.hpp>

namespace hexhex::quantization {

namespace {

double squaredLength(const TetMesh& mesh, const tetmap::VertexPair& edge) {
  const Vec3 d = minus(mesh.points[edge[1]], mesh.points[edge[0]]);
  return dot(d, d);
}

/// Longest first, which keeps tets round.
void splitAll(PolycubeTets& tets, std::vector<tetmap::EdgeInTet> edges) {
  tetmap::sortUnique(edges);
  std::stable_sort(
      edges.begin(), edges.end(), [&](const tetmap::EdgeInTet& a, const tetmap::EdgeInTet& b) {
        return squaredLength(tets.mesh, a.vertices) > squaredLength(tets.mesh, b.vertices);
      });
  tetmap::MutableTets mesh(std::move(tets.mesh.tets), tets.mate, tets.mesh.points.size());
  for (const tetmap::EdgeInTet& edge : edges) {
    const auto [v, w] = edge.vertices;
    tets.mesh.points.push_back(tetmap::middleOf(tets.mesh.points[v], tets.mesh.points[w]));
    for (const tetmap::Cut& cut : mesh.splitEdge(edge)) {
      tetmap::carryTet(cut, tets.parentTet);
      tetmap::carryFaces(cut, std::int8_t{-1}, tets.flags);
    }
  }
  tets.mesh.tets = std::move(mesh.tets);
  tets.mate = std::move(mesh.mate);
}

/// Where a tet mesh has its boundary, and where labels change there.
class Boundary {
 public:
  explicit Boundary(const PolycubeTets& tets)
      : isOuter_(tets.mesh.points.size()), isBorder_(tets.mesh.points.size()) {
    std::vector<std::pair<tetmap::VertexPair, std::int8_t>> sides;
    for (std::size_t t = 0; t < tets.flags.size(); ++t) {
      for (std::size_t face = 0; face < 4; ++face) {
        if (tets.flags[t][face] < 0) continue;
        tetmap::forEachEdgeOf(tets.mesh.tets[t],
                              [&](const tetmap::VertexPair& edge, lattice::CornerMask corners) {
                                if ((corners >> face & 1U) == 0)
                                  sides.emplace_back(edge, tets.flags[t][face]);
                              });
      }
    }
    tetmap::sortUnique(sides);  // of one edge, different labels are left
    for (const auto& [edge, label] : sides) {
      for (const Index v : edge) isOuter_[v] = true;
      if (outer_.empty() || outer_.back() != edge) {
        outer_.push_back(edge);
      } else if (borders_.empty() || borders_.back() != edge) {
        borders_.push_back(edge);
        for (const Index v : edge) isBorder_[v] = true;
      }
    }
  }

  [[nodiscard]] bool has(Index vertex) const { return isOuter_[vertex]; }
  /// Whether an edge is less free than its middle would be.
  [[nodiscard]] bool isTight(const tetmap::VertexPair& edge) const {
    if (!isOuter_[edge[0]] || !isOuter_[edge[1]]) return false;
    if (!contains(outer_, edge)) return true;
    return isBorder_[edge[0]] && isBorder_[edge[1]] && !contains(borders_, edge);
  }

 private:
  static bool contains(const std::vector<tetmap::VertexPair>& edges,
                       const tetmap::VertexPair& edge) {
    return std::binary_search(edges.begin(), edges.end(), edge);
  }

  std::vector<tetmap::VertexPair> outer_;    ///< ascending
  std::vector<tetmap::VertexPair> borders_;  ///< ascending
  std::vector<bool> isOuter_;                ///< per vertex: at an edge of the boundary
  std::vector<bool> isBorder_;               ///< per vertex: at an edge between labels
};

std::vector<tetmap::EdgeInTet> tightEdges(const TetMesh& mesh, const Boundary& boundary) {
  std::vector<tetmap::EdgeInTet> edges;
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    tetmap::forEachEdgeOf(mesh.tets[t],
                          [&](const tetmap::VertexPair& edge, lattice::CornerMask /*corners*/) {
                            if (boundary.isTight(edge)) edges.push_back({edge, t});
                          });
  }
  return edges;
}

/// Puts vertices in the middle of tets all of whose corners are on the boundary.
void splitTets(PolycubeTets& tets, const Boundary& boundary) {
  tetmap::MutableTets mesh(std::move(tets.mesh.tets), tets.mate, tets.mesh.points.size());
  const std::size_t count = mesh.tetCount();
  for (Index t = 0; t < count; ++t) {
    const Tet whole = mesh.tets[t];
    if (!std::all_of(whole.begin(), whole.end(), [&](Index v) { return boundary.has(v); })) {
      continue;
    }
    auto& p = tets.mesh.points;
    p.push_back(tetmap::middleOf(tetmap::middleOf(p[whole[0]], p[whole[1]]),
                                 tetmap::middleOf(p[whole[2]], p[whole[3]])));
    const FaceFlags flags = tets.flags[t];
    const std::array<Index, 4> parts = mesh.splitTet(t);
    tets.flags.resize(mesh.tetCount());
    tets.parentTet.resize(mesh.tetCount(), Index{tets.parentTet[t]});
    for (std::size_t face = 0; face < 4; ++face) {
      tets.flags[parts[face]] = {-1, -1, -1, -1};
      tets.flags[parts[face]][face] = flags[face];
    }
  }
  tets.mesh.tets = std::move(mesh.tets);
  tets.mate = std::move(mesh.mate);
}

}  // namespace

PolycubeTets polycubeTets(const LabelledMesh& mesh, double scale) {
  PolycubeTets tets;
  const TetMapView& view = mesh.input.view;
  tets.mesh.points.assign(view.points.begin(), view.points.end());
  for (Vec3& p : tets.mesh.points) {
    for (double& x : p) x *= scale;
  }
  tets.mesh.tets.assign(view.tets.begin(), view.tets.end());
  tets.mate.assign(mesh.topology.mate.begin(), mesh.topology.mate.end());
  for (Index t = 0; t < view.tets.size(); ++t) {
    FaceFlags& flags = tets.flags.emplace_back();
    for (std::size_t face = 0; face < 4; ++face) flags[face] = mesh.flags[4 * t + face];
    tets.parentTet.push_back(t);
  }
  return tets;
}

void makeRoom(PolycubeTets& tets) {
  // Middles are inside, or on the boundary but not between labels, so that there are fewer and
  // fewer of these edges: boundary edges once, and then inner ones once.
  while (true) {
    const Boundary boundary(tets);
    std::vector<tetmap::EdgeInTet> edges = tightEdges(tets.mesh, boundary);
    if (edges.empty()) return splitTets(tets, boundary);
    splitAll(tets, std::move(edges));
  }
}

void refineAt(PolycubeTets& tets, const std::vector<Index>& vertices) {
  std::vector<tetmap::EdgeInTet> edges;
  for (Index t = 0; t < tets.mesh.tets.size(); ++t) {
    const Tet& tet = tets.mesh.tets[t];
    if (std::count_if(tet.begin(), tet.end(), [&](Index v) {
          return std::binary_search(vertices.begin(), vertices.end(), v);
        }) < 2) {
      continue;
    }
    tetmap::VertexPair longest{};
    double most = 0;
    tetmap::forEachEdgeOf(tet,
                          [&](const tetmap::VertexPair& edge, lattice::CornerMask /*corners*/) {
                            const double length = squaredLength(tets.mesh, edge);
                            if (length > most) most = length, longest = edge;
                          });
    edges.push_back({longest, t});
  }
  splitAll(tets, std::move(edges));
}

}  // namespace hexhex::quantization
