#include <algorithm>
#include <cmath>

#include <shape/features.hpp>
#include <shape/surface.hpp>

namespace hexhex::shape {

namespace {

/// The axis that a boundary triangle is perpendicular to in the map.
int axisInMap(const TetMap& map, adjacency::HalfFace h) {
  const TetParameters& corners = map.parameters[adjacency::tetOf(h)];
  const auto& face = lattice::kFaceCorners[h % 4];
  const auto at = [&](std::size_t i) { return corners[static_cast<std::size_t>(face[i])]; };
  return static_cast<int>(dominantAxis(cross(minus(at(1), at(0)), minus(at(2), at(0)))));
}

}  // namespace

FoundFeatures featuresOf(const TetMap& map, double angle, bool areAligned, Stage& stage) {
  const auto topology = adjacency::manifoldTopology(map.tets, map.points.size(), stage);
  if (!topology) throw Error(ErrorCode::Internal, "A polycube's map is no manifold.");
  const Surface surface = surfaceOf(*topology, map.points);
  FoundFeatures features;
  for (Side side = 0; side < surface.tails.size(); ++side) {
    if (side > surface.twins[side]) continue;
    const Index here = Surface::triangleOf(side);
    const Index beyond = surface.beyond(side);
    if (dot(surface.normals[here], surface.normals[beyond]) > std::cos(angle)) continue;
    ++features.count;
    if (!areAligned &&
        axisInMap(map, surface.faces[here]) == axisInMap(map, surface.faces[beyond])) {
      continue;
    }
    const Index a = surface.tails[side];
    const Index b = surface.head(side);
    features.aligned.push_back({.vertices = {std::min(a, b), std::max(a, b)}, .tag = 1});
  }
  std::sort(features.aligned.begin(), features.aligned.end(),
            [](const FeatureEdge& a, const FeatureEdge& b) { return a.vertices < b.vertices; });
  return features;
}

}  // namespace hexhex::shape
