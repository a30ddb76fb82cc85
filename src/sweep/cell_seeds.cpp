#include <base/workspaces.hpp>
#include <sweep/cell_seeds.hpp>

namespace hexhex {

std::uint64_t countOwned(const TetTopology& topology, Index tet, std::span<const SweptLine> lines) {
  CenterOwner owner(topology, tet);
  std::uint64_t count = 0;
  for (const SweptLine& line : lines) count += owner.owned(line).count;
  return count;
}

std::span<const SweptLine> CellSeeds::linesOf(const ExactMap& map, Index tet,
                                              std::vector<SweptLine>& scratch) const {
  if (lines) return lines->of(tet);
  scratch.clear();
  TetSweep(map, tet, SweptGrid::Centers).run(map.unit, scratch);
  return scratch;
}

CellSeeds findCells(const PreparedMap& map, Stage& stage) {
  const std::size_t tets = map.topology.tetCount();
  CellSeeds seeds(tets, true);
  parallelBlocksWith(
      stage, tets, kSweepBlock, [] { return BlockLines(true); },
      [&](std::size_t first, std::size_t end, std::size_t block, BlockLines& lines) {
        lines.clear();
        for (std::size_t t = first; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          TetSweep(map.exact, tet, SweptGrid::Centers).run(map.exact.unit, lines.next());
          seeds.begin[t] = countOwned(map.topology, tet, lines.last());
        }
        seeds.lines->store(block, lines);
        lines.shrink();
      });
  exclusiveScan(std::span(seeds.begin));
  return seeds;
}

}  // namespace hexhex
