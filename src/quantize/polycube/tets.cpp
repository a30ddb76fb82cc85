#include <algorithm>

#include <quantize/polycube/tets.hpp>
#include <tetmap/boundary_curves.hpp>
#include <tetmap/tetmap.hpp>

#include <base/vector3.hpp>

namespace hexhex::quantization {

namespace {

double squaredLength(const TetMesh& mesh, const tetmap::VertexPair& edge) {
  const Vec3 d = minus(mesh.points[edge[1]], mesh.points[edge[0]]);
  return dot(d, d);
}

void splitAll(PolycubeTets& tets, std::vector<tetmap::EdgeInTet> edges) {
  tets.mate = tetmap::splitLongestFirst(tets.mesh, tets.mate, std::move(edges),
                                        [&tets](const tetmap::VertexPair& edge, Index /*middle*/,
                                                const std::vector<tetmap::Cut>& cuts) {
                                          tets.added.add(edge);
                                          for (const tetmap::Cut& cut : cuts) {
                                            tetmap::carryTet(cut, tets.parentTet);
                                            tetmap::carryFaces(cut, std::int8_t{-1}, tets.flags);
                                          }
                                        });
}

/// The boundary of a tet mesh, and the curves along which its labels change.
tetmap::BoundaryCurves boundaryOf(const PolycubeTets& tets) {
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
  sortUnique(sides);  // leaves one entry for each edge and label
  std::vector<tetmap::VertexPair> edges;
  std::vector<tetmap::VertexPair> borders;
  for (const auto& [edge, label] : sides) {
    if (edges.empty() || edges.back() != edge) {
      edges.push_back(edge);
    } else if (borders.empty() || borders.back() != edge) {
      borders.push_back(edge);
    }
  }
  return {tets.mesh.points.size(), std::move(edges), std::move(borders)};
}

/// Splits each tet that has all four corners on the boundary, by a vertex in its middle.
void splitTets(PolycubeTets& tets, const tetmap::BoundaryCurves& boundary) {
  tetmap::MutableTets mesh(std::move(tets.mesh.tets), tets.mate, tets.mesh.points.size());
  const std::size_t count = mesh.tetCount();
  for (Index t = 0; t < count; ++t) {
    const Tet whole = mesh.tets[t];
    if (!boundary.hasAllOf(whole)) continue;
    auto& p = tets.mesh.points;
    p.push_back(tetmap::middleOf(tetmap::middleOf(p[whole[0]], p[whole[1]]),
                                 tetmap::middleOf(p[whole[2]], p[whole[3]])));
    tets.added.add(whole);
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
  tets.added = tetmap::AddedVertices(view.points.size());
  tets.mate.assign(mesh.topology.mate.begin(), mesh.topology.mate.end());
  for (Index t = 0; t < view.tets.size(); ++t) {
    FaceFlags& flags = tets.flags.emplace_back();
    for (std::size_t face = 0; face < 4; ++face) flags[face] = mesh.flags[4 * t + face];
    tets.parentTet.push_back(t);
  }
  return tets;
}

void makeRoom(PolycubeTets& tets) {
  // Midpoints are inside the object or inside a face, so each edge is split once: first those of
  // the boundary, then inner ones.
  while (true) {
    const tetmap::BoundaryCurves boundary = boundaryOf(tets);
    std::vector<tetmap::EdgeInTet> edges = boundary.tightEdges(tets.mesh.tets);
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
