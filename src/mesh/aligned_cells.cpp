#include <algorithm>
#include <atomic>

#include <base/parallel.hpp>
#include <mesh/aligned_cells.hpp>

namespace hexhex {

AlignedCells::AlignedCells(std::size_t vertexCount, std::span<const Hex> cells, Stage& stage)
    : cells_(cells), firstCell_(vertexCount) {
  constexpr std::size_t kGrain = std::size_t{1} << 14;
  parallelFor(stage, vertexCount, kGrain, [this](std::size_t v) { firstCell_[v] = kNone; });
  // Cells beyond what an index can name are not found.
  parallelFor(stage, std::min<std::size_t>(cells.size(), kNone), kGrain, [this](std::size_t c) {
    std::atomic_ref(firstCell_[cells_[c][0]])
        .store(static_cast<Index>(c), std::memory_order_relaxed);
  });
}

}  // namespace hexhex
