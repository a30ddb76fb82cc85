// Corners of cells: traced exactly, and as the resolver finds them.
#include <rapidcheck.h>

#include <gtest/gtest.h>

#include <atlas/corner_resolver.hpp>
#include <sweep/cell_tracer.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

namespace {

struct Prepared {
  Sample sample;
  PreparedMap map;
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
  DefectCollector defects;
  prepared->map = prepareMap(prepared->sample.map, 1e-2, 1, context, defects);
  RC_ASSERT(defects.empty());
  return prepared;
}

/// Calls visit(tet, line, i) for every cell: its centre is point i of a line of the tet that owns
/// it.
template <class Visit>
void forEachCell(const PreparedMap& map, const Visit& visit) {
  for (Index tet = 0; tet < map.topology.tetCount(); ++tet) {
    std::vector<SweptLine> lines;
    TetRasterizer(map.exact.corners[tet], map.exact.unit).append(kCenterGrid, lines);
    CenterOwner owner(map.topology, tet);
    for (const SweptLine& line : lines) {
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
    const PreparedMap& map = prepared->map;
    CellTracer tracer(map);
    forEachCell(map, [&](Index tet, const SweptLine& line, std::uint32_t i) {
      tracer.enter(tet, line.point(i), line.simplex(i));
      for (const GridPoint& offset : kCellCorners) {
        const CornerPlace place = tracer.trace(offset);
        RC_ASSERT(simplexOf(map.exact.corners[place.tet], place.z, map.exact.unit) != kNoSimplex);
      }
    });
  }));
}

/// Whether it looks across cuts or not, and whatever the cell's chart shows.
TEST(Property, TheResolverFindsTheTracedCorners) {
  EXPECT_TRUE(rc::check("the resolver finds the traced corners", [] {
    const auto prepared = anyMap();
    const PreparedMap& map = prepared->map;
    Context context(1);
    Stage stage(context, "test");
    Charts charts = buildCharts(map, stage);
    VertexNumbers numbers;
    VertexGrid<Index> vertices(map, charts, numbers, true);
    CellCenters cells(map.topology.tetCount(), false);
    vertices.sweep(cells, stage);
    vertices.fill({}, stage);
    static_cast<void>(vertices.resolveOverlaps(stage));
    const Cuts cuts = markCutCells(map, charts, false, vertices.grid(), stage);
    BrickCache<Index> cache(vertices.grid());
    CornerResolver<Index> looking(map, vertices, cuts.transitions, true);
    CornerResolver<Index> tracing(map, vertices, cuts.transitions, false);
    CellTracer tracer(map);
    forEachCell(map, [&](Index tet, const SweptLine& line, std::uint32_t i) {
      tracer.enter(tet, line.point(i), line.simplex(i));
      Hex traced{};
      Hex shown{};
      const ChartPoint place = charts.gauge(tet).cell(line.point(i));
      const Rotation rotation = charts.gauge(tet).rotation;
      for (std::size_t c = 0; c < 8; ++c) {
        const CornerPlace end = tracer.trace(kCellCorners[c]);
        traced[c] = static_cast<Index>(vertices.exactNumber(end.tet, end.z));
        shown[c] =
            cache.idAt(charts.chart[tet], plus(place, kCellCorners[turnedCorner(rotation, c)]));
      }
      CutCell cut;
      if (const CutCells* const known = cache.at(charts.chart[tet], place).cuts; known != nullptr) {
        cut = known->cells[placeInBrick(place)];
      }
      // A corner without a cut in front of it is shown.
      for (std::size_t c = 0; c < 8; ++c) {
        if (cut.transition(turnedCorner(rotation, c)) == kNoCut) RC_ASSERT(shown[c] == traced[c]);
      }
      for (CornerResolver<Index>* const resolver : {&looking, &tracing}) {
        Hex cell = shown;
        RC_ASSERT(resolver->resolve({tet, &line, i, place, cut}, cell, cache) == (shown != traced));
        RC_ASSERT(cell == traced);
      }
      // Without a chart, nothing is known of any corner.
      Hex cell{};
      cell.fill(Brick<Index>::kEmpty);
      const CutCell unknown = CutCell().with(kAllCellCorners, kAnyCuts);
      RC_ASSERT(looking.resolve({tet, &line, i, {}, unknown}, cell, cache));
      RC_ASSERT(cell == traced);
    });
  }));
}

}  // namespace
}  // namespace hexhex::test
