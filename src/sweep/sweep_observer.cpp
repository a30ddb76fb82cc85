#include <base/workspaces.hpp>
#include <sweep/sweep_observer.hpp>

namespace hexhex {

SweptVertices sweepVertices(const PreparedMap& map, Stage& stage, SweepObserver* observer) {
  const std::size_t tets = map.topology.tetCount();
  SweptVertices swept{TetLines(tets), {}};
  VertexCounter counter(map, swept.numbers);
  const unsigned further = observer == nullptr ? 0U : observer->grids();
  const HalfGridSearch search(static_cast<HalfGridSet>(halfGridBit(kVertexGrid) | further));
  parallelBlocksWith(
      stage, tets, kSweepBlock, [] { return BlockLines(true); },
      [&](std::size_t begin, std::size_t end, std::size_t block, BlockLines& lines) {
        lines.clear();
        for (std::size_t t = begin; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          const HalfGrids grids(map.exact.corners[t], map.exact.unit, search);
          appendLines(grids, kVertexGrid, lines.next());
          counter.count(block, tet, lines.last());
          if (observer != nullptr) observer->add(block, tet, grids);
        }
        swept.lines.store(block, lines);
        lines.shrink();
      });
  counter.finish();
  return swept;
}

}  // namespace hexhex
