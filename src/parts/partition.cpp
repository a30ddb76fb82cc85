#include <algorithm>
#include <cassert>
#include <cmath>

#include <parts/partition.hpp>

#include <hexhex/team.hpp>

#include <base/sorted.hpp>
#include <lattice/wide_int.hpp>
#include <sweep/cell_order.hpp>
#include <sweep/tet_positions.hpp>

namespace hexhex::parts {

namespace {

/// Parts differ from the mean by at most one element: 32 elements per part leave slack below 5 %,
/// part of which METIS and Scotch use.
constexpr std::uint64_t kElementsPerPart = 32;

Vec3 middleOf(const igm::PreparedMap& map, Index tet) {
  Vec3 middle{};
  for (const Index vertex : map.topology.tets[tet]) {
    for (std::size_t k = 0; k < 3; ++k) middle[k] += map.input.view.points[vertex][k] / 4;
  }
  return middle;
}

/// The largest cube of at most `cells` cells.
std::int32_t sideOf(std::uint64_t cells) {
  auto side = static_cast<std::uint64_t>(std::cbrt(static_cast<double>(cells)));
  while (side * side * side > cells) --side;
  while ((side + 1) * (side + 1) * (side + 1) <= cells) ++side;
  return static_cast<std::int32_t>(std::max<std::uint64_t>(side, 1));
}

/// Covers the cells of a tet with blocks.
/// @param cells  of the tet
/// @param most   cells per block
TetBlocks coverWithBlocks(const igm::PreparedMap& map, Index tet, std::uint64_t cells,
                          std::uint64_t most) {
  const lattice::GridBox box =
      lattice::gridBox(map.exact.corners[tet], map.exact.unit, lattice::kCenterGrid);
  TetBlocks blocks;
  blocks.tet = tet;
  for (std::size_t k = 0; k < 3; ++k) blocks.low[k] = box.range[k].first;
  // A tet may be a needle in its box; then larger blocks hold no more cells.
  const double enough = 64.0 * (static_cast<double>(cells) / static_cast<double>(most) + 64);
  for (blocks.side = sideOf(most);; blocks.side *= 2) {
    double count = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t length = std::int64_t{box.range[k].last} - box.range[k].first;
      blocks.size[k] = static_cast<std::uint32_t>(length / blocks.side + 1);
      count *= blocks.size[k];
    }
    if (count <= enough) return blocks;
  }
}

/// Number of the tet's cells in each of its blocks.
void countCells(const igm::PreparedMap& map, const TetBlocks& blocks,
                std::span<std::uint64_t> counts) {
  std::vector<lattice::SweptLine> lines;
  lattice::TetRasterizer(map.exact.corners[blocks.tet], map.exact.unit)
      .append(lattice::kCenterGrid, lines);
  sweep::CenterOwner owner(map.topology, blocks.tet);
  for (const lattice::SweptLine& line : lines) {
    auto [first, count] = owner.owned(line);
    while (count > 0) {
      const lattice::GridPoint z = line.point(first);
      const std::uint32_t run = std::min(count, blocks.cellsAhead(z, line.axes));
      assert(blocks.blockOf(z) < blocks.count());
      counts[blocks.blockOf(z)] += run;
      first += run;
      count -= run;
    }
  }
}

/// Splits tets with more cells than an element may have into blocks.
void makeBlocks(const PartitionInput& input, std::uint64_t most, Partition& partition) {
  const std::size_t tets = input.map.topology.tetCount();
  partition.ofTet.assign(tets, 0);
  std::size_t count = 0;
  for (std::size_t t = 0; t < tets; ++t) {
    const std::uint64_t cells = input.counts.cells[t + 1] - input.counts.cells[t];
    if (cells <= most) continue;
    partition.ofTet[t] = Partition::kSplit + static_cast<std::uint32_t>(partition.blocks.size());
    partition.blocks.push_back(coverWithBlocks(input.map, static_cast<Index>(t), cells, most));
    partition.blocks.back().first = count;
    count += partition.blocks.back().count();
  }
  partition.ofBlock.assign(count, kNone);
  partition.inBlock.assign(count, 0);
}

/// Counts the cells of all blocks. The processes of a team share the work.
void countCells(const PartitionInput& input, Partition& partition, Stage& stage) {
  const std::vector<TetBlocks>& blocks = partition.blocks;
  const auto [first, end] = sweep::shareOf(input.team, blocks.size());
  const auto placeOf = [&](std::size_t i) {
    return i < blocks.size() ? blocks[i].first : partition.inBlock.size();
  };
  constexpr std::size_t kTetsPerBlock = 8;
  const std::size_t skipped = first;
  parallelFor(stage, end - first, kTetsPerBlock, [&](std::size_t i) {
    const TetBlocks& some = blocks[skipped + i];
    countCells(input.map, some, std::span(partition.inBlock).subspan(some.first, some.count()));
  });
  if (input.team == nullptr) return;
  const auto mine =
      std::span(partition.inBlock).subspan(placeOf(first), placeOf(end) - placeOf(first));
  partition.inBlock = input.team->gather(mine).numbers;
}

std::vector<PartitionElement> listElements(const PartitionInput& input,
                                           const Partition& partition) {
  const igm::PreparedMap& map = input.map;
  const Array<std::uint64_t>& cells = input.counts.cells;
  std::vector<PartitionElement> elements;
  for (std::size_t t = 0; t < map.topology.tetCount(); ++t) {
    const auto tet = static_cast<Index>(t);
    const TetBlocks* const blocks = partition.blocksOf(tet);
    if (blocks == nullptr) {
      elements.push_back({tet, kNone, 0, cells[t + 1] - cells[t], middleOf(map, tet)});
      continue;
    }
    const lattice::GridBox box = lattice::gridBox(map.exact.corners[tet], map.exact.unit);
    const sweep::TetPositions positions(map, tet, lattice::chooseSweepAxes(box));
    for (std::size_t b = 0; b < blocks->count(); ++b) {
      const std::uint64_t inBlock = partition.inBlock[blocks->first + b];
      if (inBlock == 0) continue;
      lattice::GridPoint z = blocks->lowOf(b);
      for (std::int32_t& coordinate : z) coordinate += blocks->side / 2;
      const Index number = partition.ofTet[t] - Partition::kSplit;
      elements.push_back({tet, number, b, inBlock, positions.at(lattice::kWholeTet, z)});
    }
  }
  return elements;
}

/// Records the assignment, and lists the tets of each part.
void assign(const std::vector<PartitionElement>& elements, const std::vector<std::uint32_t>& partOf,
            Partition& partition) {
  struct Entry {
    std::uint32_t part;
    Index tet;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  entries.reserve(elements.size());
  assert(partOf.size() == elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const PartitionElement& element = elements[i];
    assert(partOf[i] < partition.parts);
    if (element.blocks == kNone) {
      partition.ofTet[element.tet] = partOf[i];
    } else {
      partition.ofBlock[partition.blocks[element.blocks].first + element.block] = partOf[i];
    }
    entries.push_back({partOf[i], element.tet});
  }
  sortUnique(entries);
  partition.begin.assign(std::size_t{partition.parts} + 1, 0);
  for (const Entry& entry : entries) {
    ++partition.begin[std::size_t{entry.part} + 1];
    partition.tets.push_back(entry.tet);
  }
  for (std::size_t p = 0; p < partition.parts; ++p) partition.begin[p + 1] += partition.begin[p];
  assert(partition.begin.back() == partition.tets.size());
}

}  // namespace

Partition makePartition(const PartitionInput& input, std::uint32_t parts, PartitionMethod method,
                        Context& context) {
  Partition partition;
  partition.parts = parts;
  const std::uint64_t cells = input.counts.cells.back();
  makeBlocks(input, std::max<std::uint64_t>(cells / parts / kElementsPerPart, 1), partition);
  {
    Stage stage(context, "sweep");
    countCells(input, partition, stage);
  }
  const Stage stage(context, "partition");
  std::vector<PartitionElement> elements = listElements(input, partition);
  const std::vector<std::uint32_t> partOf = method == PartitionMethod::Curve
                                                ? bisect(elements, parts)
                                                : cutGraph(input.map, partition, elements, method);
  assign(elements, partOf, partition);
  return partition;
}

}  // namespace hexhex::parts
