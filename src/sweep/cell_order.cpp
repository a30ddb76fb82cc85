// Sweeps the centres of cells, and numbers cells by owner.
#include <base/workspaces.hpp>
#include <sweep/cell_order.hpp>

namespace hexhex::sweep {

std::uint64_t countOwned(const adjacency::TetTopology& topology, Index tet,
                         std::span<const lattice::SweptLine> lines) {
  CenterOwner owner(topology, tet);
  std::uint64_t count = 0;
  for (const lattice::SweptLine& line : lines) count += owner.owned(line).count;
  return count;
}

std::span<const lattice::SweptLine> CellCenters::linesOf(
    const igm::ExactMap& map, Index tet, std::vector<lattice::SweptLine>& scratch) const {
  if (lines) return lines->of(tet);
  scratch.clear();
  lattice::TetRasterizer(map.corners[tet], map.unit).append(lattice::kCenterGrid, scratch);
  return scratch;
}

CellCenters findCells(const igm::PreparedMap& map, Stage& stage) {
  const std::size_t tets = map.topology.tetCount();
  CellCenters centers(tets, true);
  parallelBlocksWith(
      stage, tets, kSweepBlock, [] { return BlockLines(true); },
      [&](std::size_t first, std::size_t end, std::size_t block, BlockLines& lines) {
        lines.clear();
        for (std::size_t t = first; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          lattice::TetRasterizer(map.exact.corners[t], map.exact.unit)
              .append(lattice::kCenterGrid, lines.next());
          centers.begin[t] = countOwned(map.topology, tet, lines.last());
        }
        centers.lines->store(block, lines);
        lines.shrink();
      });
  exclusiveScan(std::span(centers.begin));
  return centers;
}

}  // namespace hexhex::sweep
