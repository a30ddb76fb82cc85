#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include <adjacency/corner_range.hpp>
#include <adjacency/hex_topology.hpp>
#include <adjacency/tet_topology.hpp>
#include <tetmap/grid_planes.hpp>

#include <hexhex/error.hpp>

#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/vector3.hpp>
#include <igm/input.hpp>
#include <improve/crease_chains.hpp>
#include <improve/sound_input.hpp>
#include <improve/vertex_places.hpp>

namespace hexhex::improvement {

namespace {

constexpr std::size_t kVertexPlacesGrain = 4096;

Vec3 normalized(const Vec3& a) {
  const double size = length(a);
  return size > 0 ? times(1 / size, a) : Vec3{};
}

/// Adds the triangles of the boundary, then inner ones that are tagged or between regions, if they
/// lie in grid planes: there are no quads on others.
void addTriangles(const TetMapView& map, Stage& stage, SurfaceParts& parts) {
  const auto topology = adjacency::manifoldTopology(map.tets, map.points.size(), stage);
  if (!topology) {
    throw Error(ErrorCode::InvalidArgument,
                "The tets of the map are no manifold: a triangle belongs to more than two of them, "
                "or to two on the same side. `hexhex check` tells where.");
  }
  std::vector<FeatureFace> tagged;
  for (const FeatureFace& face : map.features.faces) {
    if (face.tag != 0) tagged.push_back({sorted(face.vertices), face.tag});
  }
  const auto byVertices = [](const FeatureFace& a, const FeatureFace& b) {
    return a.vertices < b.vertices;
  };
  std::sort(tagged.begin(), tagged.end(), byVertices);
  std::vector<FeatureFace> inner;
  for (adjacency::HalfFace face = 0; face < 4 * map.tets.size(); ++face) {
    const adjacency::HalfFace mate = topology->mate[face];
    if (mate != kNone && mate < face) continue;
    FeatureFace triangle;
    const auto vertices = adjacency::faceVertices(map.tets[adjacency::tetOf(face)], face % 4);
    triangle.vertices = sorted(vertices);
    const auto found = std::lower_bound(tagged.begin(), tagged.end(), triangle, byVertices);
    if (found != tagged.end() && found->vertices == triangle.vertices) triangle.tag = found->tag;
    const bool betweenRegions =
        mate != kNone && !map.regions.empty() &&
        map.regions[adjacency::tetOf(face)] != map.regions[adjacency::tetOf(mate)];
    if (mate != kNone && triangle.tag == 0 && !betweenRegions) continue;
    const auto corners = static_cast<lattice::CornerMask>(
        lattice::kWholeTet ^ lattice::cornerBit(static_cast<int>(face % 4)));
    if (mate != kNone && tetmap::gridPlanes(map.parameters[adjacency::tetOf(face)], corners) == 0) {
      continue;
    }
    triangle.vertices = {vertices[0], vertices[2], vertices[1]};  // facing outwards
    (mate == kNone ? parts.triangles : inner).push_back(triangle);
  }
  parts.boundaryTriangles = parts.triangles.size();
  parts.triangles.insert(parts.triangles.end(), inner.begin(), inner.end());
}

void requireGenerators(const HexMesh& mesh, const TetMapView& map, Stage& stage) {
  const std::size_t n = mesh.points.size();
  const bool complete = mesh.generatorTet.size() == n && mesh.generatorCorners.size() == n;
  const std::size_t bad = !complete ? 0 : firstFault(stage, n, [&](std::size_t v) {
    return mesh.generatorTet[v] < map.tets.size() && mesh.generatorCorners[v] >= 1 &&
           mesh.generatorCorners[v] <= 15;
  });
  if (complete && bad == n) return;
  throw Error(ErrorCode::InvalidArgument,
              complete
                  ? concat("The generator of vertex ", bad,
                           " is not in the map. Give the map that the mesh was extracted from.")
                  : "The mesh does not tell which simplex of the map each vertex lies in. "
                    "Write it as .vtu, .ovm or .ovmb, or leave out the map.",
              Place{PlaceKind::Vertex, bad, 0});
}

/// Adds tagged vertices and edges.
void addTags(const auto& features, SurfaceParts& parts) {
  for (const FeatureVertex& vertex : features.vertices) {
    if (vertex.tag != 0) parts.corners.push_back(vertex.vertex);
  }
  for (const FeatureEdge& edge : features.edges) {
    if (edge.tag != 0) parts.curves.push_back(edge.vertices);
  }
  parts.areTagged = !parts.curves.empty();
}

void addQuad(const Array<Vec3>& points, Quad quad, std::int32_t tag, SurfaceParts& parts) {
  const auto squared = [&](std::size_t i, std::size_t j) {
    const Vec3 d = minus(points[quad[i]], points[quad[j]]);
    return dot(d, d);
  };
  if (squared(1, 3) < squared(0, 2)) quad = {quad[1], quad[2], quad[3], quad[0]};
  const auto group = static_cast<Index>(parts.triangles.size());
  parts.triangles.push_back({{quad[0], quad[1], quad[2]}, tag});
  parts.triangles.push_back({{quad[0], quad[2], quad[3]}, tag});
  parts.groups.insert(parts.groups.end(), 2, group);
}

bool byVertices(const FeatureQuad& a, const FeatureQuad& b) {
  return sorted(a.vertices) < sorted(b.vertices);
}

/// The tagged quads, sorted by their vertices.
std::vector<FeatureQuad> taggedQuads(const HexMesh& mesh) {
  std::vector<FeatureQuad> tagged = mesh.features.quads;
  std::erase_if(tagged, [](const FeatureQuad& quad) { return quad.tag == 0; });
  std::sort(tagged.begin(), tagged.end(), byVertices);
  return tagged;
}

/// Faces between cells that are tagged or, if `regionsCount`, lie between regions and have no free
/// vertex.
std::vector<Quad> innerQuads(const HexMesh& mesh, const Array<Freedom>& freedom, bool regionsCount,
                             Stage& stage) {
  const std::vector<FeatureQuad> tagged = taggedQuads(mesh);
  const bool byRegion = regionsCount && mesh.regions.size() == mesh.cells.size();
  if (tagged.empty() && !byRegion) return {};
  const adjacency::VertexCells around = adjacency::cellsAroundVertices(mesh, stage);
  return collectFromBlocks<Quad>(
      stage, mesh.points.size(), kVertexPlacesGrain,
      [&](std::size_t begin, std::size_t end, std::vector<Quad>& quads) {
        adjacency::forEachFace(
            std::span<const Hex>(mesh.cells), begin, end, around, [&](const auto& sides) {
              if (sides.size() < 2) return;
              const Quad quad = adjacency::faceVertices(mesh.cells[sides[0].cell], sides[0].face);
              const bool isHeld = std::none_of(
                  quad.begin(), quad.end(), [&](Index v) { return freedom[v] == Freedom::Free; });
              const bool betweenRegions =
                  byRegion && isHeld && mesh.regions[sides[0].cell] != mesh.regions[sides[1].cell];
              if (betweenRegions || std::binary_search(tagged.begin(), tagged.end(),
                                                       FeatureQuad{quad, 1}, byVertices)) {
                quads.push_back(quad);
              }
            });
      });
}

/// Adds boundary quads, then tagged inner ones.
void addQuads(const HexMesh& mesh, Stage& stage, SurfaceParts& parts) {
  const std::vector<FeatureQuad> tagged = taggedQuads(mesh);
  std::vector<bool> isAdded(tagged.size());
  for (const Quad& quad : adjacency::quadsAt(mesh, adjacency::boundaryPlaces(mesh, stage))) {
    const auto found =
        std::lower_bound(tagged.begin(), tagged.end(), FeatureQuad{quad, 1}, byVertices);
    const bool isTagged = found != tagged.end() && sorted(found->vertices) == sorted(quad);
    if (isTagged) isAdded[static_cast<std::size_t>(found - tagged.begin())] = true;
    addQuad(mesh.points, quad, isTagged ? found->tag : 0, parts);
  }
  parts.boundaryTriangles = parts.triangles.size();
  for (std::size_t i = 0; i < tagged.size(); ++i) {
    if (!isAdded[i]) addQuad(mesh.points, tagged[i].vertices, tagged[i].tag, parts);
  }
}

/// Adds boundary edges with other than two cells as curves: where the boundary is folded, angles do
/// not tell where the edges of the object are. (The surface of a map is not folded, so the angle
/// suffices there; labels may change along any zigzag of its edges.)
void addSingularEdges(const HexMesh& mesh, Stage& stage, SurfaceParts& parts) {
  const adjacency::VertexCells around = adjacency::cellsAroundVertices(mesh, stage);
  const adjacency::HexFaces faces = adjacency::findFaces(mesh, around, stage);
  for (const SingularHexEdge& edge : adjacency::findEdges(mesh, around, faces, stage).singular) {
    if (edge.boundary) parts.curves.push_back({edge.vertex0, edge.vertex1});
  }
}

void requireFeatures(const HexFeatures& features, std::size_t points) {
  bool inRange = true;
  for (const FeatureVertex& vertex : features.vertices) inRange &= vertex.vertex < points;
  for (const FeatureEdge& edge : features.edges) {
    for (const Index v : edge.vertices) inRange &= v < points;
  }
  for (const FeatureQuad& quad : features.quads) {
    for (const Index v : quad.vertices) inRange &= v < points;
  }
  if (inRange) return;
  throw Error(ErrorCode::InvalidArgument,
              concat("A feature names a vertex that does not exist (there are ", points,
                     "). Correct the features, or leave them out."));
}

/// @param generatorOf  called with (vertex, list): lists the points whose simplex held the vertex
///         originally, and returns their number
template <class GeneratorOf>
void place(const Array<Vec3>& points, const GeneratorOf& generatorOf, VertexPlaces& places,
           Stage& stage) {
  const std::size_t n = points.size();
  places.freedom.resize(n);
  places.simplex.resize(n);
  places.isLoose.assign(n, false);
  parallelFor(stage, n, kVertexPlacesGrain, [&](std::size_t v) {
    std::array<Index, 4> corners{};
    const std::size_t count = generatorOf(v, corners);
    places.simplex[v] = kNone;
    places.freedom[v] =
        count > 3 ? Freedom::Free
                  : places.surface.freedomAt(std::span(corners).first(count), places.simplex[v]);
    const auto vertex = static_cast<Index>(v);
    places.simplex[v] = places.nearest(vertex, points[v]).simplex;
  });
  for (std::size_t v = 0; v < n; ++v) {
    const bool isCorner = places.freedom[v] == Freedom::Fixed;
    if (isCorner && places.surface.isTagged(Freedom::Fixed, places.simplex[v])) ++places.tagged;
  }
}

}  // namespace

VertexPlaces placesOnMap(const HexMesh& mesh, const TetMapView& map, double angle, Stage& stage) {
  requireGenerators(mesh, map, stage);
  adjacency::requireCornersInRange(map, stage);
  requireSameObject(mesh, map, stage);
  igm::DefectCollector defects;  // flipped tets do not matter here
  [[maybe_unused]] const igm::OrientedMap read = igm::readInput(map, stage, defects);
  SurfaceParts parts;
  parts.angle = angle;
  parts.points.assign(map.points.begin(), map.points.end());
  addTriangles(map, stage, parts);
  addTags(map.features, parts);
  VertexPlaces places;
  places.surface = ReferenceSurface(std::move(parts), stage);
  place(
      mesh.points,
      [&](std::size_t v, std::array<Index, 4>& corners) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < 4; ++i) {
          if ((mesh.generatorCorners[v] >> i & 1U) != 0) {
            corners[count++] = map.tets[mesh.generatorTet[v]][i];
          }
        }
        return count;
      },
      places, stage);
  places.innerQuads = innerQuads(mesh, places.freedom, !map.regions.empty(), stage);
  return places;
}

