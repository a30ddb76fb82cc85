// References of MEDIT's formats: one integer for each vertex or element. This library writes tags
// and regions as references, 0 where there are none; and 1 for all quads of a boundary and all
// cells if none of them has any. Other programs do likewise.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex {

/// Whether references say nothing: all are 0, or all are 1.
template <class References, class ReferenceOf>
[[nodiscard]] bool areAllAlike(const References& elements, const ReferenceOf& referenceOf) {
  return elements.empty() ||
         (referenceOf(elements[0]) >= 0 && referenceOf(elements[0]) <= 1 &&
          std::all_of(elements.begin(), elements.end(), [&](const auto& element) {
            return referenceOf(element) == referenceOf(elements[0]);
          }));
}

/// Whether references say anything, looked at by several threads while they read something else.
class SeenReferences {
 public:
  void add(std::int64_t reference) noexcept {
    const unsigned kind = reference == 0 ? kZero : (reference == 1 ? kOne : kOther);
    // Threads share one number, but change it three times at most.
    if ((seen_.load(std::memory_order_relaxed) & kind) == 0) {
      seen_.fetch_or(kind, std::memory_order_relaxed);
    }
  }
  [[nodiscard]] bool saySomething() const noexcept {
    const unsigned seen = seen_.load(std::memory_order_relaxed);
    return seen != 0 && seen != kZero && seen != kOne;
  }

 private:
  static constexpr unsigned kZero = 1;
  static constexpr unsigned kOne = 2;
  static constexpr unsigned kOther = 4;
  std::atomic<unsigned> seen_{0};
};

/// Leaves what is tagged, and nothing if references say nothing.
/// @param features  with references as tags
template <class Feature>
void keepTagged(std::vector<Feature>& features) {
  const auto isUntagged = [](const Feature& feature) { return feature.tag == 0; };
  features.erase(std::remove_if(features.begin(), features.end(), isUntagged), features.end());
}
template <class Feature>
void keepGroups(std::vector<Feature>& features) {
  if (areAllAlike(features, [](const Feature& feature) { return feature.tag; })) features.clear();
  keepTagged(features);
}

/// Regions from the references of cells; nothing if they say nothing.
inline void keepRegions(Array<std::int32_t>& references) {
  if (areAllAlike(references, [](std::int32_t reference) { return reference; })) references = {};
}

/// Tagged vertices from the references of all.
[[nodiscard]] inline std::vector<FeatureVertex> taggedVertices(
    const Array<std::int32_t>& references) {
  std::vector<FeatureVertex> vertices;
  if (areAllAlike(references, [](std::int32_t reference) { return reference; })) return vertices;
  for (std::size_t i = 0; i < references.size(); ++i) {
    if (references[i] != 0) vertices.push_back({static_cast<Index>(i), references[i]});
  }
  return vertices;
}

}  // namespace hexhex
