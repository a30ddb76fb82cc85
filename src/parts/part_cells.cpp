#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include <parts/part_cells.hpp>

#include <base/workspaces.hpp>
#include <sweep/tet_positions.hpp>

namespace hexhex::parts {

namespace {

/// Tets per block of work: a part may have few tets with many cells each.
constexpr std::size_t kFewTets = 8;

}  // namespace

template <class Id>
PartGrid<Id>::PartGrid(const igm::PreparedMap& map, const sweep::ElementCounts& counts,
                       const Partition& partition, const atlas::Charts& charts)
    : map_(map), counts_(counts), partition_(partition), all_(charts), charts_(charts) {
  std::fill(charts_.chart.begin(), charts_.chart.end(), atlas::Charts::kNoChart);
}

template <class Id>
void PartGrid<Id>::enter(atlas::GridRegion region, Stage& stage) {
  clear();
  assert(std::ranges::all_of(charts_.chart,
                             [](Index chart) { return chart == atlas::Charts::kNoChart; }));
  region_ = std::move(region);
  for (const Index tet : region_.tets) charts_.chart[tet] = all_.chart[tet];
  vertices_.emplace(map_, charts_, counts_.vertices, region_, stage);
  vertices_->fill({}, stage);
  vertices_->resolveOverlaps(stage);
  transitions_ = atlas::markCutCells(map_, charts_, region_, vertices_->grid(), stage).transitions;
}

template <class Id>
void PartGrid<Id>::clear() noexcept {
  vertices_.reset();
  for (const Index tet : region_.tets) charts_.chart[tet] = atlas::Charts::kNoChart;
  charts_.count = all_.count;
  region_ = {};
}

template <class Id>
std::vector<lattice::SweptLine> PartGrid<Id>::centersOf(Index tet) const {
  std::vector<lattice::SweptLine> lines;
  if (counts_.cells[tet] == counts_.cells[std::size_t{tet} + 1]) return lines;
  lattice::TetRasterizer(map_.exact.corners[tet], map_.exact.unit)
      .append(lattice::kCenterGrid, lines);
  return lines;
}

template <class Id>
GlobalCells<Id> PartGrid<Id>::ownCells(std::uint32_t part, Stage& stage) const {
  const std::span<const Index> tets = partition_.tetsOf(part);
  std::vector<std::uint64_t> begin(tets.size() + 1, 0);
  for (std::size_t i = 0; i < tets.size(); ++i) {
    const TetBlocks* const blocks = partition_.blocksOf(tets[i]);
    begin[i] = blocks != nullptr ? partition_.cellsOf(*blocks, part)
                                 : counts_.cells[std::size_t{tets[i]} + 1] - counts_.cells[tets[i]];
  }
  GlobalCells<Id> cells;
  const std::uint64_t count = exclusiveScan(std::span(begin));
  cells.numbers.resize(count);
  cells.corners.resize(count);
  parallelForWith(
      stage, tets.size(), kFewTets,
      [&] { return atlas::CellEmitter<Id>(map_, *vertices_, transitions_, true); },
      [&](std::size_t i, atlas::CellEmitter<Id>& emitter) {
        std::uint64_t at = begin[i];
        const Index tet = tets[i];
        forEachRun(map_, partition_, part, tet, centersOf(tet),
                   [&](const lattice::SweptLine& line, std::uint32_t first, std::uint32_t run,
                       std::uint64_t number) {
                     emitter.emitOn(tet, line, first, std::span(cells.corners).subspan(at, run));
                     for (std::uint32_t k = 0; k < run; ++k) {
                       cells.numbers[at++] = counts_.cells[tet] + number + k;
                     }
                   });
        assert(at == begin[i + 1]);
      });
  return cells;
}

template <class Id>
struct PartGrid<Id>::Surroundings {
  std::uint32_t part;
  atlas::CellEmitter<Id> emitter;
  std::optional<VertexSet::Cache> touched;
  std::vector<std::array<Id, 8>> cells;  ///< reused memory
};

template <class Id>
void PartGrid<Id>::addNearby(std::size_t i, Surroundings& around,
                             std::vector<NearbyCell<Id>>& list) const {
  const Index tet = region_.tets[i];
  const std::vector<lattice::SweptLine> lines = centersOf(tet);
  atlas::BoxedLines boxed(region_.boxesOf(i), 1);
  sweep::CenterOwner owner(map_.topology, tet);
  std::uint64_t number = counts_.cells[tet];
  for (const lattice::SweptLine& line : lines) {
    const auto [first, count] = owner.owned(line);
    const auto add = [&, first = first](std::uint32_t other, std::uint32_t at, std::uint32_t run) {
      if (other == around.part) return;
      around.cells.resize(run);
      around.emitter.emitOn(tet, line, at, around.cells);
      for (std::uint32_t k = 0; k < run; ++k) {
        if (around.touched && !around.touched->holdsAny(around.cells[k])) continue;
        const CellPlace place{tet, line.simplex(at + k), line.point(at + k)};
        list.push_back({number + (at + k - first), other, place, around.cells[k]});
      }
    };
    for (const atlas::LinePoints& range : boxed.of(line)) {
      const std::uint32_t from = std::max(first, range.first);
      const std::uint32_t to = std::min(first + count, range.first + range.count);
      if (from < to) partition_.forEachPiece(tet, line, from, to - from, add);
    }
    number += count;
  }
}

template <class Id>
std::vector<NearbyCell<Id>> PartGrid<Id>::nearbyCells(std::uint32_t part, const VertexSet* touched,
                                                      Stage& stage) const {
  using Nearby = NearbyCell<Id>;
  std::vector<std::vector<Nearby>> blocks(blockCount(region_.tets.size(), kFewTets));
  parallelBlocksWith(
      stage, region_.tets.size(), kFewTets,
      [&] {
        Surroundings around{
            part, atlas::CellEmitter<Id>(map_, *vertices_, transitions_, true), {}, {}};
        if (touched != nullptr) around.touched.emplace(*touched);
        return around;
      },
      [&](std::size_t begin, std::size_t end, std::size_t block, Surroundings& around) {
        for (std::size_t i = begin; i < end; ++i) {
          // A tet without boxes belongs to the part alone.
          if (!region_.boxesOf(i).empty()) addNearby(i, around, blocks[block]);
        }
      });
  return joined<Nearby>(blocks);
}

template class PartGrid<std::uint32_t>;
template class PartGrid<std::uint64_t>;

namespace {

/// The requested vertices of one tet.
struct OwnersVertices {
  Index tet;
  std::size_t begin;  ///< in the list of numbers
  std::size_t end;
};

std::vector<OwnersVertices> groupByOwner(const sweep::ElementCounts& counts,
                                         std::span<const std::uint64_t> numbers) {
  const Array<std::uint64_t>& begin = counts.vertices.begin;
  std::vector<OwnersVertices> groups;
  for (std::size_t i = 0; i < numbers.size();) {
    const auto behind = std::upper_bound(begin.begin(), begin.end(), numbers[i]);
    std::size_t end = i;
    while (end < numbers.size() && numbers[end] < *behind) ++end;
    groups.push_back({static_cast<Index>(behind - begin.begin() - 1), i, end});
    i = end;
  }
  return groups;
}

class Describer {
 public:
  Describer(const igm::PreparedMap& map, const sweep::ElementCounts& counts,
            std::span<const std::uint64_t> numbers, std::size_t first, HexMesh& mesh)
      : map_(map), counts_(counts), numbers_(numbers), first_(first), mesh_(mesh) {}