VertexPlaces placesOnMesh(const HexMesh& mesh, std::span<const std::uint8_t> isAtBad, double angle,
                          Stage& stage) {
  requireFeatures(mesh.features, mesh.points.size());
  SurfaceParts parts;
  parts.angle = angle;
  parts.points = mesh.points;
  addQuads(mesh, stage, parts);
  addTags(mesh.features, parts);
  if (!parts.areTagged) addSingularEdges(mesh, stage, parts);
  parts.sharp = creaseChains(parts, isAtBad, stage);
  VertexPlaces places;
  places.isOwn = true;
  places.surface = ReferenceSurface(std::move(parts), stage);
  place(
      mesh.points,
      [](std::size_t v, std::array<Index, 4>& corners) {
        corners[0] = static_cast<Index>(v);
        return std::size_t{1};
      },
      places, stage);
  places.innerQuads = innerQuads(mesh, places.freedom, false, stage);
  return places;
}

std::size_t VertexPlaces::directionsAt(Index vertex, std::array<Vec3, 3>& directions) const {
  switch (freedom[vertex]) {
    case Freedom::Free:
      directions = kAxes;
      return 3;
    case Freedom::OnPatch: {
      const std::array<Vec3, 3> t = surface.triangle(simplex[vertex]);
      const Vec3 first = minus(t[1], t[0]);
      directions[0] = normalized(first);
      directions[1] = normalized(cross(cross(first, minus(t[2], t[0])), first));
      return 2;
    }
    case Freedom::OnCurve: {
      const std::array<Vec3, 2> s = surface.segment(simplex[vertex]);
      directions[0] = normalized(minus(s[1], s[0]));
      return 1;
    }
    default:
      return 0;
  }
}

}  // namespace hexhex::improvement
