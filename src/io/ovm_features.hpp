// Features and edge valences, which list few elements, as properties, which have a value for each.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/features.hpp>

#include <io/ovm_cells.hpp>
#include <io/ovm_mesh.hpp>
#include <io/ovm_output.hpp>
#include <io/ovm_topology.hpp>

namespace hexhex {

/// Gives one element its value, which must be there and not have one yet.
/// @param element  index, or kNone; @param what  e.g. "feature edge 3-17", for the message
inline void setOvmValue(Array<std::int32_t>& values, Index element, std::int32_t value,
                        const std::string& what, Place place) {
  if (element >= values.size()) {
    throw Error(ErrorCode::InvalidArgument, "The " + what + " is not in the mesh.", place);
  }
  if (values[element] != 0) {
    throw Error(ErrorCode::InvalidArgument, "The " + what + " is listed twice.", place);
  }
  values[element] = value;
}

inline void setOvmVertexTags(OvmOutput& output, const std::vector<FeatureVertex>& features) {
  if (features.empty()) return;
  Array<std::int32_t>& tags = output.properties[OvmInteger::FeatureVertices];
  tags.assign(output.topology.vertexCount, 0);
  for (const FeatureVertex& feature : features) {
    setOvmValue(tags, feature.vertex, feature.tag,
                "feature vertex " + std::to_string(feature.vertex),
                {PlaceKind::Vertex, feature.vertex});
  }
}

inline void setOvmEdgeTags(OvmOutput& output, const std::vector<FeatureEdge>& features) {
  if (features.empty()) return;
  Array<std::int32_t>& tags = output.properties[OvmInteger::FeatureEdges];
  tags.assign(output.topology.edges.size(), 0);
  const OvmEdgeFinder finder(output.topology);
  for (const FeatureEdge& feature : features) {
    const Place place{PlaceKind::Edge, feature.vertices[0], feature.vertices[1]};
    setOvmValue(tags, finder.find(feature.vertices[0], feature.vertices[1]), feature.tag,
                "feature " + toString(place), place);
  }
}

/// @param regions  one per cell, or none
template <class Regions>
void setOvmRegions(OvmOutput& output, const Regions& regions) {
  if (regions.empty()) return;
  if (regions.size() != output.topology.cells.size()) {
    throw Error(ErrorCode::InvalidArgument,
                "The mesh has " + std::to_string(output.topology.cells.size()) +
                    " cells, but regions for " + std::to_string(regions.size()) + ".");
  }
  output.properties[OvmInteger::Region].assign(regions.begin(), regions.end());
}

/// @tparam Feature  with n vertices; they need not be in the order of the face
template <std::size_t n, class Feature>
void setOvmFaceTags(OvmOutput& output, const std::vector<Feature>& features,
                    const OvmLoops<n>& loops) {
  if (features.empty()) return;
  struct Wanted {
    std::array<Index, n> vertices;
    const Feature* feature;
    Index face;
  };
  std::vector<Wanted> wanted;
  for (const Feature& feature : features) {
    wanted.push_back({feature.vertices, &feature, kNone});
    std::sort(wanted.back().vertices.begin(), wanted.back().vertices.end());
  }
  const auto before = [](const Wanted& a, const Wanted& b) { return a.vertices < b.vertices; };
  std::stable_sort(wanted.begin(), wanted.end(), before);
  for (std::size_t f = 0; f < output.topology.faces.size(); ++f) {
    Wanted key{loops.ofFace(f), nullptr, 0};
    std::sort(key.vertices.begin(), key.vertices.end());
    const auto range = std::equal_range(wanted.begin(), wanted.end(), key, before);
    for (auto found = range.first; found != range.second; ++found) {
      found->face = static_cast<Index>(f);
    }
  }
  Array<std::int32_t>& tags = output.properties[OvmInteger::FeatureFaces];
  tags.assign(output.topology.faces.size(), 0);
  for (const Wanted& entry : wanted) {
    std::string name = "feature face";
    for (const Index vertex : entry.feature->vertices)
      name.append(1, ' ').append(std::to_string(vertex));
    setOvmValue(tags, entry.face, entry.feature->tag, name, {});
  }
}

}  // namespace hexhex
