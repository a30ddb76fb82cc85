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

/// Gauge::cell() prepared for many cells: it differs from the gauge by a constant.
SweepFrame cellFrame(const Gauge& gauge) noexcept {
  return {{gauge.rotation, gauge.cell({0, 0, 0})}, {0, 1, 2}};
}

/// Marks the cells that a cut may meet, in the charts on both its sides: what the triangle meets on
/// one side are the images of what it meets on the other.
template <class Id>
void markCut(const PreparedMap& map, const Charts& charts, HalfFace halfFace,
             BrickCache<Id>& cache) {
  const Index here = tetOf(halfFace);
  const Index there = tetOf(map.topology.mate[halfFace]);
  const SweepFrame frameHere = cellFrame(charts.gauge(here));
  const SweepFrame frameThere =
      cellFrame(charts.gauge(there) * map.exact.transitions.across(halfFace));
  const auto mark = [&](Index chart, const ChartPoint& c) {
    if (chart == Charts::kNoChart) return;
    Brick<Id>* const brick = cache.find(chart, c);
    if (brick != nullptr) brick->mark(placeInBrick(c));
  };
  TriangleCells(triangleOf(map.exact, halfFace), map.exact.unit).run([&](const GridPoint& z) {
    mark(charts.chart[here], frameHere(z[0], z[1], z[2]));
    mark(charts.chart[there], frameThere(z[0], z[1], z[2]));
  });
}

}  // namespace

template <class Id>
std::uint64_t markCutCells(const PreparedMap& map, const Charts& charts, bool asBuilt,
                           BrickGrid<Id>& grid, Stage& stage) {
  const TetTopology& topology = map.topology;
  std::atomic<std::uint64_t> cuts{0};
  parallelBlocks(stage, topology.tetCount(), kGrain,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                   BrickCache<Id> cache(grid);
                   std::uint64_t cutsHere = 0;
                   for (std::size_t h = 4 * begin; h < 4 * end; ++h) {
                     const auto halfFace = static_cast<HalfFace>(h);
                     if (asBuilt && !map.exact.transitions.isJump(halfFace)) continue;
                     const HalfFace mate = topology.mate[halfFace];
                     if (mate == kNone || mate < halfFace) continue;
                     if (charts.isGlued(topology, map.exact.transitions, halfFace)) continue;
                     ++cutsHere;
                     markCut(map, charts, halfFace, cache);
                   }
                   cuts.fetch_add(cutsHere, std::memory_order_relaxed);
                 });
  return cuts.load();
}

template std::uint64_t markCutCells(const PreparedMap&, const Charts&, bool,
                                    BrickGrid<std::uint32_t>&, Stage&);
template std::uint64_t markCutCells(const PreparedMap&, const Charts&, bool,
                                    BrickGrid<std::uint64_t>&, Stage&);

}  // namespace hexhex
