// Tags as arrays of numbers, for formats that hold arrays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

/// A tag for each vertex, 0 without. Nothing if there are no features.
/// @throws Error InvalidArgument for a vertex that does not exist
[[nodiscard]] inline Array<std::int32_t> vertexTags(const std::vector<FeatureVertex>& features,
                                                    std::size_t vertices) {
  if (features.empty()) return {};
  Array<std::int32_t> tags(vertices);
  std::fill(tags.begin(), tags.end(), 0);
  for (const FeatureVertex& feature : features) {
    if (feature.vertex < tags.size()) {
      tags[feature.vertex] = feature.tag;
      continue;
    }
    throw Error(ErrorCode::InvalidArgument, "A feature names vertex " +
                                                std::to_string(feature.vertex) +
                                                ", which is not one of the mesh.");
  }
  return tags;
}

/// Elements as rows of numbers: the vertices and the tag.
template <class Feature>
[[nodiscard]] std::vector<std::int64_t> rowsOf(const std::vector<Feature>& features) {
  std::vector<std::int64_t> rows;
  for (const Feature& feature : features) {
    rows.insert(rows.end(), feature.vertices.begin(), feature.vertices.end());
    rows.push_back(feature.tag);
  }
  return rows;
}

}  // namespace hexhex