  void describe(const OwnersVertices& wanted) {
    lines_.clear();
    lattice::TetRasterizer(map_.exact.corners[wanted.tet], map_.exact.unit)
        .append(lattice::kVertexGrid, lines_);
    const lattice::SweepAxes axes = lines_.front().axes;
    const sweep::TetPositions positions(map_, wanted.tet, axes);
    sweep::TetNumbering(map_, counts_.vertices, wanted.tet, axes)
        .run(lines_, [&](const sweep::VertexRun& run) {
          if (run.owned) describe(run, wanted, positions);
        });
  }

 private:
  void describe(const sweep::VertexRun& run, const OwnersVertices& wanted,
                const sweep::TetPositions& positions) {
    const auto last = numbers_.begin() + static_cast<std::ptrdiff_t>(wanted.end);
    // Interior vertices are numbered in the order of the sweep, so the next one is found quickly.
    auto next = std::lower_bound(numbers_.begin() + static_cast<std::ptrdiff_t>(wanted.begin), last,
                                 run.first);
    while (next != last && *next < run.first + run.count) {
      // Consecutive ones at once.
      const auto from = next;
      const auto i = static_cast<std::uint32_t>(*from - run.first);
      do {
        ++next;
      } while (next != last && *next < run.first + run.count && *next == *(next - 1) + 1);
      const auto count = static_cast<std::uint32_t>(next - from);
      const std::size_t at = first_ + static_cast<std::size_t>(from - numbers_.begin());
      const lattice::SweptLine& line = *run.line;
      if (run.simplex == lattice::kWholeTet) {
        positions.alongLine(line.level, line.row,
                            line.first + static_cast<std::int32_t>(run.offset + i), count,
                            &mesh_.points[at]);
      } else {
        for (std::uint32_t k = 0; k < count; ++k) {
          mesh_.points[at + k] = positions.at(run.simplex, line.point(run.offset + i + k));
        }
      }
      std::fill_n(mesh_.generatorTet.begin() + static_cast<std::ptrdiff_t>(at), count, wanted.tet);
      std::fill_n(mesh_.generatorCorners.begin() + static_cast<std::ptrdiff_t>(at), count,
                  map_.input.callersCorners(run.simplex));
    }
  }

  const igm::PreparedMap& map_;
  const sweep::ElementCounts& counts_;
  std::span<const std::uint64_t> numbers_;
  std::size_t first_;
  HexMesh& mesh_;
  std::vector<lattice::SweptLine> lines_;
};

}  // namespace

void describeVertices(const igm::PreparedMap& map, const sweep::ElementCounts& counts,
                      std::span<const std::uint64_t> numbers, std::size_t first, HexMesh& mesh,
                      Stage& stage) {
  assert(std::is_sorted(numbers.begin(), numbers.end()));
  assert(first + numbers.size() <= mesh.points.size());
  const std::vector<OwnersVertices> groups = groupByOwner(counts, numbers);
  constexpr std::size_t kFewGroups = 8;
  parallelForWith(
      stage, groups.size(), kFewGroups,
      [&] { return Describer(map, counts, numbers, first, mesh); },
      [&](std::size_t i, Describer& describer) { describer.describe(groups[i]); });
}

}  // namespace hexhex::parts
