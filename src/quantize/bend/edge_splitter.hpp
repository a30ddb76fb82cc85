// Splits edges of a tet mesh in their middles.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <base/vector3.hpp>

namespace hexhex::quantization {

/// An edge that is split: its middle is a new vertex, numbered after all others.
using SplitEdge = std::array<Index, 2>;

[[nodiscard]] inline Vec3 middle(const Vec3& a, const Vec3& b) {
  return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
}

class EdgeSplitter {
 public:
  /// @param points, tets  that it changes; no one else does
  EdgeSplitter(std::vector<Vec3>& points, std::vector<Tet>& tets)
      : points_(points), tets_(tets), stars_(points.size()) {
    for (Index t = 0; t < tets.size(); ++t) {
      for (const Index v : tets[t]) stars_[v].push_back(t);
    }
  }

  /// Cuts the tets at an edge in two: one keeps its number, the other is appended.
  /// @param carry  carry(tet, a, b), called after each cut: the last tet is what `tet` was, but for
  ///               corner a, and `tet` is so but for corner b. These are the new vertex.
  /// @return the new vertex
  template <class Carry>
  Index split(const SplitEdge& edge, const Carry& carry) {
    const auto vertex = static_cast<Index>(points_.size());
    points_.push_back(middle(points_[edge[0]], points_[edge[1]]));
    stars_.emplace_back();
    const std::vector<Index> star = stars_[edge[0]];
    for (const Index t : star) {
      if (std::find(tets_[t].begin(), tets_[t].end(), edge[1]) == tets_[t].end()) continue;
      const auto a = static_cast<std::size_t>(adjacency::localCorner(tets_[t], edge[0]));
      const auto b = static_cast<std::size_t>(adjacency::localCorner(tets_[t], edge[1]));
      const auto second = static_cast<Index>(tets_.size());
      tets_.push_back(tets_[t]);
      tets_[t][b] = vertex;
      tets_[second][a] = vertex;
      for (const Index v : tets_[second]) stars_[v].push_back(second);
      stars_[vertex].push_back(t);
      std::erase(stars_[edge[1]], t);
      carry(t, a, b);
    }
    return vertex;
  }

 private:
  std::vector<Vec3>& points_;
  std::vector<Tet>& tets_;
  std::vector<std::vector<Index>> stars_;  ///< the tets at each vertex
};

/// Calls visit(edge, corners) for the six edges of a tet, whose vertices ascend.
template <class Visit>
void forEachEdgeOf(const Tet& tet, const Visit& visit) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      visit(SplitEdge{std::min(tet[i], tet[j]), std::max(tet[i], tet[j])},
            static_cast<lattice::CornerMask>((1U << i) | (1U << j)));
    }
  }
}

/// Sorts a list, and leaves each entry once.
template <class T>
void sortOut(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace hexhex::quantization
