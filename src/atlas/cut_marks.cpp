#include <atomic>

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

template <class Id>
void markFace(const PreparedMap& map, const Charts& charts, HalfFace halfFace,
              BrickCache<Id>& cache) {
  const Index tet = tetOf(halfFace);
  if (charts.chart[tet] == Charts::kNoChart) return;
  const Gauge& gauge = charts.gauge(tet);
  TriangleCells(triangleOf(map.exact, halfFace), map.exact.unit).run([&](const GridPoint& z) {
    const ChartPoint c = gauge.cell(z);
    Brick<Id>* const brick = cache.find(charts.chart[tet], c);
    if (brick != nullptr) brick->mark(placeInBrick(c));
  });
}

}  // namespace

template <class Id>
std::uint64_t markCutCells(const PreparedMap& map, const Charts& charts, BrickGrid<Id>& grid,
                           Stage& stage) {
  const TetTopology& topology = map.topology;
  std::atomic<std::uint64_t> cuts{0};
  parallelBlocks(stage, topology.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                   BrickCache<Id> cache(grid);
                   std::uint64_t cutsHere = 0;
                   for (std::size_t h = 4 * begin; h < 4 * end; ++h) {
                     const auto halfFace = static_cast<HalfFace>(h);
                     const HalfFace mate = topology.mate[halfFace];
                     if (mate == kNone || mate < halfFace) continue;
                     if (charts.isGlued(topology, map.exact.transitions, halfFace)) continue;
                     ++cutsHere;
                     markFace(map, charts, halfFace, cache);
                     markFace(map, charts, mate, cache);
                   }
                   cuts.fetch_add(cutsHere, std::memory_order_relaxed);
                 });
  return cuts.load();
}

template std::uint64_t markCutCells(const PreparedMap&, const Charts&, BrickGrid<std::uint32_t>&,
                                    Stage&);
template std::uint64_t markCutCells(const PreparedMap&, const Charts&, BrickGrid<std::uint64_t>&,
                                    Stage&);

}  // namespace hexhex
