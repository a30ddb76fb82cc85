// Gauges: one chart along a spanning tree, whatever the numbering of tets.
#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <base/disjoint_sets.hpp>
#include <igm/transition_fit.hpp>
#include <igm/unfold_charts.hpp>

#include "map_samples.hpp"

namespace hexhex::igm {
namespace {

using test::Prepared;

Array<lattice::Gauge> gaugesOf(const Prepared& prepared, std::size_t blockSize, int threads = 1) {
  Context context(threads);
  Stage stage(context, "test");
  Array<lattice::Gauge> gauges;
  withThreads(threads, [&] {
    const LocalParameters parameters(prepared.map().input);
    gauges = computeGauges(prepared.topology(), parameters, stage, blockSize);
  });
  return gauges;
}

/// Tets in another order: with few neighbours in one block, or none.
TetMap shuffled(const TetMap& map, std::size_t seed) {
  std::vector<std::size_t> order(map.tets.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937_64(seed));
  TetMap other{map.points, {}, {}};
  for (const std::size_t t : order) {
    other.tets.push_back(map.tets[t]);
    other.parameters.push_back(map.parameters[t]);
  }
  return other;
}

/// Two copies that do not touch.
TetMap twice(TetMap map) {
  const auto points = static_cast<Index>(map.points.size());
  const std::size_t tets = map.tets.size();
  map.points.insert(map.points.end(), map.points.begin(), map.points.begin() + points);
  for (std::size_t t = 0; t < tets; ++t) {
    Tet tet = map.tets[t];
    for (Index& v : tet) v += points;
    map.tets.push_back(tet);
    map.parameters.emplace_back(TetParameters(map.parameters[t]));
  }
  return map;
}

bool agree(const Prepared& prepared, const Array<lattice::Gauge>& gauges,
           adjacency::HalfFace halfFace) {
  const Index there = adjacency::tetOf(prepared.topology().mate[halfFace]);
  return gauges[there] * prepared.transitions().across(halfFace) ==
         gauges[adjacency::tetOf(halfFace)];
}

/// How many parts the faces on which gauges agree connect tets to.
std::size_t connectedParts(const Prepared& prepared, const Array<lattice::Gauge>& gauges) {
  const Array<adjacency::HalfFace>& mate = prepared.topology().mate;
  DisjointSets agreeing(gauges.size());
  for (adjacency::HalfFace h = 0; h < mate.size(); ++h) {
    if (mate[h] != kNone && agree(prepared, gauges, h))
      agreeing.unite(adjacency::tetOf(h), adjacency::tetOf(mate[h]));
  }
  return agreeing.count();
}

class GaugesOfKind : public test::EveryKind {};

/// @param copies  of a connected mesh
void expectGoodGauges(const TetMap& map, std::size_t copies) {
  const Prepared prepared(map);
  ASSERT_TRUE(prepared.defects().empty());
  for (const std::size_t blockSize : {std::size_t{500}, kGaugeBlock}) {
    const Array<lattice::Gauge> gauges = gaugesOf(prepared, blockSize);
    EXPECT_EQ(connectedParts(prepared, gauges), copies);
    EXPECT_EQ(gauges, gaugesOf(prepared, blockSize, 3));
  }
}

TEST_P(GaugesOfKind, AgreeAlongASpanningTree) {
  for (const ChartStyle charts : test::kChartStyles) {
    const TetMap map = generateSample(kind(), {.refine = 5, .charts = charts, .jitter = 0.5}).map;
    expectGoodGauges(map, 1);
    expectGoodGauges(shuffled(map, 3), 1);
    expectGoodGauges(twice(map), 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, GaugesOfKind, testing::ValuesIn(sampleKinds()), test::kindTestName);

/// Without singularities or handles, there is nothing on which paths through the mesh could
/// disagree.
TEST(Gauges, AgreeEverywhereInABox) {
  const TetMap map =
      generateSample(SampleKind::Box, {.refine = 8, .charts = ChartStyle::Random, .jitter = 0.5})
          .map;
  for (const TetMap& other : {map, shuffled(map, 4)}) {
    const Prepared prepared(other);
    ASSERT_GT(prepared.transitions().nonTrivial, prepared.topology().tetCount());
    const Array<lattice::Gauge> gauges = gaugesOf(prepared, 1000);
    const Array<adjacency::HalfFace>& mate = prepared.topology().mate;
    std::size_t disagreements = 0;
    for (adjacency::HalfFace h = 0; h < mate.size(); ++h) {
      disagreements += mate[h] != kNone && !agree(prepared, gauges, h) ? 1 : 0;
    }
    EXPECT_EQ(disagreements, 0U);
  }
}

/// Two tets in two blocks: one triangle connects these, and both tets are in one chart thereafter.
TEST(Gauges, JoinBlocksThatHaveOneTriangleInCommon) {
  TetMap map = test::identityMap({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}},
                                 {{0, 1, 2, 3}, {4, 1, 3, 2}});
  for (Vec3& u : map.parameters[1]) u = {u[1] + 3, u[2] - 4, u[0] + 5};
  const test::Topology read(map);
  ASSERT_TRUE(read.defects.empty());
  Context context(1);
  Stage stage(context, "test");
  const LocalParameters parameters(read.input);
  const Array<lattice::Gauge> gauges = computeGauges(read.topology, parameters, stage, 1);
  adjacency::HalfFace shared = 0;
  while (read.topology.mate[shared] == kNone) ++shared;
  const lattice::Transition across =
      fitTransition(SharedTriangle(read.topology, parameters, shared)).transition;
  EXPECT_FALSE(across.isIdentity());
  EXPECT_EQ(gauges[adjacency::tetOf(read.topology.mate[shared])] * across,
            gauges[adjacency::tetOf(shared)]);
}

}  // namespace
}  // namespace hexhex::igm
