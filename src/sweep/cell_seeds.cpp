#include <sweep/cell_seeds.hpp>

namespace hexhex {

Array<std::uint64_t> numberCells(const PreparedMap& map, TetLines* lines, Stage& stage) {
  const std::size_t tets = map.topology.tetCount();
  Array<std::uint64_t> begin(tets + 1);
  begin[tets] = 0;
  parallelBlocks(stage, tets, kSweepBlock,
                 [&](std::size_t first, std::size_t end, std::size_t block) {
                   std::vector<SweptLine> blockLines;
                   std::vector<Index> begins;
                   for (std::size_t t = first; t < end; ++t) {
                     const auto tet = static_cast<Index>(t);
                     if (lines == nullptr) blockLines.clear();
                     const std::size_t before = blockLines.size();
                     begins.push_back(static_cast<Index>(before));
                     TetSweep(map.exact, tet, SweptGrid::Centers).run(map.exact.unit, blockLines);
                     CenterOwner owner(map.topology, tet);
                     std::uint64_t count = 0;
                     for (std::size_t i = before; i < blockLines.size(); ++i) {
                       count += owner.owned(blockLines[i]).count;
                     }
                     begin[t] = count;
                   }
                   if (lines != nullptr) lines->store(block, blockLines, begins);
                 });
  exclusiveScan(std::span(begin));
  return begin;
}

}  // namespace hexhex
