#include <algorithm>
#include <atomic>

#include <adjacency/aligned_cells.hpp>

#include <base/parallel.hpp>

namespace hexhex {

AlignedCells::AlignedCells(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage)
    : cells_(cells), cellAt_(vertexCount) {
  constexpr std::size_t kGrain = std::size_t{1} << 14;
  parallelFor(stage, vertexCount, kGrain, [this](std::size_t v) { cellAt_[v] = kNone; });
  const auto enter = [this](std::size_t c) {
    const auto cell = static_cast<Index>(c);
    const std::atomic_ref place(cellAt_[cells_[c][0]]);
    Index known = place.load(std::memory_order_relaxed);
    while (known == kNone || known < cell) {
      if (place.compare_exchange_weak(known, cell, std::memory_order_relaxed)) return;
    }
  };
  // Cells beyond what an index can name are not found.
  parallelFor(stage, std::min<std::size_t>(cells.size(), kNone), kGrain, enter);
}

}  // namespace hexhex
