// Arcs: one per hex edge, on the grid's lines, from simplex to simplex without gaps.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>

#include "curved/curved_maps.hpp"
#include "curved/same_arcs.hpp"
#include "curved/tet_points.hpp"

namespace hexhex::test {

namespace {

PiecewiseLinearMesh withArcs(const TetMap& map, int scale = 1, int threads = 0,
                             Engine engine = Engine::Atlas) {
  ExtractOptions options;
  options.scale = scale;
  options.engine = engine;
  Context context(threads);
  return extractPiecewiseLinear(map, PiecewiseLinearParts::Arcs, options, context);
}

/// The edges of the cells, each once per different pair of vertices.
std::set<std::array<Index, 2>> edgesOf(const HexMesh& mesh) {
  constexpr int kEdges[12][2] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}, {4, 5}, {5, 6},
                                 {7, 6}, {4, 7}, {0, 4}, {1, 5}, {3, 7}, {2, 6}};
  std::set<std::array<Index, 2>> edges;
  for (const Hex& cell : mesh.cells) {
    for (const auto& [a, b] : kEdges) {
      edges.insert(
          {std::min(cell[static_cast<std::size_t>(a)], cell[static_cast<std::size_t>(b)]),
           std::max(cell[static_cast<std::size_t>(a)], cell[static_cast<std::size_t>(b)])});
    }
  }
  return edges;
}

/// @param shared  how many arcs have the vertices of another one before them
void examine(const TetMap& map, int scale, std::size_t shared = 0) {
  const PiecewiseLinearMesh result = withArcs(map, scale);
  const Arcs& arcs = result.arcs;
  ExtractOptions options;
  options.scale = scale;
  EXPECT_TRUE(sameBits(result.mesh, extract(map, options)));

  std::set<std::array<Index, 2>> edges;
  for (const auto& [a, b] : arcs.ends) edges.insert({std::min(a, b), std::max(a, b)});
  EXPECT_EQ(edges, edgesOf(result.mesh));
  EXPECT_EQ(edges.size() + shared, arcs.count());

  const TetPoints tets(map, scale);
  ASSERT_EQ(arcs.pointBegin.size(), arcs.count() + 1);
  ASSERT_EQ(arcs.points.size(), arcs.pointBegin.back());
  ASSERT_EQ(arcs.segmentTet.size(), arcs.points.size() + arcs.count());
  for (std::size_t e = 0; e < arcs.count(); ++e) {
    SCOPED_TRACE("arc " + std::to_string(e));
    const std::uint64_t first = arcs.pointBegin[e];
    const std::uint64_t end = arcs.pointBegin[e + 1];
    // The simplices along the arc: end points and segments in turn.
    const auto vertex = [&](std::size_t i) {
      const Index v = arcs.ends[e][i];
      return tets.simplex(result.mesh.generatorTet[v], result.mesh.generatorCorners[v]);
    };
    std::vector<TetPoints::Simplex> way = {vertex(0)};
    for (std::uint64_t i = first; i <= end; ++i) {
      const std::uint64_t s = arcs.firstSegment(e) + (i - first);
      way.push_back(tets.simplex(arcs.segmentTet[s], arcs.segmentCorners[s]));
      way.push_back(i < end ? tets.simplex(arcs.generatorTet[i], arcs.generatorCorners[i])
                            : vertex(1));
    }
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      const bool segmentFirst = i % 2 == 1;
      const auto& point = way[segmentFirst ? i + 1 : i];
      const auto& segment = way[segmentFirst ? i : i + 1];
      // Every point is in the closure of the segments at it; between two segments it is a proper
      // part of at least one, otherwise nothing would change there.
      ASSERT_TRUE(std::includes(segment.begin(), segment.end(), point.begin(), point.end()));
      if (i > 0 && i % 2 == 0) {
        ASSERT_NE(way[i - 1], way[i + 1]);
      }
    }
    double length = 0;
    double before = 0;
    for (std::uint64_t i = first; i < end; ++i) {
      ASSERT_LE(arcs.generatorCorners[i] & 15, 14);
      ASSERT_GT(arcs.parameters[i], 0);
      ASSERT_LT(arcs.parameters[i], 1);
      ASSERT_GE(arcs.parameters[i], before);
      length += arcs.parameters[i] - before;
      before = arcs.parameters[i];
      // On a line of the grid: two coordinates are integers, in the chart of its tet.
      ASSERT_LE(tets.distanceFromLine(arcs.generatorTet[i], arcs.points[i]), 1e-7);
    }
    ASSERT_NEAR(length + 1 - before, 1, 1e-15);
    // In every tet, the map stretches a segment to its share of the unit edge.
    Vec3 from = result.mesh.points[arcs.ends[e][0]];
    before = 0;
    for (std::uint64_t i = first; i <= end; ++i) {
      const Vec3 to = i < end ? arcs.points[i] : result.mesh.points[arcs.ends[e][1]];
      const double t = i < end ? arcs.parameters[i] : 1;
      const Index tet = arcs.segmentTet[arcs.firstSegment(e) + (i - first)];
      ASSERT_NEAR(tets.parametricDistance(tet, from, to), t - before, 1e-7);
      from = to;
      before = t;
    }
  }
}

TEST(Arcs, GeneratedMaps) {
  int number = 0;
  for (const CurvedMap& map : generatedMaps()) {
    SCOPED_TRACE(map.name);
    examine(map.map, 1 + number++ % 2);
  }
}

TEST(Arcs, EdgesWithTheSameVertices) {
  // Of eight vertices in a section, each has two edges along the torus.
  examine(tightTorus(2), 1, 8);
}

TEST(Arcs, EdgesThatComeBack) {
  const PiecewiseLinearMesh result = withArcs(tightTorus(1));
  const auto loops = std::count_if(result.arcs.ends.begin(), result.arcs.ends.end(),
                                   [](const auto& ends) { return ends[0] == ends[1]; });
  EXPECT_EQ(loops, 8);
  // V - E + F - C is 0 for a solid torus; eight vertices, of twelve edges and five quads a section.
  EXPECT_EQ(result.mesh.points.size(), 8U);
  EXPECT_EQ(result.mesh.cells.size(), 5U);
  EXPECT_EQ(result.arcs.count(), 8U + 12U);
}

TEST(Arcs, RealMaps) {
  const std::vector<CurvedMap> maps = realMaps();
  if (maps.empty()) GTEST_SKIP() << "skipped: no real maps here";
  for (const CurvedMap& map : maps) {
    SCOPED_TRACE(map.name);
    examine(map.map, 1);
    if (withArcs(map.map).mesh.cells.size() < 1000) examine(map.map, 2);
  }
}

TEST(Arcs, SameForAnyNumberOfThreads) {
  SampleOptions options;
  options.cells = 6;
  options.refine = 3;
  options.jitter = 0.5;
  options.charts = ChartStyle::Random;
  const TetMap map = generateSample(SampleKind::Sphere, options).map;
  for (const Engine engine : {Engine::Atlas, Engine::Propeller}) {
    const Arcs one = withArcs(map, 1, 1, engine).arcs;
    for (const int threads : {2, 3}) {
      expectSameBits(one, withArcs(map, 1, threads, engine).arcs);
    }
  }
}

TEST(Arcs, SameOfBothEngines) {
  for (const CurvedMap& map : generatedMaps()) {
    SCOPED_TRACE(map.name);
    expectSameBits(withArcs(map.map, 1, 1).arcs, withArcs(map.map, 1, 1, Engine::Propeller).arcs);
  }
}

}  // namespace
}  // namespace hexhex::test
