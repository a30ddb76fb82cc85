#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>
#include <adjacency/tet_topology.hpp>
#include <pipeline/groups.hpp>
#include <tetmap/cut.hpp>
#include <tetmap/grid_planes.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <improve/curve_paths.hpp>
#include <improve/surface_distance.hpp>

namespace hexhex::pipeline {
namespace {

using Edge = tetmap::VertexPair;

constexpr std::size_t kGroupsGrain = 1024;

/// Looks up the tags of edges, triangles or quads by their vertices.
template <class Feature>
class Tags {
 public:
  explicit Tags(std::vector<Feature> features) : entries_(std::move(features)) {
    std::erase_if(entries_, [](const Feature& feature) { return feature.tag == 0; });
    for (Feature& entry : entries_) entry.vertices = sorted(entry.vertices);
    std::sort(entries_.begin(), entries_.end(), byVertices);
  }
  [[nodiscard]] bool empty() const noexcept { return entries_.empty(); }
  /// @return 0 if there is none
  [[nodiscard]] std::int32_t of(decltype(Feature::vertices) vertices) const {
    const Feature wanted{sorted(vertices), 0};
    const auto found = std::lower_bound(entries_.begin(), entries_.end(), wanted, byVertices);
    return found != entries_.end() && found->vertices == wanted.vertices ? found->tag : 0;
  }

 private:
  static bool byVertices(const Feature& a, const Feature& b) { return a.vertices < b.vertices; }
  std::vector<Feature> entries_;
};

/// The boundary triangles of a map, facing outwards, with their tags.
std::vector<FeatureFace> boundaryOf(const TetMap& map, const adjacency::TetTopology& topology) {
  const Tags<FeatureFace> tags(map.features.faces);
  std::vector<FeatureFace> triangles;
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    if (topology.mate[h] != kNone) continue;
    const auto v = adjacency::faceVertices(map.tets[adjacency::tetOf(h)], h % 4);
    triangles.push_back({{v[0], v[2], v[1]}, tags.of(v)});
  }
  return triangles;
}

adjacency::TetTopology topologyOf(const TetMap& map, Stage& stage) {
  auto topology = adjacency::manifoldTopology(map.tets, map.points.size(), stage);
  if (!topology) throw Error(ErrorCode::Internal, "The map of a part is no manifold.");
  return std::move(*topology);
}

class BoundaryTagger {
 public:
  BoundaryTagger(const TetMap& map, HexMesh& mesh, Stage& stage)
      : map_(map),
        mesh_(mesh),
        stage_(stage),
        topology_(topologyOf(map, stage)),
        triangles_(boundaryOf(map, topology_)),
        quads_(adjacency::quadsAt(mesh, adjacency::boundaryPlaces(mesh, stage))) {}

  void tagQuads() {
    if (std::all_of(triangles_.begin(), triangles_.end(),
                    [](const FeatureFace& triangle) { return triangle.tag == 0; })) {
      return;
    }
    std::vector<std::array<Vec3, 3>> corners;
    for (const FeatureFace& triangle : triangles_) corners.push_back(cornersOf(triangle));
    const improvement::TriangleTree tree(corners);
    const Tags<FeatureQuad> before(mesh_.features.quads);
    std::vector<FeatureQuad> tagged(quads_.size());
    parallelFor(stage_, quads_.size(), kGroupsGrain, [&](std::size_t q) {
      const Quad& quad = quads_[q];
      const std::array<Vec3, 4> at = {mesh_.points[quad[0]], mesh_.points[quad[1]],
                                      mesh_.points[quad[2]], mesh_.points[quad[3]]};
      const std::size_t nearest = tree.nearest(centreOf(at)).triangle;
      const Vec3 normal = cross(minus(at[2], at[0]), minus(at[3], at[1]));
      // The far side of a thin wall may be nearer.
      const bool isThis = dot(normal, improvement::normalOf(corners[nearest])) > 0;
      tagged[q] = {quad, isThis ? triangles_[nearest].tag : before.of(quad)};
    });
    replaceBoundary(std::move(tagged));
  }

  /// Extraction only tags quads in grid planes of the map. Other quads between two regions get the
  /// tag of the nearest triangle between the same two.
  void tagInterfaces() {
    const std::map<Regions, std::vector<FeatureFace>> interfaces = taggedInterfaces();
    if (interfaces.empty() || mesh_.regions.empty()) return;
    std::map<Regions, improvement::TriangleTree> trees;
    for (const auto& [regions, triangles] : interfaces) {
      std::vector<std::array<Vec3, 3>> corners;
      for (const FeatureFace& triangle : triangles) corners.push_back(cornersOf(triangle));
      trees.emplace(regions, corners);
    }
    const Tags<FeatureQuad> before(mesh_.features.quads);
    const adjacency::VertexCells around = adjacency::cellsAroundVertices(mesh_, stage_);
    adjacency::forEachFace(
        std::span<const Hex>(mesh_.cells), 0, mesh_.points.size(), around, [&](const auto& sides) {
          if (sides.size() != 2) return;
          const Regions regions =
              between(mesh_.regions[sides[0].cell], mesh_.regions[sides[1].cell]);
          const auto tree = trees.find(regions);
          if (tree == trees.end()) return;
          const Quad quad = adjacency::faceVertices(mesh_.cells[sides[0].cell], sides[0].face);
          if (before.of(quad) != 0) return;
          const std::array<Vec3, 4> at = {mesh_.points[quad[0]], mesh_.points[quad[1]],
                                          mesh_.points[quad[2]], mesh_.points[quad[3]]};
          const std::size_t nearest = tree->second.nearest(centreOf(at)).triangle;
          const std::int32_t tag = interfaces.at(regions)[nearest].tag;
          if (tag != 0) mesh_.features.quads.push_back({quad, tag});
        });
  }

