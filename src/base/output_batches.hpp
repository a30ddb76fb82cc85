// Output whose size only the work itself tells: blocks of elements, some of them at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>

namespace hexhex {

/// How many blocks of a loop are to be in memory at the same time: enough for all threads to be
/// busy, few enough to stay in their caches until they are copied. A thread alone waits for nobody.
[[nodiscard]] inline std::size_t blocksPerBatch(std::size_t blocks) {
  constexpr std::size_t kPerThread = 8;
  const auto threads = static_cast<std::size_t>(currentThreads());
  return std::min(blocks, threads == 1 ? 1 : kPerThread * threads);
}

/// parallelBlocks() in batches of some blocks. After the blocks of a batch, measure(firstBlock,
/// endBlock) is called, and then place(block) for each of them, in parallel: so what blocks collect
/// comes where it belongs as the loop goes, and its memory is used again by the next batch.
/// @param batch  blocks in a batch; no result may depend on it
template <class F, class Measure, class Place>
void parallelBatches(Stage& stage, std::size_t n, std::size_t grain, std::size_t batch, const F& f,
                     const Measure& measure, const Place& place) {
  LoopProgress progress(stage, n);
  const std::size_t blocks = blockCount(n, grain);
  for (std::size_t first = 0; first < blocks; first += batch) {
    const std::size_t count = std::min(batch, blocks - first);
    const std::size_t offset = first * grain;
    const std::size_t size = first + count < blocks ? count * grain : n - offset;
    const auto work = [&](std::size_t begin, std::size_t end, std::size_t block) {
      f(offset + begin, offset + end, first + block);
    };
    detail::runBlocks(size, grain, &progress, BlockFunction(work));
    measure(first, first + count);
    const auto placeOne = [&](std::size_t block, std::size_t, std::size_t) {
      place(first + block);
    };
    detail::runBlocks(count, 1, nullptr, BlockFunction(placeOne));
  }
}

/// The number of tets in a block, so that it has a few hundred of the elements that they own.
[[nodiscard]] inline std::size_t tetsPerBlock(std::uint64_t elements, std::size_t tets) {
  constexpr std::size_t kElements = 256;
  constexpr std::size_t kLargestBlock = 4096;
  return std::clamp(kElements * tets / std::max<std::uint64_t>(elements, 1), std::size_t{1},
                    kLargestBlock);
}

/// Lengthens an array of which a share is complete then. What is reserved beyond is memory that is
/// never written to, if the rest turns out to be smaller.
template <class T>
void lengthen(Array<T>& array, std::size_t size, double share) {
  constexpr double kReserve = 1.1;
  constexpr double kLeastShare = 1.0 / 64;  // the beginning may be far from what is typical
  constexpr double kFirst = 16;
  if (size > array.capacity()) {
    // Nothing is a share of nothing, too.
    const double factor = share >= kLeastShare ? std::max(kReserve / share, kReserve) : kFirst;
    array.reserve(static_cast<std::size_t>(factor * static_cast<double>(size)));
  }
  array.resize(size);
}

}  // namespace hexhex
