// Numbers that several threads increase, in whatever order.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <utility>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>

namespace hexhex {

/// Counts by several threads at once, or by one, which takes a fraction of the time. To be made by
/// the thread that starts the work.
class SharedCounts {
 public:
  explicit SharedCounts(std::span<Index> counts) : counts_(counts), alone_(currentThreads() == 1) {}
  /// @return the count before
  Index increase(std::size_t i, Index by = 1) const noexcept {
    if (alone_) return std::exchange(counts_[i], counts_[i] + by);
    return std::atomic_ref(counts_[i]).fetch_add(by, std::memory_order_relaxed);
  }

 private:
  std::span<Index> counts_;
  bool alone_;
};

}  // namespace hexhex
