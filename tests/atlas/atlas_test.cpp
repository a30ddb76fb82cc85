// The atlas engine: overlaps, pieces, wide ids. (That both engines agree is tested with every
// extraction in tests/extract.)
#include <algorithm>
#include <cmath>
#include <rapidcheck.h>

#include <gtest/gtest.h>

#include <hexhex/stream.hpp>

#include <atlas/atlas.hpp>
#include <atlas/overlaps.hpp>
#include <atlas/vertex_grid.hpp>
#include <igm/measures.hpp>

#include "extract/support.hpp"
#include "support/collecting_sink.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

using namespace atlas;

namespace {

Sample sampleOf(SampleKind kind, int cells, int refine, int valence = 5, double jitter = 0.3) {
  SampleOptions o;
  o.cells = cells;
  o.refine = refine;
  o.valence = valence;
  o.jitter = jitter;
  o.charts = ChartStyle::Blocks;
  return generateSample(kind, o);
}

igm::PreparedMap prepared(const TetMap& map) {
  Context context;
  igm::DefectCollector defects;
  igm::PreparedMap result = igm::prepareMap(map, 1e-2, 1, context, defects);
  EXPECT_TRUE(defects.empty());
  return result;
}

HexMesh propellerMesh(const TetMap& map) {
  ExtractOptions options;
  options.engine = Engine::Propeller;
  return extract(map, options);
}

TEST(Stream, GivesTheSameMeshInPieces) {
  for (const SampleKindName& entry : sampleKinds()) {
    const Sample sample = sampleOf(entry.kind, 5, 3);
    CollectingSink sink;
    Context context(2);
    ExtractOptions options;
    options.scale = 2;
    ExtractStatistics statistics;
    extractTo(sink, sample.map, options, context, &statistics);
    EXPECT_TRUE(sink.ended);
    EXPECT_EQ(sink.wide, 0);
    EXPECT_TRUE(sameBits(sink.mesh, extract(sample.map, options))) << entry.name;
  }
}

TEST(Stream, ManyPieces) {
  const Sample sample = sampleOf(SampleKind::Sphere, 70, 3);  // 2.4 million cells
  CollectingSink sink;
  Context context(2);
  extractTo(sink, sample.map, {}, context);
  EXPECT_TRUE(sameBits(sink.mesh, extract(sample.map)));
}

TEST(Stream, WideIdsGiveTheSameMesh) {
  for (const SampleKindName& entry : sampleKinds()) {
    const Sample sample = sampleOf(entry.kind, 6, 2, 7);
    const igm::PreparedMap map = prepared(sample.map);
    CollectingSink sink;
    Context context(2);
    ExtractStatistics statistics;
    streamAtlas(map, igm::parametricVolume(map.exact), sink, context, statistics,
                {.wideIds = true});
    EXPECT_GT(sink.wide, 0);
    EXPECT_TRUE(sameBits(sink.mesh, extract(sample.map))) << entry.name;
  }
}

TEST(Stream, WhatASinkThrowsReachesTheCaller) {
  class Failing final : public MeshSink {
    void begin(std::uint64_t, std::uint64_t) override {}
    void points(const PointPiece&) override {
      throw Error(ErrorCode::FileWrite, "The sink's disk is full.");
    }
    void cells(std::uint64_t, std::span<const Hex>) override {}
    void cells(std::uint64_t, std::span<const Hex64>) override {}
    void end() override {}
  };
  Failing sink;
  Context context;
  const Sample sample = sampleOf(SampleKind::Box, 3, 2);
  EXPECT_EQ(codeOf([&] { extractTo(sink, sample.map, {}, context); }), ErrorCode::FileWrite);
}

/// Removes the sub-blocks (12 tets each) at the axis of a star, so that its sheets go around a
/// hole, or around a cavity if those at both ends of the axis stay.
TetMap hollowStar(int valence, bool cavity) {
  SampleOptions o;
  o.cells = 10;
  o.refine = 5;  // sub-blocks end in grid planes
  o.valence = valence;
  const TetMap star = generateSample(SampleKind::Star, o).map;
  const auto onAxis = [&](Index v) {
    return std::hypot(star.points[v][0], star.points[v][1]) < 1e-9;
  };
  double lowest = 0;
  double highest = 0;
  for (const Vec3& p : star.points) {
    lowest = std::min(lowest, p[2]);
    highest = std::max(highest, p[2]);
  }
  TetMap hollow;
  std::vector<Index> number(star.points.size(), kNone);
  for (std::size_t first = 0; first < star.tets.size(); first += 12) {
    bool atAxis = false;
    bool atEnd = false;
    for (std::size_t t = first; t < first + 12; ++t) {
      for (const Index v : star.tets[t]) {
        atAxis = atAxis || onAxis(v);
        atEnd = atEnd || star.points[v][2] < lowest + 1e-9 || star.points[v][2] > highest - 1e-9;
      }
    }
    if (atAxis && !(cavity && atEnd)) continue;
    for (std::size_t t = first; t < first + 12; ++t) {
      Tet tet = star.tets[t];
      for (Index& v : tet) {
        if (number[v] == kNone) {
          number[v] = static_cast<Index>(hollow.points.size());
          hollow.points.push_back(star.points[v]);
        }
        v = number[v];
      }
      hollow.tets.push_back(tet);
      hollow.parameters.push_back(star.parameters[t]);
    }
  }
  EXPECT_LT(hollow.tets.size(), star.tets.size());
  return hollow;
}

/// A map whose chart overlaps itself, and how it does.
struct Overlapping {
  const char* name;
  int valence;
  enum Shape { Solid, Hole, Cavity } shape;

