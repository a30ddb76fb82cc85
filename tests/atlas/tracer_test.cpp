// Walks to all corners of a cell at once, against ways that are traced exactly one by one.
#include <rapidcheck.h>

#include <gtest/gtest.h>

#include <atlas/cell_emitter.hpp>
#include <atlas/cell_walker.hpp>
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

/// Calls visit(tet, z, generator) for every cell, at the tet that owns its centre.
template <class Visit>
void forEachCell(const PreparedMap& map, const Visit& visit) {
  for (Index tet = 0; tet < map.topology.tetCount(); ++tet) {
    const TetSweep sweep(map.exact, tet, SweptGrid::Centers);
    std::vector<SweptLine> lines;
    sweep.run(map.exact.unit, lines);
    CenterOwner owner(map.topology, tet);
    for (const SweptLine& line : lines) {
      const auto [first, count] = owner.owned(line);
      for (std::uint32_t i = first; i < first + count; ++i) {
        visit(tet, line.point(i), line.simplex(i));
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
    forEachCell(map, [&](Index tet, const GridPoint& z, CornerMask generator) {
      tracer.enter(tet, z, generator);
      for (const GridPoint& offset : kCellCorners) {
        const CornerPlace place = tracer.trace(offset);
        const TetPlanes planes(map.exact.corners[place.tet], map.exact.unit);
        RC_ASSERT(planes.generator(place.z) != kNoSimplex);
      }
    });
  }));
}

/// The walker arrives at the vertices that exact tracing finds, and what it says to be in sight is
/// in the picture.
TEST(Property, WalksEndAtTheTracedCorners) {
  EXPECT_TRUE(rc::check("walks end at the traced corners", [] {
    const auto prepared = anyMap();
    const PreparedMap& map = prepared->map;
    Context context(1);
    Stage stage(context, "test");
    Charts charts = buildCharts(map, stage);
    VertexGrid<Index> vertices(map, charts, true);
    CellSeeds cells(map.topology.tetCount(), false);
    vertices.sweep(cells, stage);
    vertices.fill({}, stage);
    static_cast<void>(vertices.resolveOverlaps(stage));
    BrickCache<Index> cache(vertices.grid());
    CellWalker walker(map, charts);
    CellTracer tracer(map);
    std::size_t arrived = 0;
    forEachCell(map, [&](Index tet, const GridPoint& z, CornerMask generator) {
      tracer.enter(tet, z, generator);
      CellCornerSet seen = 0;
      const auto arrive = [&](const CellWalker::Stop& stop, CellCornerSet corners) {
        RC_ASSERT((seen & corners) == 0U);
        seen |= corners;
        for (std::size_t c = 0; c < 8; ++c) {
          if (((corners >> c) & 1U) == 0) continue;
          ++arrived;
          GridPoint corner = z;
          for (std::size_t k = 0; k < 3; ++k) corner[k] += kCellCorners[c][k];
          const CornerPlace place = tracer.trace(kCellCorners[c]);
          const std::uint64_t vertex = vertices.exactNumber(place.tet, place.z);
          RC_ASSERT(vertices.exactNumber(stop.tet, stop.toTet(corner)) == vertex);
          if (!stop.inSight) continue;
          const ChartPoint at = charts.gauge(tet)(corner);
          const Brick<Index>* const brick = cache.find(charts.chart[tet], at);
          RC_ASSERT(brick != nullptr);
          RC_ASSERT(std::uint64_t{brick->ids[placeInBrick(at)]} == vertex);
        }
      };
      const CellCornerSet missed = walker.run(tet, z, kAllCellCorners, arrive);
      RC_ASSERT((seen ^ missed) == 0xffU);
    });
    RC_ASSERT(arrived > 0U);
  }));
}

}  // namespace
}  // namespace hexhex::test
