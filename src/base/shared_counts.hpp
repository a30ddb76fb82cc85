// Numbers that several threads increase, in whatever order.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>

namespace hexhex {

/// Counts by several threads at once, or by one, which takes a fraction of the time.
class SharedCounts {
 public:
  explicit SharedCounts(std::span<Index> counts) : counts_(counts), alone_(currentThreads() == 1) {}
  /// @return the count before
  Index increase(std::size_t i) const noexcept {
    if (alone_) return counts_[i]++;
    return std::atomic_ref(counts_[i]).fetch_add(1, std::memory_order_relaxed);
  }

 private:
  std::span<Index> counts_;
  bool alone_;
};

}  // namespace hexhex
