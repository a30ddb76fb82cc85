// Lists of what vertices have, which all threads fill at once: a first look counts, a second one
// enters.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>

namespace hexhex {

/// Up to 2^32 - 1 values altogether.
template <class T>
class VertexLists {
 public:
  VertexLists(std::size_t vertexCount, Stage& stage) : ends_(vertexCount + 1) {
    constexpr std::size_t kGrain = std::size_t{1} << 14;
    parallelFor(stage, ends_.size(), kGrain, [this](std::size_t v) { ends_[v] = 0; });
  }

  /// First, for each value; from any thread.
  void count(Index vertex) noexcept { next(vertex); }
  /// Then, once.
  void makeRoom() { values_.resize(exclusiveScan(std::span(ends_))); }
  /// Then, for each value that was counted; from any thread, so that they come in any order.
  void enter(Index vertex, T value) noexcept { values_[next(vertex)] = value; }

  /// The list of a vertex, when all is entered.
  [[nodiscard]] std::span<T> at(std::size_t vertex) noexcept {
    return std::span(values_).subspan(beginOf(vertex), ends_[vertex] - beginOf(vertex));
  }
  [[nodiscard]] std::span<const T> at(std::size_t vertex) const noexcept {
    return std::span(values_).subspan(beginOf(vertex), ends_[vertex] - beginOf(vertex));
  }

 private:
  [[nodiscard]] Index beginOf(std::size_t vertex) const noexcept {
    return vertex == 0 ? 0 : ends_[vertex - 1];
  }
  Index next(Index vertex) noexcept {
    return std::atomic_ref(ends_[vertex]).fetch_add(1, std::memory_order_relaxed);
  }

  /// Per vertex: the count, then where its list begins, and in the end where it ends.
  Array<Index> ends_;
  Array<T> values_;
};

}  // namespace hexhex
