// Lists of things at vertices (cells, corners, edges), by a counting sort in which all threads take
// part.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include <adjacency/cell_faces.hpp>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/stage.hpp>

namespace hexhex::adjacency {

/// The values of each vertex, ascending.
/// @tparam Offset  counts all values
template <class T, class Offset = Index>
class VertexLists {
 public:
  VertexLists() = default;

  /// @param forEach  calls its argument with (vertex, value) for each value, from any thread;
  ///                 called twice, to count values and to enter them
  template <class ForEach>
  VertexLists(std::size_t vertexCount, Stage& stage, const ForEach& forEach)
      : ends_(vertexCount + 1) {
    parallelFor(stage, ends_.size(), kGrain, [this](std::size_t v) { ends_[v] = 0; });
    const auto next = [this](Index vertex) {
      assert(vertex + 1 < ends_.size());
      return std::atomic_ref(ends_[vertex]).fetch_add(1, std::memory_order_relaxed);
    };
    forEach([&next](Index vertex, const T& /*value*/) { next(vertex); });
    values_.resize(exclusiveScan(std::span(ends_)));
    // While a list is filled, its begin moves on to its end.
    forEach([&](Index vertex, const T& value) { values_[next(vertex)] = value; });
    assert(ends_.back() == values_.size() && beginOf(vertexCount) == values_.size());
    // Threads come in any order; sorted, lists are the same for any number of them.
    parallelFor(stage, vertexCount, kGrain, [this](std::size_t v) {
      const auto begin = values_.begin() + static_cast<std::ptrdiff_t>(beginOf(v));
      const auto end = values_.begin() + static_cast<std::ptrdiff_t>(ends_[v]);
      if (!std::is_sorted(begin, end)) std::sort(begin, end);
    });
  }

  /// Whether nothing has been listed.
  [[nodiscard]] bool empty() const noexcept { return ends_.empty(); }

  [[nodiscard]] std::span<const T> operator()(std::size_t vertex) const noexcept {
    assert(vertex + 1 < ends_.size());
    const Offset begin = beginOf(vertex);
    return std::span(values_).subspan(begin, ends_[vertex] - begin);
  }

 private:
  static constexpr std::size_t kGrain = 4096;

  [[nodiscard]] Offset beginOf(std::size_t vertex) const noexcept {
    return vertex == 0 ? 0 : ends_[vertex - 1];
  }

  Array<Offset> ends_;
  Array<T> values_;
};

/// The other ends of each vertex's edges.
/// @param edges  each with the smaller vertex first; may occur repeatedly
[[nodiscard]] inline VertexLists<Index> verticesBeside(std::vector<std::array<Index, 2>> edges,
                                                       std::size_t vertexCount, Stage& stage) {
  sortUnique(edges);
  return VertexLists<Index>(vertexCount, stage, [&](const auto& add) {
    for (const auto& [a, b] : edges) {
      add(a, b);
      add(b, a);
    }
  });
}

/// The same for the edges of quads.
[[nodiscard]] inline VertexLists<Index> verticesBeside(std::span<const Quad> quads,
                                                       std::size_t vertexCount, Stage& stage) {
  std::vector<std::array<Index, 2>> edges;
  edges.reserve(4 * quads.size());
  for (const Quad& quad : quads) {
    for (std::size_t i = 0; i < 4; ++i) edges.push_back(ascending(quad[i], quad[(i + 1) % 4]));
  }
  return verticesBeside(std::move(edges), vertexCount, stage);
}

}  // namespace hexhex::adjacency
