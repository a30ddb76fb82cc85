// Features and regions of maps and hex meshes, which list few elements, from and to properties,
// which have a value for each.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/features.hpp>

#include <io/ovm/ovm_cells.hpp>
#include <io/ovm/ovm_mesh.hpp>

namespace hexhex::io {

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

/// Gives tagged elements with n vertices their tags.
/// @param features  their vertices need not be in the order of the element
/// @param verticesOf  of an element by its number, in any order
/// @param nameOf, placeOf  of a feature, for messages
template <std::size_t n, class Feature, class Vertices, class Name, class At>
void setOvmTags(Array<std::int32_t>& tags, std::size_t elements, std::size_t vertexCount,
                const std::vector<Feature>& features, const Vertices& verticesOf,
                const Name& nameOf, const At& placeOf) {
  if (features.empty()) return;
  tags.assign(elements, 0);
  const auto sorted = [](std::array<Index, n> vertices) {
    std::sort(vertices.begin(), vertices.end());
    return vertices;
  };
  struct Wanted {
    const Feature* feature;
    Index element;
  };
  std::multimap<std::array<Index, n>, Wanted> wanted;
  // Few vertices of a mesh are the smallest ones of a feature, and all elements are asked.
  Array<std::uint8_t> isSmallest(vertexCount, 0);
  for (const Feature& feature : features) {
    const auto place = wanted.emplace(sorted(feature.vertices), Wanted{&feature, kNone});
    if (place->first[0] < vertexCount) isSmallest[place->first[0]] = 1;
  }
  for (std::size_t i = 0; i < elements; ++i) {
    const std::array<Index, n> vertices = verticesOf(i);
    if (isSmallest[*std::min_element(vertices.begin(), vertices.end())] == 0) continue;
    const auto [begin, end] = wanted.equal_range(sorted(vertices));
    for (auto found = begin; found != end; ++found) {
      found->second.element = static_cast<Index>(i);
    }
  }
  for (const auto& [vertices, entry] : wanted) {
    setOvmValue(tags, entry.element, entry.feature->tag, nameOf(*entry.feature),
                placeOf(*entry.feature));
  }
}

/// Makes properties of features and regions.
/// @param faces  those of `features`
/// @param regions  one per cell, or none
/// @throws Error InvalidArgument if they name what is not in the mesh, or twice; or if there are
///         regions for another number of cells
template <std::size_t n, class Features, class FaceFeature, class Regions>
void setOvmFeatures(OvmProperties& properties, const OvmTopology& topology,
                    const Features& features, const std::vector<FaceFeature>& faces,
                    const Regions& regions) {
  if (!features.vertices.empty()) {
    Array<std::int32_t>& tags = properties[OvmInteger::FeatureVertices];
    tags.assign(topology.vertexCount, 0);
    for (const auto& [vertex, tag] : features.vertices) {
      setOvmValue(tags, vertex, tag, "feature vertex " + std::to_string(vertex),
                  {PlaceKind::Vertex, vertex});
    }
  }
  const auto placeOf = [](const FeatureEdge& feature) {
    return Place{PlaceKind::Edge, feature.vertices[0], feature.vertices[1]};
  };
  setOvmTags<2>(
      properties[OvmInteger::FeatureEdges], topology.edges.size(), topology.vertexCount,
      features.edges, [&](std::size_t e) { return topology.edges[e]; },
      [&](const FeatureEdge& feature) { return "feature " + toString(placeOf(feature)); }, placeOf);
  if (!faces.empty()) {
    const auto nameOf = [](const FaceFeature& feature) {
      std::string name = "feature face";
      for (const Index vertex : feature.vertices)
        name.append(1, ' ').append(std::to_string(vertex));
      return name;
    };
    setOvmTags<n>(
        properties[OvmInteger::FeatureFaces], topology.faces.size(), topology.vertexCount, faces,
        [&](std::size_t f) { return loopOfFace<n>(topology, f); }, nameOf,
        [](const FaceFeature& /*feature*/) { return Place{}; });
  }
  if (!regions.empty() && regions.size() != topology.cells.size()) {
    throw Error(ErrorCode::InvalidArgument,
                "The mesh has " + std::to_string(topology.cells.size()) +
                    " cells, but regions for " + std::to_string(regions.size()) + ".");
  }
  properties[OvmInteger::Region].assign(regions.begin(), regions.end());
}

}  // namespace hexhex::io
