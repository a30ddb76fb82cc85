// Corners of cells: traced exactly, and as the resolver finds them.
#include <rapidcheck.h>

#include <gtest/gtest.h>

#include <atlas/cell_emitter.hpp>
#include <sweep/cell_tracer.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

using namespace atlas;

namespace {

struct Prepared {
  Sample sample;
  igm::PreparedMap map;
};

/// Draws a map; keeps the sample, to which the prepared map refers.
std::unique_ptr<Prepared> anyMap() {
  SampleOptions o;
  o.cells = *rc::gen::inRange(1, 6);
  o.refine = *rc::gen::inRange(1, 4);
  o.valence = *rc::gen::inRange(3, 12);
  o.jitter = *rc::gen::element(0.0, 0.4, 0.8);
  o.onLattice = *rc::gen::element(0.0, 0.5);
  o.charts = *rc::gen::element(ChartStyle::Blocks, ChartStyle::Random);
  const auto kind = *rc::gen::element(SampleKind::Star, SampleKind::Sphere, SampleKind::Cylinder,
                                      SampleKind::Tetrahedron);
  auto prepared = std::make_unique<Prepared>();
  prepared->sample = generateSample(kind, o);
  Context context(1);
  igm::DefectCollector defects;
  prepared->map = igm::prepareMap(prepared->sample.map, 1e-2, 1, context, defects);
  RC_ASSERT(defects.empty());
  return prepared;
}

/// Calls visit(tet, line, i) for every cell: its centre is point i of a line of the tet that owns
/// it.
template <class Visit>
void forEachCell(const igm::PreparedMap& map, const Visit& visit) {
  for (Index tet = 0; tet < map.topology.tetCount(); ++tet) {
    std::vector<lattice::SweptLine> lines;
    lattice::TetRasterizer(map.exact.corners[tet], map.exact.unit)
        .append(lattice::kCenterGrid, lines);
    sweep::CenterOwner owner(map.topology, tet);
    for (const lattice::SweptLine& line : lines) {
      const auto [first, count] = owner.owned(line);
      for (std::uint32_t i = first; i < first + count; ++i) {
        visit(tet, line, i);
      }
    }
  }
}

/// A traced corner must be a corner of the cell: at the right place if nothing but gauges were
/// asked.
TEST(Property, TracedCornersAreGridPointsOfTheirTets) {
  EXPECT_TRUE(rc::check("traced corners are grid points of their tets", [] {
    const auto prepared = anyMap();
    const igm::PreparedMap& map = prepared->map;
    sweep::CellTracer tracer(map);
    forEachCell(map, [&](Index tet, const lattice::SweptLine& line, std::uint32_t i) {
      tracer.enter(tet, line.point(i), line.simplex(i));
      for (const lattice::GridPoint& offset : lattice::kCellCorners) {
        const sweep::CornerPlace place = tracer.trace(offset);
        RC_ASSERT(lattice::simplexOf(map.exact.corners[place.tet], place.z, map.exact.unit) !=
                  lattice::kNoSimplex);
      }
    });
  }));
}

/// Whether it looks across cuts or not, and whatever the cell's chart shows.
TEST(Property, TheResolverFindsTheTracedCorners) {
  EXPECT_TRUE(rc::check("the resolver finds the traced corners", [] {
    const auto prepared = anyMap();
    const igm::PreparedMap& map = prepared->map;
    Context context(1);
    Stage stage(context, "test");
    Charts charts = buildCharts(map, stage);
    sweep::VertexNumbers numbers;
    VertexGrid<Index> vertices(map, charts, numbers, true);
    sweep::CellCenters cells(map.topology.tetCount(), false);
    vertices.sweep(cells, stage);
    vertices.fill({}, stage);
    static_cast<void>(vertices.resolveOverlaps(stage));
    const Cuts cuts = markCutCells(map, charts, false, vertices.grid(), stage);
    BrickCache<Index> cache(vertices.grid());
    CornerResolver<Index> looking(map, vertices, cuts.transitions, true);
    CornerResolver<Index> tracing(map, vertices, cuts.transitions, false);
    sweep::CellTracer tracer(map);
    forEachCell(map, [&](Index tet, const lattice::SweptLine& line, std::uint32_t i) {
      tracer.enter(tet, line.point(i), line.simplex(i));
      Hex traced{};
      Hex shown{};
      const lattice::ChartPoint place = charts.gauge(tet).cell(line.point(i));
      const lattice::Rotation rotation = charts.gauge(tet).rotation;
      for (std::size_t c = 0; c < 8; ++c) {
        const sweep::CornerPlace end = tracer.trace(lattice::kCellCorners[c]);
        traced[c] = static_cast<Index>(vertices.exactNumber(end.tet, end.z));
        shown[c] = cache.idAt(
            charts.chart[tet],
            lattice::plus(place, lattice::kCellCorners[lattice::turnedCorner(rotation, c)]));
      }
      CutCell cut;
      if (const CutCells* const known = cache.at(charts.chart[tet], place).cuts; known != nullptr) {
        cut = known->cells[placeInBrick(place)];
      }
      // A corner without a cut in front of it is shown.
      for (std::size_t c = 0; c < 8; ++c) {
        if (cut.transition(lattice::turnedCorner(rotation, c)) == kNoCut)
          RC_ASSERT(shown[c] == traced[c]);
      }
      for (CornerResolver<Index>* const resolver : {&looking, &tracing}) {
        Hex cell = shown;
        RC_ASSERT(resolver->resolve({tet, &line, i, place, cut}, cell, cache) == (shown != traced));
        RC_ASSERT(cell == traced);
      }
      // Without a chart, nothing is known of any corner.
      Hex cell{};
      cell.fill(Brick<Index>::kEmpty);
      const CutCell unknown = CutCell().with(lattice::kAllCellCorners, kAnyCuts);
      RC_ASSERT(looking.resolve({tet, &line, i, {}, unknown}, cell, cache));
      RC_ASSERT(cell == traced);
    });
  }));
}

}  // namespace
}  // namespace hexhex::test
