#include <quantize/polycube/tets.hpp>

namespace hexhex::quantization {

namespace {

double squaredLength(const TetMesh& mesh, const SplitEdge& edge) {
  const Vec3 d = minus(mesh.points[edge[1]], mesh.points[edge[0]]);
  return dot(d, d);
}

/// Longest first, which keeps tets round.
void splitAll(PolycubeTets& tets, std::vector<SplitEdge> edges) {
  sortOut(edges);
  std::stable_sort(edges.begin(), edges.end(), [&](const SplitEdge& a, const SplitEdge& b) {
    return squaredLength(tets.mesh, a) > squaredLength(tets.mesh, b);
  });
  EdgeSplitter splitter(tets.mesh.points, tets.mesh.tets);
  for (const SplitEdge& edge : edges) {
    splitter.split(edge, [&](Index t, std::size_t a, std::size_t b) {
      tets.parentTet.push_back(tets.parentTet[t]);
      tets.flags.push_back(tets.flags[t]);
      tets.flags[t][a] = -1;
      tets.flags.back()[b] = -1;
    });
  }
}

/// Where a tet mesh has its boundary, and where labels change there.
class Boundary {
 public:
  explicit Boundary(const PolycubeTets& tets)
      : isOuter_(tets.mesh.points.size()), isBorder_(tets.mesh.points.size()) {
    std::vector<std::pair<SplitEdge, std::int8_t>> sides;
    for (std::size_t t = 0; t < tets.flags.size(); ++t) {
      for (std::size_t face = 0; face < 4; ++face) {
        if (tets.flags[t][face] < 0) continue;
        forEachEdgeOf(tets.mesh.tets[t], [&](const SplitEdge& edge, lattice::CornerMask corners) {
          if ((corners >> face & 1U) == 0) sides.emplace_back(edge, tets.flags[t][face]);
        });
      }
    }
    sortOut(sides);  // of one edge, different labels are left
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
  [[nodiscard]] bool isTight(const SplitEdge& edge) const {
    if (!isOuter_[edge[0]] || !isOuter_[edge[1]]) return false;
    if (!contains(outer_, edge)) return true;
    return isBorder_[edge[0]] && isBorder_[edge[1]] && !contains(borders_, edge);
  }

 private:
  static bool contains(const std::vector<SplitEdge>& edges, const SplitEdge& edge) {
    return std::binary_search(edges.begin(), edges.end(), edge);
  }

  std::vector<SplitEdge> outer_;    ///< ascending
  std::vector<SplitEdge> borders_;  ///< ascending
  std::vector<bool> isOuter_;       ///< per vertex: at an edge of the boundary
  std::vector<bool> isBorder_;      ///< per vertex: at an edge between labels
};

std::vector<SplitEdge> tightEdges(const TetMesh& mesh, const Boundary& boundary) {
  std::vector<SplitEdge> edges;
  for (const Tet& tet : mesh.tets) {
    forEachEdgeOf(tet, [&](const SplitEdge& edge, lattice::CornerMask /*corners*/) {
      if (boundary.isTight(edge)) edges.push_back(edge);
    });
  }
  return edges;
}

/// Puts a vertex in the middle of a tet.
void splitTet(PolycubeTets& tets, Index t) {
  const auto vertex = static_cast<Index>(tets.mesh.points.size());
  const Tet whole = tets.mesh.tets[t];
  const FaceFlags flags = tets.flags[t];
  const auto& p = tets.mesh.points;
  tets.mesh.points.push_back(
      middle(middle(p[whole[0]], p[whole[1]]), middle(p[whole[2]], p[whole[3]])));
  for (std::size_t face = 0; face < 4; ++face) {
    if (face > 0) {
      tets.mesh.tets.emplace_back();
      tets.flags.emplace_back();
      tets.parentTet.push_back(tets.parentTet[t]);
    }
    const std::size_t part = face == 0 ? t : tets.flags.size() - 1;
    tets.mesh.tets[part] = whole;
    tets.mesh.tets[part][face] = vertex;
    tets.flags[part] = {-1, -1, -1, -1};
    tets.flags[part][face] = flags[face];
  }
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
    std::vector<SplitEdge> edges = tightEdges(tets.mesh, boundary);
    if (!edges.empty()) {
      splitAll(tets, std::move(edges));
      continue;
    }
    const std::size_t count = tets.mesh.tets.size();
    for (Index t = 0; t < count; ++t) {
      const Tet& tet = tets.mesh.tets[t];
      if (std::all_of(tet.begin(), tet.end(), [&](Index v) { return boundary.has(v); })) {
        splitTet(tets, t);
      }
    }
    return;
  }
}

void refineAt(PolycubeTets& tets, const std::vector<Index>& vertices) {
  std::vector<SplitEdge> edges;
  for (const Tet& tet : tets.mesh.tets) {
    if (std::count_if(tet.begin(), tet.end(), [&](Index v) {
          return std::binary_search(vertices.begin(), vertices.end(), v);
        }) < 2) {
      continue;
    }
    SplitEdge longest{};
    double most = 0;
    forEachEdgeOf(tet, [&](const SplitEdge& edge, lattice::CornerMask /*corners*/) {
      const double length = squaredLength(tets.mesh, edge);
      if (length > most) most = length, longest = edge;
    });
    edges.push_back(longest);
  }
  splitAll(tets, std::move(edges));
}

}  // namespace hexhex::quantization
