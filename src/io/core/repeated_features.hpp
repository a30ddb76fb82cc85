// Removes duplicate features.
#pragma once

#include <array>
#include <set>
#include <vector>

#include <hexhex/features.hpp>

#include <base/sorted.hpp>

namespace hexhex::io {

/// The vertices of a feature in ascending order, to compare features.
[[nodiscard]] inline std::array<std::uint32_t, 1> keyOf(const FeatureVertex& feature) {
  return {feature.vertex};
}
template <class Feature>
[[nodiscard]] auto keyOf(const Feature& feature) {
  return sorted(feature.vertices);
}

/// Keeps the first feature of each set of vertices, whatever the tags.
template <class Feature>
void removeRepeated(std::vector<Feature>& features) {
  std::set<decltype(keyOf(features[0]))> seen;
  std::size_t kept = 0;
  for (const Feature& feature : features) {
    if (seen.insert(keyOf(feature)).second) features[kept++] = feature;
  }
  features.resize(kept);
}

}  // namespace hexhex::io
