// A counting sort of all cell corners by their vertex.
#include <algorithm>
#include <atomic>
#include <string>

#include <adjacency/vertex_cells.hpp>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>

namespace hexhex {
namespace {

/// Elements per block: enough to make the cost of a block's start negligible.
constexpr std::size_t kGrain = 4096;

/// Throws unless every corner is a vertex and cell numbers fit an Index.
void requireIndexable(const HexMesh& mesh, Stage& stage) {
  if (mesh.cells.size() >= kNone) {
    throw Error(ErrorCode::TooLarge,
                "The mesh has " + std::to_string(mesh.cells.size()) +
                    " cells, but its faces can be found for fewer than 2^32 - 1 cells only. Split "
                    "the mesh or use a smaller scale.");
  }
  requireCornersInRange(mesh, stage);
}

}  // namespace

void requireCornersInRange(const HexMesh& mesh, Stage& stage) {
  const std::size_t bad = firstCellOutOfRange(mesh, stage);
  if (bad == mesh.cells.size()) return;
  throw Error(ErrorCode::InvalidArgument,
              "Cell " + std::to_string(bad) +
                  " of the hexahedral mesh names a vertex that does not exist (the mesh has " +
                  std::to_string(mesh.points.size()) + " vertices). Correct the cell.",
              Place{PlaceKind::Cell, bad, 0});
}

std::size_t firstCellOutOfRange(const HexMesh& mesh, Stage& stage) {
  const std::size_t vertices = std::min<std::size_t>(mesh.points.size(), kNone);
  const auto isOutside = [limit = static_cast<Index>(vertices)](const Hex& cell) {
    unsigned outside = 0;
    for (const Index corner : cell) outside |= corner >= limit ? 1U : 0U;
    return outside;
  };
  std::atomic<std::size_t> first{mesh.cells.size()};
  parallelBlocks(
      stage, mesh.cells.size(), kGrain,
      [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
        const std::span<const Hex> cells(mesh.cells.data() + begin, end - begin);
        unsigned outside = 0;
        for (const Hex& cell : cells) outside |= isOutside(cell);
        if (outside == 0) return;
        std::size_t c = begin;
        while (isOutside(mesh.cells[c]) == 0) ++c;
        std::size_t known = first.load(std::memory_order_relaxed);
        while (c < known && !first.compare_exchange_weak(known, c, std::memory_order_relaxed)) {
        }
      });
  return first.load();
}

VertexCells::VertexCells(const HexMesh& mesh, Stage& stage) {
  requireIndexable(mesh, stage);
  const std::size_t vertices = mesh.points.size();
  // Slot v + 1 counts the cells of v, becomes their beginning, and while they are filled in moves
  // on to their end, which is what stays there.
  ends_.resize(vertices + 1);
  std::fill(ends_.begin(), ends_.end(), 0);
  parallelFor(stage, mesh.cells.size(), kGrain, [&](std::size_t c) {
    for (const Index v : mesh.cells[c]) {
      std::atomic_ref(ends_[v + std::size_t{1}]).fetch_add(1, std::memory_order_relaxed);
    }
  });
  exclusiveScan(std::span(ends_).subspan(1));
  cells_.resize(8 * mesh.cells.size());
  parallelFor(stage, mesh.cells.size(), kGrain, [&](std::size_t c) {
    for (const Index v : mesh.cells[c]) {
      const std::uint64_t place =
          std::atomic_ref(ends_[v + std::size_t{1}]).fetch_add(1, std::memory_order_relaxed);
      cells_[place] = static_cast<Index>(c);
    }
  });
  // Threads fill in any order; sorting makes the table the same for any number of them.
  parallelFor(stage, vertices, kGrain, [&](std::size_t v) {
    std::sort(cells_.begin() + static_cast<std::ptrdiff_t>(ends_[v]),
              cells_.begin() + static_cast<std::ptrdiff_t>(ends_[v + 1]));
  });
}

}  // namespace hexhex
