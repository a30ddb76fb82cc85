#include <algorithm>
#include <array>
#include <limits>

#include <shape/sharp_edges.hpp>
#include <shape/surface.hpp>

#include <hexhex/quantize.hpp>

#include <base/sorted.hpp>
#include <base/vector3.hpp>

namespace hexhex::shape {

namespace {

/// The axis perpendicular to a boundary triangle in the map.
int axisInMap(const TetMap& map, adjacency::HalfFace h) {
  const TetParameters& corners = map.parameters[adjacency::tetOf(h)];
  const auto& face = lattice::kFaceCorners[h % 4];
  const auto at = [&](std::size_t i) { return corners[static_cast<std::size_t>(face[i])]; };
  return static_cast<int>(dominantAxis(cross(minus(at(1), at(0)), minus(at(2), at(0)))));
}

/// Whether the corners of a triangle share a coordinate, within the tolerance of quantize().
bool isLevel(const TetParameters& corners, adjacency::HalfFace h, double tolerance) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const int corner : lattice::kFaceCorners[h % 4]) {
      const double u = corners[static_cast<std::size_t>(corner)][axis];
      low = std::min(low, u);
      high = std::max(high, u);
    }
    if (high - low <= tolerance) return true;
  }
  return false;
}

void countInnerFaces(const TetMap& map, const adjacency::TetTopology& topology,
                     FoundFeatures& features) {
  std::vector<std::array<Index, 3>> tagged;
  for (const FeatureFace& face : map.features.faces) {
    if (face.tag != 0) tagged.push_back(sorted(face.vertices));
  }
  std::sort(tagged.begin(), tagged.end());
  if (tagged.empty() && map.regions.empty()) return;
  double size = 0;
  for (const TetParameters& corners : map.parameters) {
    for (const Vec3& u : corners) {
      for (const double x : u) size = std::max(size, std::abs(x));
    }
  }
  double area = 0;
  double aligned = 0;
  for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
    const adjacency::HalfFace mate = topology.mate[h];
    if (mate == kNone || mate < h) continue;
    const Index tet = adjacency::tetOf(h);
    const std::array<Index, 3> v = adjacency::faceVertices(map.tets[tet], h % 4);
    const bool isBetween =
        !map.regions.empty() && map.regions[tet] != map.regions[adjacency::tetOf(mate)];
    if (!isBetween && !std::binary_search(tagged.begin(), tagged.end(), sorted(v))) {
      continue;
    }
    const Vec3& corner = map.points[v[0]];
    const double twice =
        length(cross(minus(map.points[v[1]], corner), minus(map.points[v[2]], corner)));
    ++features.innerFaces;
    area += twice;
    if (isLevel(map.parameters[tet], h, QuantizeOptions{}.tolerance * size)) {
      ++features.alignedFaces;
      aligned += twice;
    }
  }
  if (area > 0) features.alignedArea = aligned / area;
}

/// Removes edges, from loose ends on, until at each end of an edge another one goes on: what fades
/// out on a smooth surface is an effect of coarse triangles, as a rule.
void removeFading(std::vector<std::array<Index, 2>>& edges, std::size_t points) {
  std::vector<Index> count(points);
  for (const std::array<Index, 2>& edge : edges) {
    for (const Index v : edge) ++count[v];
  }
  const auto fades = [&](const std::array<Index, 2>& edge) {
    const bool ends = count[edge[0]] == 1 || count[edge[1]] == 1;
    if (ends) {
      for (const Index v : edge) --count[v];
    }
    return ends;
  };
  while (std::erase_if(edges, fades) > 0) {
  }
}

}  // namespace

FoundFeatures featuresOf(const TetMap& map, double angle, bool areAligned, Stage& stage) {
  const auto topology = adjacency::manifoldTopology(map.tets, map.points.size(), stage);
  if (!topology) throw Error(ErrorCode::Internal, "A polycube's map is no manifold.");
  const Surface surface = surfaceOf(*topology, map.points);
  const double limit = leastCosine(angle);
  FoundFeatures features;
  std::vector<std::array<Index, 2>> sharp;
  for (Side side = 0; side < surface.tails.size(); ++side) {
    if (side > surface.twins[side]) continue;
    const Index here = Surface::triangleOf(side);
    const Index beyond = surface.beyond(side);
    if (dot(surface.normals[here], surface.normals[beyond]) >= limit) continue;
    ++features.count;
    const Index a = surface.tails[side];
    const Index b = surface.head(side);
    sharp.push_back({std::min(a, b), std::max(a, b)});
    if (areAligned ||
        axisInMap(map, surface.faces[here]) != axisInMap(map, surface.faces[beyond])) {
      features.tagged.push_back({.vertices = sharp.back(), .tag = 1});
    }
  }
  features.aligned = features.tagged.size();
  if (!areAligned) {
    removeFading(sharp, map.points.size());
    std::sort(sharp.begin(), sharp.end());
    std::erase_if(features.tagged, [&](const FeatureEdge& edge) {
      return !std::binary_search(sharp.begin(), sharp.end(), edge.vertices);
    });
  }
  std::sort(features.tagged.begin(), features.tagged.end(),
            [](const FeatureEdge& a, const FeatureEdge& b) { return a.vertices < b.vertices; });
  countInnerFaces(map, *topology, features);
  return features;
}

}  // namespace hexhex::shape
