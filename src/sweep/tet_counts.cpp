// Counts the vertices and cells that tets own, shared among the processes of a team.
#include <string>

#include <hexhex/team.hpp>

#include <base/workspaces.hpp>
#include <sweep/cell_order.hpp>
#include <sweep/tet_counts.hpp>

namespace hexhex::sweep {

namespace {

/// Cells of some tets are counted, not numbered; the other tets have no vertices or cells.
ElementCounts countSome(const igm::PreparedMap& map, const ItemRange& range, Stage& stage) {
  const std::size_t tets = map.topology.tetCount();
  ElementCounts counts;
  counts.cells.assign(tets + 1, 0);
  VertexCounter counter(map, counts.vertices);
  for (std::size_t t = 0; t < tets; ++t) counter.countNothing(static_cast<Index>(t));
  parallelBlocksWith(
      stage, range.end - range.first, kSweepBlock, [] { return std::vector<lattice::SweptLine>(); },
      [&](std::size_t begin, std::size_t end, std::size_t block,
          std::vector<lattice::SweptLine>& lines) {
        for (std::size_t t = range.first + begin; t < range.first + end; ++t) {
          const auto tet = static_cast<Index>(t);
          lattice::TetRasterizer rasterizer(map.exact.corners[t], map.exact.unit);
          lines.clear();
          rasterizer.append(lattice::kVertexGrid, lines);
          counter.count(block, tet, lines);
          lines.clear();
          rasterizer.append(lattice::kCenterGrid, lines);
          counts.cells[t] = lines.empty() ? 0 : countOwned(map.topology, tet, lines);
        }
      });
  counter.finish();
  return counts;
}

/// Combines what each process of a team has counted into the counts of all tets. Sends two numbers
/// per tet, and one for each of its simplices with vertices.
ElementCounts gatherCounts(ProcessTeam& team, const ElementCounts& some, const ItemRange& range) {
  constexpr unsigned kByte = 8;
  std::vector<std::uint64_t> mine;
  const VertexNumbers& own = some.vertices;
  for (std::size_t t = range.first; t < range.end; ++t) {
    const Index generators = own.generatorBegin[t + 1] - own.generatorBegin[t];
    mine.push_back((own.begin[t + 1] - own.begin[t]) << kByte | generators);
    mine.push_back(some.cells[t]);
    for (Index g = own.generatorBegin[t]; g < own.generatorBegin[t + 1]; ++g) {
      mine.push_back(std::uint64_t{own.generators[g].count} << kByte | own.generators[g].simplex);
    }
  }
  const std::vector<std::uint64_t> numbers = team.gather(mine).numbers;
  ElementCounts all;
  all.cells.assign(some.cells.size(), 0);
  VertexNumbers& vertices = all.vertices;
  vertices.begin.assign(some.cells.size(), 0);
  vertices.generatorBegin.assign(some.cells.size(), 0);
  const auto add = [&](std::size_t kind, std::uint64_t count) {
    if (count > 0) ++vertices.generatorCounts[kind];
    vertices.vertexCounts[kind] += count;
  };
  auto next = numbers.begin();
  for (std::size_t t = 0; t + 1 < all.cells.size(); ++t) {
    std::uint64_t inside = vertices.begin[t] = *next >> kByte;
    const auto generators = static_cast<Index>(*next++ & 0xff);
    all.cells[t] = *next++;
    vertices.generatorBegin[t] = generators;
    for (Index g = 0; g < generators; ++g, ++next) {
      const auto count = static_cast<Index>(*next >> kByte);
      const auto simplex = static_cast<lattice::CornerMask>(*next & 0xff);
      vertices.generators.push_back({count, simplex});
      add(static_cast<std::size_t>(lattice::dimension(simplex)), count);
      inside -= count;
    }
    add(3, inside);
  }
  exclusiveScan(std::span(vertices.begin));
  exclusiveScan(std::span(vertices.generatorBegin));
  return all;
}

}  // namespace

ItemRange shareOf(const ProcessTeam* team, std::size_t items) {
  if (team == nullptr) return {0, items};
  return {items * team->rank() / team->size(), items * (team->rank() + 1) / team->size()};
}

ElementCounts countElements(const igm::PreparedMap& map, std::uint64_t expectedCells,
                            ProcessTeam* team, Stage& stage) {
  const ItemRange range = shareOf(team, map.topology.tetCount());
  ElementCounts counts = countSome(map, range, stage);
  if (team != nullptr) counts = gatherCounts(*team, counts, range);
  const std::uint64_t cells = exclusiveScan(std::span(counts.cells));
  if (cells == expectedCells) return counts;
  throw Error(ErrorCode::Internal,
              "The map's parametric volume is " + std::to_string(expectedCells) + ", but " +
                  std::to_string(cells) +
                  " cell centres were found. This is a bug; please report it with the map.");
}

}  // namespace hexhex::sweep
