// Loops whose output size is known only once the work is done: a few blocks of elements at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>

namespace hexhex::curved {

/// Number of blocks of a loop that are in memory at the same time: enough to keep all threads busy,
/// few enough to stay in their caches until they are copied. A single thread waits for no other.
[[nodiscard]] inline std::size_t blocksPerBatch(std::size_t blocks) {
  constexpr std::size_t kPerThread = 8;
  const auto threads = static_cast<std::size_t>(currentThreads());
  return std::min(blocks, threads == 1 ? 1 : kPerThread * threads);
}

/// parallelBlocks() in batches: f(begin, end, pieces) fills pieces, whose memory the next batch
/// reuses. After each batch, measure(pieces, end) is called for its blocks in order, makes room and
/// returns a position. Then place(pieces, position, begin) is called for each block in parallel. So
/// the output is in its final place as the loop advances.
template <class Pieces, class F, class Measure, class Place>
void parallelBatches(Stage& stage, std::size_t n, std::size_t grain, const F& f,
                     const Measure& measure, const Place& place) {
  struct Block {
    std::size_t begin = 0;
    std::size_t end = 0;
    Pieces pieces;
    std::invoke_result_t<Measure, const Pieces&, std::size_t> position{};
  };
  LoopProgress progress(stage, n);
  std::vector<Block> batch(blocksPerBatch(blockCount(n, grain)));
  for (std::size_t first = 0; first < n; first += batch.size() * grain) {
    const std::size_t size = std::min(batch.size() * grain, n - first);
    const auto fill = [&](std::size_t begin, std::size_t end, std::size_t i) {
      batch[i].begin = first + begin;
      batch[i].end = first + end;
      f(first + begin, first + end, batch[i].pieces);
    };
    parallelBlocks(&progress, size, grain, fill);
    const std::size_t count = blockCount(size, grain);
    for (std::size_t i = 0; i < count; ++i) {
      batch[i].position = measure(std::as_const(batch[i].pieces), batch[i].end);
    }
    const auto placeOne = [&](std::size_t i, std::size_t /*end*/, std::size_t /*block*/) {
      place(std::as_const(batch[i].pieces), batch[i].position, batch[i].begin);
    };
    parallelBlocks(nullptr, count, 1, placeOne);
  }
}

/// Number of tets per block such that a block owns a few hundred elements.
[[nodiscard]] inline std::size_t tetsPerBlock(std::uint64_t elements, std::size_t tets) {
  constexpr std::uint64_t kElements = 256;
  constexpr std::uint64_t kLargestBlock = 4096;
  return static_cast<std::size_t>(std::clamp(
      kElements * tets / std::max<std::uint64_t>(elements, 1), std::uint64_t{1}, kLargestBlock));
}

/// Lengthens an array of which a share will then be complete. It reserves extra memory; if the rest
/// turns out smaller, that memory is never written to.
template <class T>
void lengthen(Array<T>& array, std::size_t size, double share) {
  constexpr double kReserve = 1.1;
  constexpr double kLeastShare = 1.0 / 64;  // the beginning may be far from typical
  constexpr double kFirst = 16;
  if (size > array.capacity()) {
    // Also covers a share of nothing.
    const double factor = share >= kLeastShare ? std::max(kReserve / share, kReserve) : kFirst;
    array.reserve(static_cast<std::size_t>(factor * static_cast<double>(size)));
  }
  array.resize(size);
}

}  // namespace hexhex::curved
