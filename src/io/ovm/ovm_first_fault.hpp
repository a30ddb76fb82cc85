// Parallel loops that check while they work, and find the same fault with any number of threads.
#pragma once

#include <atomic>
#include <cstddef>

#include <base/parallel.hpp>

namespace hexhex {

/// Calls isGood(i) for all i in [0, n), in parallel.
/// @param grain  of the loop; a block takes some tens of microseconds at least
/// @return the smallest i for which it is false, or n
template <class F>
[[nodiscard]] std::size_t firstFault(Stage& stage, std::size_t n, const F& isGood,
                                     std::size_t grain = 4096) {
  std::atomic<std::size_t> first{n};
  parallelBlocks(stage, n, grain, [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
    for (std::size_t i = begin; i < end; ++i) {
      if (isGood(i)) continue;
      std::size_t known = first.load(std::memory_order_relaxed);
      while (i < known && !first.compare_exchange_weak(known, i)) {
      }
    }
  });
  return first.load();
}

}  // namespace hexhex
