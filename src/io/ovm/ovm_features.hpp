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

#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_mesh.hpp>
#include <io/ovm/ovm_output.hpp>

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

/// Gives tagged elements with n vertices their tags.
/// @param verticesOf  of an element by its number, in any order
/// @param nameOf, placeOf  of a feature, for messages
template <std::size_t n, class Feature, class Vertices, class Name, class At>
void setOvmTags(Array<std::int32_t>& tags, std::size_t vertexCount,
                const std::vector<Feature>& features, const Vertices& verticesOf,
                const Name& nameOf, const At& placeOf) {
  struct Wanted {
    std::array<Index, n> vertices;
    const Feature* feature;
    Index element;
  };
  std::vector<Wanted> wanted;
  // Few vertices of a mesh are the smallest ones of a feature, and all elements are asked.
  Array<std::uint8_t> isSmallest(vertexCount, 0);
  for (const Feature& feature : features) {
    wanted.push_back({feature.vertices, &feature, kNone});
    std::sort(wanted.back().vertices.begin(), wanted.back().vertices.end());
    const Index smallest = wanted.back().vertices[0];
    if (smallest < vertexCount) isSmallest[smallest] = 1;
  }
  const auto before = [](const Wanted& a, const Wanted& b) { return a.vertices < b.vertices; };
  std::stable_sort(wanted.begin(), wanted.end(), before);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    Wanted key{verticesOf(i), nullptr, 0};
    if (isSmallest[*std::min_element(key.vertices.begin(), key.vertices.end())] == 0) continue;
    std::sort(key.vertices.begin(), key.vertices.end());
    const auto range = std::equal_range(wanted.begin(), wanted.end(), key, before);
    for (auto found = range.first; found != range.second; ++found) {
      found->element = static_cast<Index>(i);
    }
  }
  for (const Wanted& entry : wanted) {
    setOvmValue(tags, entry.element, entry.feature->tag, nameOf(*entry.feature),
                placeOf(*entry.feature));
  }
}

inline void setOvmEdgeTags(OvmOutput& output, const std::vector<FeatureEdge>& features) {
  if (features.empty()) return;
  Array<std::int32_t>& tags = output.properties[OvmInteger::FeatureEdges];
  tags.assign(output.topology.edges.size(), 0);
  const auto placeOf = [](const FeatureEdge& feature) {
    return Place{PlaceKind::Edge, feature.vertices[0], feature.vertices[1]};
  };
  setOvmTags<2>(
      tags, output.topology.vertexCount, features,
      [&](std::size_t e) { return output.topology.edges[e]; },
      [&](const FeatureEdge& feature) { return "feature " + toString(placeOf(feature)); }, placeOf);
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
  Array<std::int32_t>& tags = output.properties[OvmInteger::FeatureFaces];
  tags.assign(output.topology.faces.size(), 0);
  const auto nameOf = [](const Feature& feature) {
    std::string name = "feature face";
    for (const Index vertex : feature.vertices) name.append(1, ' ').append(std::to_string(vertex));
    return name;
  };
  setOvmTags<n>(
      tags, output.topology.vertexCount, features, [&](std::size_t f) { return loops.ofFace(f); },
      nameOf, [](const Feature& /*feature*/) { return Place{}; });
}

}  // namespace hexhex