  std::uint64_t tagEdges(const Features& held) {
    const std::vector<Edge> outer = boundaryEdges();
    std::uint64_t missing = 0;
    std::set<std::int32_t> open;  // tags of boundary edges that are not on grid lines
    std::vector<FeatureEdge> curves;
    const Tags<FeatureEdge> known(held.edges);
    for (FeatureEdge edge : map_.features.edges) {
      if (edge.tag == 0) continue;
      edge.vertices = sorted(edge.vertices);
      const bool isOuter = std::binary_search(outer.begin(), outer.end(), edge.vertices);
      const bool isKnown = known.of(edge.vertices) != 0;
      if (isOuter) curves.push_back(edge);
      if (isOuter && !isKnown) open.insert(edge.tag);
      if (!isOuter && !isKnown) ++missing;
    }
    std::erase_if(curves, [&open](const FeatureEdge& edge) { return !open.contains(edge.tag); });
    if (curves.empty()) return missing;
    const Tags<FeatureEdge> tags(curves);
    const improvement::CurvePaths paths =
        improvement::pathsAlongCurves(mesh_.points, quads_, surfaceWith(curves), stage_);
    if (paths.missing == 0) {  // the paths also cover parts of these curves on grid lines
      std::erase_if(mesh_.features.edges,
                    [&open](const FeatureEdge& edge) { return open.contains(edge.tag); });
    }
    std::map<Edge, std::int32_t> added;
    const Tags<FeatureEdge> before(mesh_.features.edges);
    for (const improvement::CurvePath& path : paths.paths) {
      const std::int32_t tag = tags.of(path.segments.front());
      for (std::size_t i = 1; i < path.vertices.size(); ++i) {
        const Edge edge = tetmap::pairOf(path.vertices[i - 1], path.vertices[i]);
        if (before.of(edge) == 0) added.emplace(edge, tag);
      }
    }
    for (const auto& [edge, tag] : added) mesh_.features.edges.push_back({edge, tag});
    return missing + paths.missing;
  }

  void tagVertices() {
    if (map_.features.vertices.empty()) return;
    std::vector<Index> outer;
    for (const Quad& quad : quads_) outer.insert(outer.end(), quad.begin(), quad.end());
    sortUnique(outer);
    std::vector<std::array<Vec3, 3>> places;
    places.reserve(outer.size());
    for (const Index v : outer)
      places.push_back({mesh_.points[v], mesh_.points[v], mesh_.points[v]});
    const improvement::TriangleTree tree(places);
    std::map<Index, std::int32_t> tags;
    for (const FeatureVertex& known : mesh_.features.vertices)
      tags.emplace(known.vertex, known.tag);
    for (const FeatureVertex& given : map_.features.vertices) {
      if (given.tag != 0) {
        tags.emplace(outer[tree.nearest(map_.points[given.vertex]).triangle], given.tag);
      }
    }
    mesh_.features.vertices.clear();
    for (const auto& [vertex, tag] : tags) mesh_.features.vertices.push_back({vertex, tag});
  }

 private:
  using Regions = std::array<std::int32_t, 2>;
  static Regions between(std::int32_t a, std::int32_t b) {
    return {std::min(a, b), std::max(a, b)};
  }

  /// All triangles between each two regions, if any of these triangles has a tag.
  [[nodiscard]] std::map<Regions, std::vector<FeatureFace>> taggedInterfaces() const {
    std::map<Regions, std::vector<FeatureFace>> list;
    const Tags<FeatureFace> tags(map_.features.faces);
    if (map_.regions.empty() || tags.empty()) return list;
    for (adjacency::HalfFace h = 0; h < topology_.mate.size(); ++h) {
      const adjacency::HalfFace mate = topology_.mate[h];
      if (mate == kNone || mate < h) continue;
      const Index tet = adjacency::tetOf(h);
      const Regions regions = between(map_.regions[tet], map_.regions[adjacency::tetOf(mate)]);
      if (regions[0] == regions[1]) continue;
      const auto vertices = adjacency::faceVertices(map_.tets[tet], h % 4);
      list[regions].push_back({vertices, tags.of(vertices)});
    }
    std::erase_if(list, [](const auto& entry) {
      return std::all_of(entry.second.begin(), entry.second.end(),
                         [](const FeatureFace& triangle) { return triangle.tag == 0; });
    });
    return list;
  }

