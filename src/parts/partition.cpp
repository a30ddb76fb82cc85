#include <algorithm>
#include <cmath>

#include <parts/graph_cut.hpp>
#include <parts/partition.hpp>

#include <lattice/wide_int.hpp>
#include <sweep/cell_centers.hpp>
#include <sweep/tet_positions.hpp>

namespace hexhex {

namespace {

/// Parts differ from the mean by no more than one element: 32 elements for a part leave room below
/// 5 %, of which METIS and Scotch use some.
constexpr std::uint64_t kElementsPerPart = 32;

Vec3 middleOf(const PreparedMap& map, Index tet) {
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

/// Covers the cells of a tet.
/// @param cells  of the tet
/// @param most   cells in a block
TetBlocks coverWithBlocks(const PreparedMap& map, Index tet, std::uint64_t cells,
                          std::uint64_t most) {
  const GridBox box = gridBox(map.exact.corners[tet], map.exact.unit, kCenterGrid);
  TetBlocks blocks;
  blocks.tet = tet;
  for (std::size_t k = 0; k < 3; ++k) blocks.low[k] = box.range[k].first;
  // A tet may be a needle in its box: larger blocks hold no more cells then.
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

/// How many cells of the tet each of its blocks has.
std::vector<std::uint64_t> countCells(const PreparedMap& map, const TetBlocks& blocks) {
  std::vector<std::uint64_t> counts(blocks.count(), 0);
  std::vector<SweptLine> lines;
  TetRasterizer(map.exact.corners[blocks.tet], map.exact.unit).append(kCenterGrid, lines);
  CenterOwner owner(map.topology, blocks.tet);
  for (const SweptLine& line : lines) {
    auto [first, count] = owner.owned(line);
    while (count > 0) {
      const GridPoint z = line.point(first);
      const std::uint32_t run = std::min(count, blocks.cellsAhead(z, line.axes));
      counts[blocks.blockOf(z)] += run;
      first += run;
      count -= run;
    }
  }
  return counts;
}

class Elements {
 public:
  Elements(const PreparedMap& map, const ElementCounts& counts, std::uint64_t most,
           Partition& partition)
      : map_(map), counts_(counts), most_(most), partition_(partition) {}

  [[nodiscard]] std::vector<PartitionElement> list() {
    const std::size_t tets = map_.topology.tetCount();
    partition_.ofTet.assign(tets, 0);
    for (std::size_t t = 0; t < tets; ++t) {
      const auto tet = static_cast<Index>(t);
      const std::uint64_t cells = counts_.cells[t + 1] - counts_.cells[t];
      if (cells > most_) {
        split(tet, cells);
      } else {
        elements_.push_back({tet, kNone, 0, cells, middleOf(map_, tet)});
      }
    }
    return std::move(elements_);
  }

 private:
  void split(Index tet, std::uint64_t cellsOfTet) {
    TetBlocks blocks = coverWithBlocks(map_, tet, cellsOfTet, most_);
    blocks.first = partition_.ofBlock.size();
    const auto number = static_cast<Index>(partition_.blocks.size());
    const GridBox box = gridBox(map_.exact.corners[tet], map_.exact.unit);
    const TetPositions positions(map_, tet, chooseSweepAxes(box));
    const std::vector<std::uint64_t> cells = countCells(map_, blocks);
    for (std::size_t b = 0; b < cells.size(); ++b) {
      if (cells[b] == 0) continue;
      GridPoint z = blocks.lowOf(b);
      for (std::int32_t& coordinate : z) coordinate += blocks.side / 2;
      elements_.push_back({tet, number, b, cells[b], positions.at(kWholeTet, z)});
    }
    partition_.ofTet[tet] = Partition::kSplit + number;
    partition_.ofBlock.resize(blocks.first + blocks.count(), kNone);
    partition_.inBlock.insert(partition_.inBlock.end(), cells.begin(), cells.end());
    partition_.blocks.push_back(blocks);
  }

  const PreparedMap& map_;
  const ElementCounts& counts_;
  std::uint64_t most_;
  Partition& partition_;
  std::vector<PartitionElement> elements_;
};

/// Enters what was decided, and lists the tets of each part.
void assign(const std::vector<PartitionElement>& elements, const std::vector<std::uint32_t>& partOf,
            Partition& partition) {
  struct Entry {
    std::uint32_t part;
    Index tet;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  entries.reserve(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const PartitionElement& element = elements[i];
    if (element.blocks == kNone) {
      partition.ofTet[element.tet] = partOf[i];
    } else {
      partition.ofBlock[partition.blocks[element.blocks].first + element.block] = partOf[i];
    }
    entries.push_back({partOf[i], element.tet});
  }
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  partition.begin.assign(std::size_t{partition.parts} + 1, 0);
  for (const Entry& entry : entries) {
    ++partition.begin[std::size_t{entry.part} + 1];
    partition.tets.push_back(entry.tet);
  }
  for (std::size_t p = 0; p < partition.parts; ++p) partition.begin[p + 1] += partition.begin[p];
}

}  // namespace

Partition makePartition(const PreparedMap& map, const ElementCounts& counts, std::uint32_t parts,
                        PartitionMethod method) {
  Partition partition;
  partition.parts = parts;
  const std::uint64_t cells = counts.cells.back();
  const std::uint64_t most = std::max<std::uint64_t>(cells / parts / kElementsPerPart, 1);
  std::vector<PartitionElement> elements = Elements(map, counts, most, partition).list();
  const std::vector<std::uint32_t> partOf = method == PartitionMethod::Curve
                                                ? bisect(elements, parts)
                                                : cutGraph(map, partition, elements, method);
  assign(elements, partOf, partition);
  return partition;
}

}  // namespace hexhex