  [[nodiscard]] TetMap map() const {
    return shape == Solid ? sampleOf(SampleKind::Star, 6, 3, valence).map
                          : hollowStar(valence, shape == Cavity);
  }
};

class Overlaps : public ::testing::TestWithParam<Overlapping> {};

TEST_P(Overlaps, AreResolved) {
  const TetMap map = GetParam().map();
  Context context;
  ExtractStatistics statistics;
  const HexMesh mesh = extract(map, {}, context, &statistics);
  EXPECT_GT(statistics.overlappingTets, 0U) << "not the map that this test is about";
  EXPECT_GT(statistics.charts, 1U);
  EXPECT_TRUE(sameBits(mesh, propellerMesh(map)));
  EXPECT_TRUE(verify(map, mesh, {}).passed());
}

/// The same stages without a search for overlaps: charts show wrong vertices then. If they did not,
/// the search would have no test.
TEST_P(Overlaps, WouldSpoilTheMeshIfNobodyLooked) {
  const TetMap tets = GetParam().map();
  const igm::PreparedMap map = prepared(tets);
  Context context(1);
  ExtractStatistics statistics;
  const HexMesh mesh = runAtlas(map, igm::parametricVolume(map.exact), context, statistics,
                                {.resolveOverlaps = false});
  EXPECT_FALSE(sameBits(mesh, propellerMesh(tets)));
}

INSTANTIATE_TEST_SUITE_P(Maps, Overlaps,
                         ::testing::Values(Overlapping{"ValenceFive", 5, Overlapping::Solid},
                                           Overlapping{"ValenceNine", 9, Overlapping::Solid},
                                           Overlapping{"ValenceTwelve", 12, Overlapping::Solid},
                                           Overlapping{"HandleFive", 5, Overlapping::Hole},
                                           Overlapping{"HandleEight", 8, Overlapping::Hole},
                                           Overlapping{"CavityFive", 5, Overlapping::Cavity},
                                           Overlapping{"CavityEleven", 11, Overlapping::Cavity}),
                         [](const ::testing::TestParamInfo<Overlapping>& map) {
                           return map.param.name;
                         });

/// Beyond a cut the chart shows nothing, or another sheet: that is when marks matter.
TEST(Cuts, WouldSpoilTheMeshIfTheyWereNotMarked) {
  const TetMap tets = sampleOf(SampleKind::Star, 7, 2, 9, 0.8).map;
  const igm::PreparedMap map = prepared(tets);
  Context context(1);
  ExtractStatistics statistics;
  const HexMesh right = extract(tets, {}, context, &statistics);
  EXPECT_GT(statistics.tracedCells, 0U);
  Context threads(3);
  ExtractStatistics inParallel;
  EXPECT_EQ(extract(tets, {}, threads, &inParallel).cells, right.cells);
  EXPECT_EQ(inParallel.tracedCells, statistics.tracedCells);
  const HexMesh wrong =
      runAtlas(map, igm::parametricVolume(map.exact), context, statistics, {.markCuts = false});
  EXPECT_FALSE(sameBits(right, wrong));
}

/// A tet that claims one place for two vertices fits no chart, not even an empty one.
TEST(Overlaps, OfATetWithItself) {
  const Sample sample = sampleOf(SampleKind::Star, 2, 1);
  const igm::PreparedMap map = prepared(sample.map);
  Context context(1);
  Stage stage(context, "test");
  Charts charts = buildCharts(map, stage);
  const Charts before = charts;
  constexpr Index kTet = 3;
  const ChartRow row{charts.chart[kTet], {1, 2, 3}, lattice::direction(0, 1), 1};
  BrickGrid<Index> grid;
  const std::vector<std::vector<BrickKey>> keys = {{brickKey(row.chart, row.start)}};
  grid.build(keys, stage);
  grid.find(keys[0][0])->ids[placeInBrick(row.start)] = 9;
  const std::vector<TetClaims> claims = {{kTet, {{row, 5}, {row, 9}}}};
  EXPECT_EQ(resolveOverlaps(map, claims, charts, grid, stage), 1U);
  for (Index tet = 0; tet < map.topology.tetCount(); ++tet) {
    EXPECT_EQ(charts.chart[tet], tet == kTet ? Charts::kNoChart : before.chart[tet]);
  }
  EXPECT_EQ(BrickCache<Index>(grid).idAt(row.chart, row.start), Brick<Index>::kContested);
}

/// Every tet that has a chart finds all its lattice points there as its own vertices, whatever the
/// overlaps: this is what reading cells off a chart relies on.
TEST(Property, PointsOfTetsBelongToTheirOwnVertices) {
  EXPECT_TRUE(rc::check("points of tets belong to their own vertices", [] {
    const int valence = *rc::gen::inRange(3, 13);
    const double jitter = *rc::gen::element(0.0, 0.3, 0.8);
    const auto kind = *rc::gen::element(SampleKind::Star, SampleKind::Torus, SampleKind::Sphere,
                                        SampleKind::HandleBody);
    const Sample sample =
        sampleOf(kind, *rc::gen::inRange(1, 6), *rc::gen::inRange(1, 4), valence, jitter);
    const igm::PreparedMap map = prepared(sample.map);
    Context context(1);
    Stage stage(context, "test");
    Charts charts = buildCharts(map, stage);
    sweep::VertexNumbers numbers;
    VertexGrid<Index> grid(map, charts, numbers, true);
    sweep::CellCenters cells(map.topology.tetCount(), false);
    grid.sweep(cells, stage);
    grid.fill({}, stage);
    static_cast<void>(grid.resolveOverlaps(stage));
    BrickCache<Index> cache(grid.grid());
    for (Index tet = 0; tet < map.topology.tetCount(); ++tet) {
      if (charts.chart[tet] == Charts::kNoChart) continue;
      std::vector<lattice::SweptLine> lines;
      lattice::TetRasterizer(map.exact.corners[tet], map.exact.unit)
          .append(lattice::kVertexGrid, lines);
      for (const lattice::SweptLine& line : lines) {
        for (std::uint32_t i = 0; i < line.count; ++i) {
          const lattice::GridPoint z = line.point(i);
          const lattice::ChartPoint c = charts.gauge(tet)(z);
          const Brick<Index>* const brick = cache.find(charts.chart[tet], c);
          RC_ASSERT(brick != nullptr);
          RC_ASSERT(std::uint64_t{brick->ids[placeInBrick(c)]} == grid.exactNumber(tet, z));
        }
      }
    }
  }));
}

}  // namespace
}  // namespace hexhex::test
