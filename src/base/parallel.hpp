// Parallel loops over index ranges. Only parallel.cpp uses oneTBB; without oneTBB, the same
// functions run on the calling thread.
//
// Determinism: the blocks of a loop depend only on the grain, never on the number of threads, so a
// loop whose blocks write to disjoint places gives the same result on any machine.
#pragma once

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/function_ref.hpp>
#include <base/stage.hpp>

namespace hexhex {

/// Number of blocks of a loop over n elements with this grain.
[[nodiscard]] constexpr std::size_t blockCount(std::size_t n, std::size_t grain) noexcept {
  return (n + grain - 1) / grain;
}

/// Called with (begin, end, block).
using BlockFunction = FunctionRef<void(std::size_t, std::size_t, std::size_t)>;

/// Calls f(begin, end, block) for consecutive blocks of `grain` elements of [0, n), in parallel,
/// and checks for cancellation between blocks. The first exception ends the loop and is rethrown.
void parallelBlocks(Stage& stage, std::size_t n, std::size_t grain, BlockFunction f);
/// The same with progress of the caller; null: none, and no checks for cancellation.
void parallelBlocks(LoopProgress* progress, std::size_t n, std::size_t grain, BlockFunction f);

/// Calls f(i) for every i in [0, n), in parallel.
template <class F>
void parallelFor(Stage& stage, std::size_t n, std::size_t grain, const F& f) {
  parallelBlocks(stage, n, grain, [&f](std::size_t begin, std::size_t end, std::size_t /*block*/) {
    for (std::size_t i = begin; i < end; ++i) f(i);
  });
}

/// Lowers the minimum that several threads look for.
inline void lowerTo(std::size_t value, std::atomic<std::size_t>& least) {
  std::size_t known = least.load(std::memory_order_relaxed);
  while (value < known && !least.compare_exchange_weak(known, value)) {
  }
}

/// Calls isGood(i) for all i in [0, n), in parallel.
/// @param grain  of the loop; a block should take at least tens of microseconds
/// @return the smallest i for which it is false, or n
template <class F>
[[nodiscard]] std::size_t firstFault(Stage& stage, std::size_t n, const F& isGood,
                                     std::size_t grain = 4096) {
  std::atomic<std::size_t> first{n};
  parallelBlocks(stage, n, grain, [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!isGood(i)) lowerTo(i, first);
    }
  });
  return first.load();
}

/// Concatenates lists.
template <class T>
[[nodiscard]] std::vector<T> joined(std::span<const std::vector<T>> lists) {
  std::size_t size = 0;
  for (const std::vector<T>& list : lists) size += list.size();
  std::vector<T> all;
  all.reserve(size);
  for (const std::vector<T>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

/// Calls f(begin, end, list) for consecutive blocks as parallelBlocks() does, each with its own
/// list to append to.
/// @return the lists, concatenated
template <class T, class F>
std::vector<T> collectFromBlocks(Stage& stage, std::size_t n, std::size_t grain, const F& f) {
  std::vector<std::vector<T>> blocks(blockCount(n, grain));
  parallelBlocks(stage, n, grain, [&](std::size_t begin, std::size_t end, std::size_t block) {
    f(begin, end, blocks[block]);
  });
  if (blocks.size() == 1) return std::move(blocks.front());
  return joined<T>(blocks);
}

/// Runs f(); parallel loops inside use at most this many threads (0: all cores).
void withThreads(int threads, FunctionRef<void()> f);

/// Never more threads than this, or than cores if there are more of them, whatever the caller asks
/// for: they would only cost time.
inline constexpr int kMaxThreads = 64;

/// The number of threads that `threads` (0: all cores) stands for; 1 without oneTBB.
[[nodiscard]] int effectiveThreads(int threads);

/// The number of threads available to a loop called from here, for work that is divided among
/// threads by hand. No result may depend on it.
[[nodiscard]] int currentThreads();

/// withThreads() for short loops that run many times: if that many threads are in use anyway, calls
/// f() directly, as entering an arena takes some microseconds.
inline void withThreadsHere(int threads, FunctionRef<void()> f) {
  if (currentThreads() == effectiveThreads(threads)) {
    f();
  } else {
    withThreads(threads, f);
  }
}

/// Replaces counts by their exclusive prefix sums. The last element is an unused slot; it receives
/// the total, which is also returned. Sequential: it runs at the speed of memory.
/// @throws Error TooLarge if T cannot hold the total
template <class T>
T exclusiveScan(std::span<T> counts) {
  assert(!counts.empty());
  std::uint64_t sum = 0;
  for (T& entry : counts) {
    const T count = entry;
    entry = static_cast<T>(sum);
    sum += count;
  }
  if (sum != static_cast<T>(sum)) {
    throw Error(ErrorCode::TooLarge, "There are " + std::to_string(sum) +
                                         " items to number, too many for 32 bits. Lower the scale "
                                         "or split the mesh.");
  }
  return static_cast<T>(sum);
}

}  // namespace hexhex
