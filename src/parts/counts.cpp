#include <string>

#include <parts/counts.hpp>

#include <base/workspaces.hpp>
#include <sweep/cell_centers.hpp>

namespace hexhex {

ElementCounts countElements(const PreparedMap& map, std::uint64_t expectedCells, Stage& stage) {
  const std::size_t tets = map.topology.tetCount();
  ElementCounts counts;
  counts.cells.resize(tets + 1);
  counts.cells.back() = 0;
  VertexCounter counter(map, counts.vertices);
  parallelBlocksWith(
      stage, tets, kSweepBlock, [] { return std::vector<SweptLine>(); },
      [&](std::size_t begin, std::size_t end, std::size_t block, std::vector<SweptLine>& lines) {
        for (std::size_t t = begin; t < end; ++t) {
          const auto tet = static_cast<Index>(t);
          TetRasterizer rasterizer(map.exact.corners[t], map.exact.unit);
          lines.clear();
          rasterizer.append(kVertexGrid, lines);
          counter.count(block, tet, lines);
          lines.clear();
          rasterizer.append(kCenterGrid, lines);
          counts.cells[t] = lines.empty() ? 0 : countOwned(map.topology, tet, lines);
        }
      });
  counter.finish();
  const std::uint64_t cells = exclusiveScan(std::span(counts.cells));
  if (cells == expectedCells) return counts;
  throw Error(ErrorCode::Internal,
              "The map's parametric volume is " + std::to_string(expectedCells) + ", but " +
                  std::to_string(cells) +
                  " cell centres were found. This is a bug; please report it with the map.");
}

}  // namespace hexhex
