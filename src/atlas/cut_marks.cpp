#include <algorithm>
#include <limits>

#include <atlas/cut_marks.hpp>

#include <lattice/triangle_cells.hpp>

namespace hexhex {

namespace {

constexpr std::size_t kGrain = 1024;

using Triangle = std::array<LatticePoint, 3>;

Triangle triangleOf(const ExactMap& map, HalfFace halfFace) {
  const LatticeTet& corners = map.corners[tetOf(halfFace)];
  const std::array<int, 3>& face = kFaceCorners[halfFace % 4];
  return {corners[static_cast<std::size_t>(face[0])], corners[static_cast<std::size_t>(face[1])],
          corners[static_cast<std::size_t>(face[2])]};
}

/// A crossing on its way into the list.
template <class Id>
struct Found {
  Brick<Id>* brick;
  Crossing crossing;
};

template <class Id>
void markFace(const PreparedMap& map, const Charts& charts, HalfFace halfFace,
              BrickCache<Id>& cache, std::vector<Found<Id>>& found) {
  const Index tet = tetOf(halfFace);
  if (charts.chart[tet] == Charts::kNoChart) return;
  const Gauge& gauge = charts.gauge(tet);
  TriangleCells(triangleOf(map.exact, halfFace), map.exact.unit).run([&](const GridPoint& z) {
    const ChartPoint c = gauge.cell(z);
    Brick<Id>* const brick = cache.find(charts.chart[tet], c);
    if (brick == nullptr) return;
    const std::size_t place = placeInBrick(c);
    brick->mark(place);
    found.push_back({brick, {halfFace, static_cast<std::uint16_t>(place)}});
  });
}

/// Sorts crossings by brick and place.
template <class Id>
Array<Crossing> collect(std::vector<std::vector<Found<Id>>>& blocks, BrickGrid<Id>& grid,
                        Stage& stage) {
  std::size_t total = 0;
  for (const auto& block : blocks) total += block.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::TooLarge,
                "More than 4,294,967,295 cells meet the cuts of the map. Lower the scale.");
  }
  std::vector<Brick<Id>*> marked;
  std::uint32_t begin = 0;
  grid.forEachBrick([&](Brick<Id>& brick) {
    if (brick.crossingEnd == 0) return;
    const std::uint32_t count = brick.crossingEnd;
    brick.crossingBegin = begin;
    brick.crossingEnd = begin;  // the place of the next one, until all are there
    begin += count;
    marked.push_back(&brick);
  });
  Array<Crossing> list(total);
  parallelFor(stage, blocks.size(), 1, [&](std::size_t b) {
    for (const Found<Id>& found : blocks[b]) {
      const std::uint32_t place =
          std::atomic_ref(found.brick->crossingEnd).fetch_add(1, std::memory_order_relaxed);
      list[place] = found.crossing;
    }
    blocks[b] = {};
  });
  parallelFor(stage, marked.size(), 16, [&](std::size_t i) {
    std::sort(list.begin() + marked[i]->crossingBegin, list.begin() + marked[i]->crossingEnd,
              [](const Crossing& a, const Crossing& b) {
                return a.place != b.place ? a.place < b.place : a.halfFace < b.halfFace;
              });
  });
  return list;
}

}  // namespace

template <class Id>
Crossings markCutCells(const PreparedMap& map, const Charts& charts, BrickGrid<Id>& grid,
                       Stage& stage) {
  const TetTopology& topology = map.topology;
  std::vector<std::vector<Found<Id>>> blocks(blockCount(topology.tetCount(), kGrain));
  std::atomic<std::uint64_t> cuts{0};
  parallelBlocks(stage, topology.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   BrickCache<Id> cache(grid);
                   std::uint64_t cutsHere = 0;
                   for (std::size_t h = 4 * begin; h < 4 * end; ++h) {
                     const auto halfFace = static_cast<HalfFace>(h);
                     const HalfFace mate = topology.mate[halfFace];
                     if (mate == kNone || mate < halfFace) continue;
                     if (charts.isGlued(topology, map.exact.transitions, halfFace)) continue;
                     ++cutsHere;
                     markFace(map, charts, halfFace, cache, blocks[block]);
                     markFace(map, charts, mate, cache, blocks[block]);
                   }
                   cuts.fetch_add(cutsHere, std::memory_order_relaxed);
                 });
  Crossings crossings;
  crossings.cutFaces = cuts.load();
  crossings.list = collect(blocks, grid, stage);
  return crossings;
}

template Crossings markCutCells(const PreparedMap&, const Charts&, BrickGrid<std::uint32_t>&,
                                Stage&);
template Crossings markCutCells(const PreparedMap&, const Charts&, BrickGrid<std::uint64_t>&,
                                Stage&);

}  // namespace hexhex
