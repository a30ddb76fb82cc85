// Connected components by union-find, from many threads at once.
#pragma once

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include <hexhex/types.hpp>

namespace hexhex {

/// Disjoint sets of elements 0 .. n-1, at first one per element. A set's representative is its
/// smallest element, whatever the order of calls, so results do not depend on threads.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parents_(n) {
    std::iota(parents_.begin(), parents_.end(), Index{0});
  }
  /// The smallest element of the set of `element`. Thread-safe.
  [[nodiscard]] Index find(Index element) {
    assert(element < parents_.size());
    Index parent = load(element);
    while (parent != element) {
      // Halve the path: the grandparent is in the same set, so skipping to it is always right, even
      // if another thread has found one farther up in the meantime.
      const Index grandparent = load(parent);
      std::atomic_ref(parents_[element]).store(grandparent, std::memory_order_relaxed);
      element = grandparent;
      parent = load(element);
    }
    return element;
  }

  /// Merges the sets of two elements. Thread-safe.
  /// @return the smallest element of both, as far as this thread knows: a good name for the set
  ///         when it is merged with others next
  Index unite(Index a, Index b) {
    while (true) {
      a = find(a);
      b = find(b);
      if (a == b) return a;
      if (a < b) std::swap(a, b);
      // Parents are always smaller, so there are no cycles; if `a` has meanwhile lost its root
      // status to another thread, the exchange fails and we retry.
      Index expected = a;
      if (std::atomic_ref(parents_[a])
              .compare_exchange_strong(expected, b, std::memory_order_relaxed)) {
        return b;
      }
    }
  }

  /// Number of sets. Not while other threads call unite().
  [[nodiscard]] std::uint64_t count() const noexcept {
    std::uint64_t roots = 0;
    for (std::size_t i = 0; i < parents_.size(); ++i) {
      if (parents_[i] == i) ++roots;
    }
    return roots;
  }

 private:
  [[nodiscard]] Index load(Index element) {
    return std::atomic_ref(parents_[element]).load(std::memory_order_relaxed);
  }

  Array<Index> parents_;
};

}  // namespace hexhex
