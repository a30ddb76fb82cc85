// Maps of several components.
#pragma once

#include <hexhex/types.hpp>

namespace hexhex::test {

/// Both maps beside each other. Tags and regions are kept as they are.
inline TetMap joined(TetMap first, const TetMap& second) {
  const auto offset = static_cast<Index>(first.points.size());
  for (const Vec3& p : second.points) first.points.push_back({p[0] + 10, p[1], p[2]});
  // Tets without a region are in region 0.
  const bool regions = !first.regions.empty() || !second.regions.empty();
  if (regions) first.regions.resize(first.tets.size());
  for (const Tet& t : second.tets) {
    first.tets.push_back({t[0] + offset, t[1] + offset, t[2] + offset, t[3] + offset});
  }
  first.parameters.insert(first.parameters.end(), second.parameters.begin(),
                          second.parameters.end());
  first.regions.insert(first.regions.end(), second.regions.begin(), second.regions.end());
  if (regions) first.regions.resize(first.tets.size());
  for (FeatureVertex each : second.features.vertices) {
    each.vertex += offset;
    first.features.vertices.push_back(each);
  }
  for (FeatureEdge each : second.features.edges) {
    for (Index& v : each.vertices) v += offset;
    first.features.edges.push_back(each);
  }
  for (FeatureFace each : second.features.faces) {
    for (Index& v : each.vertices) v += offset;
    first.features.faces.push_back(each);
  }
  return first;
}

}  // namespace hexhex::test