  [[nodiscard]] std::array<Vec3, 3> cornersOf(const FeatureFace& triangle) const {
    const auto& [a, b, c] = triangle.vertices;
    return {map_.points[a], map_.points[b], map_.points[c]};
  }

  void replaceBoundary(std::vector<FeatureQuad> tagged) {
    std::vector<Quad> outer(quads_.begin(), quads_.end());
    for (Quad& quad : outer) quad = sorted(quad);
    std::sort(outer.begin(), outer.end());
    std::erase_if(mesh_.features.quads, [&outer](const FeatureQuad& quad) {
      return std::binary_search(outer.begin(), outer.end(), sorted(quad.vertices));
    });
    std::erase_if(tagged, [](const FeatureQuad& quad) { return quad.tag == 0; });
    mesh_.features.quads.insert(mesh_.features.quads.end(), tagged.begin(), tagged.end());
  }

  [[nodiscard]] std::vector<Edge> boundaryEdges() const {
    std::vector<Edge> edges;
    for (const auto& [vertices, tag] : triangles_) {
      for (std::size_t i = 0; i < 3; ++i) {
        edges.push_back(tetmap::pairOf(vertices[i], vertices[(i + 1) % 3]));
      }
    }
    sortUnique(edges);
    return edges;
  }

  /// The boundary of the map with these edges as curves, which end where the tag changes.
  [[nodiscard]] improvement::ReferenceSurface surfaceWith(
      const std::vector<FeatureEdge>& curves) const {
    improvement::SurfaceParts parts;
    parts.points.assign(map_.points.begin(), map_.points.end());
    for (const FeatureFace& triangle : triangles_)
      parts.triangles.push_back({triangle.vertices, 0});
    parts.boundaryTriangles = parts.triangles.size();
    parts.angle = 180;  // a border of patches may zigzag from triangle to triangle
    std::vector<Edge>& sharp = parts.sharp.emplace();
    std::map<Index, std::int32_t> tagAt;
    for (const FeatureEdge& curve : curves) {
      sharp.push_back(curve.vertices);
      for (const Index v : curve.vertices) {
        if (tagAt.emplace(v, curve.tag).first->second != curve.tag) parts.corners.push_back(v);
      }
    }
    std::sort(sharp.begin(), sharp.end());
    return {std::move(parts), stage_};
  }

  const TetMap& map_;
  HexMesh& mesh_;
  Stage& stage_;
  adjacency::TetTopology topology_;
  std::vector<FeatureFace> triangles_;
  Array<Quad> quads_;
};

}  // namespace

Features heldTags(const TetMap& map, Stage& stage) {
  Features held;
  held.vertices = map.features.vertices;
  const Tags<FeatureEdge> edges(map.features.edges);
  const Tags<FeatureFace> faces(map.features.faces);
  if (edges.empty() && faces.empty()) return held;
  const adjacency::TetTopology topology = topologyOf(map, stage);
  std::map<Edge, std::int32_t> heldEdges;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    const Tet& tet = map.tets[t];
    tetmap::forEachEdgeOf(tet, [&](const Edge& edge, lattice::CornerMask corners) {
      const std::int32_t tag = edges.empty() ? 0 : edges.of(edge);
      if (tag != 0 && tetmap::gridPlanes(map.parameters[t], corners) > 1) {
        heldEdges.emplace(edge, tag);
      }
    });
    for (std::size_t face = 0; !faces.empty() && face < 4; ++face) {
      const adjacency::HalfFace mate = topology.mate[4 * t + face];
      const auto vertices = adjacency::faceVertices(tet, face);
      const std::int32_t tag = mate == kNone || mate < 4 * t + face ? 0 : faces.of(vertices);
      if (tag != 0) held.faces.push_back({vertices, tag});
    }
  }
  for (const auto& [edge, tag] : heldEdges) held.edges.push_back({edge, tag});
  return held;
}

std::uint64_t tagBoundary(const TetMap& map, const Features& held, HexMesh& mesh, Stage& stage) {
  if (map.features.empty()) return 0;
  BoundaryTagger tagger(map, mesh, stage);
  tagger.tagQuads();
  tagger.tagInterfaces();
  const std::uint64_t missing = tagger.tagEdges(held);
  tagger.tagVertices();
  return missing;
}

std::vector<TagName> missingGroups(const TetMap& map, const HexMesh& mesh) {
  std::map<std::pair<int, std::int32_t>, std::string> missing;
  for (const std::int32_t region : map.regions) missing.try_emplace({3, region});
  for (const FeatureFace& face : map.features.faces) missing.try_emplace({2, face.tag});
  for (const std::int32_t region : mesh.regions) missing.erase({3, region});
  for (const FeatureQuad& quad : mesh.features.quads) missing.erase({2, quad.tag});
  missing.erase({2, 0});
  missing.erase({3, 0});
  for (const TagName& each : map.features.names) {
    const auto found = missing.find({each.dimension, each.tag});
    if (found != missing.end()) found->second = each.name;
  }
  std::vector<TagName> list;
  list.reserve(missing.size());
  for (const auto& [group, name] : missing) list.push_back({group.first, group.second, name});
  return list;
}

}  // namespace hexhex::pipeline
