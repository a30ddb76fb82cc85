// The edges of triangles, and how sharp a surface is there.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/vector3.hpp>

namespace hexhex::improvement {

[[nodiscard]] inline std::array<Index, 2> ascending(Index a, Index b) noexcept {
  return {std::min(a, b), std::max(a, b)};
}

/// Twice the area of a triangle, along its normal.
[[nodiscard]] inline Vec3 normalOf(const std::array<Vec3, 3>& t) noexcept {
  return cross(minus(t[1], t[0]), minus(t[2], t[0]));
}

/// 1 if one of them has no length.
[[nodiscard]] inline double cosineBetween(const Vec3& a, const Vec3& b) noexcept {
  const double lengths = length(a) * length(b);
  return lengths > 0 ? dot(a, b) / lengths : 1;
}

/// @param visit  of (vertices, triangles around them): each edge once, its vertices ascending
template <class Visit>
void forEachEdge(std::span<const FeatureFace> triangles, const Visit& visit) {
  struct Side {
    std::array<Index, 2> vertices;
    Index triangle;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::array<Index, 3>& v = triangles[t].vertices;
    for (std::size_t i = 0; i < 3; ++i) {
      sides.push_back({ascending(v[i], v[(i + 1) % 3]), static_cast<Index>(t)});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<Index> around;
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin;
    around.clear();
    for (; end < sides.size() && sides[end].vertices == sides[begin].vertices; ++end) {
      around.push_back(sides[end].triangle);
    }
    visit(sides[begin].vertices, std::span<const Index>(around));
    begin = end;
  }
}

}  // namespace hexhex::improvement
