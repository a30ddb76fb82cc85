// Gauges: one picture along a spanning tree, whatever the numbering of tets.
#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <base/disjoint_sets.hpp>
#include <igm/gauges.hpp>

#include "map_samples.hpp"

namespace hexhex {
namespace {

using test::Prepared;

Gauges gaugesOf(const Prepared& prepared, std::size_t blockSize, int threads = 1) {
  Context context(threads);
  Stage stage(context, "test");
  Gauges gauges;
  withThreads(threads, [&] {
    gauges = computeGauges(prepared.topology(), prepared.transitions(), stage, blockSize);
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

bool agree(const Prepared& prepared, const Gauges& gauges, HalfFace halfFace) {
  const Index there = tetOf(prepared.topology().mate[halfFace]);
  return gauges.of[there] * prepared.transitions().across(halfFace) == gauges.of[tetOf(halfFace)];
}

/// Whether the faces on which gauges agree connect all tets of each component, and components have
/// no face in common.
void expectSpanning(const Prepared& prepared, const Gauges& gauges) {
  const Array<HalfFace>& mate = prepared.topology().mate;
  DisjointSets agreeing(gauges.of.size());
  for (HalfFace h = 0; h < mate.size(); ++h) {
    if (mate[h] == kNone) continue;
    EXPECT_EQ(gauges.component[tetOf(h)], gauges.component[tetOf(mate[h])]);
    if (agree(prepared, gauges, h)) agreeing.unite(tetOf(h), tetOf(mate[h]));
  }
  EXPECT_EQ(agreeing.count(), gauges.components);
  EXPECT_EQ(*std::ranges::max_element(gauges.component) + 1, gauges.components);
}

class GaugesOfKind : public test::EveryKind {};

/// @param copies  of a connected mesh
void expectGoodGauges(const TetMap& map, Index copies) {
  const Prepared prepared(map);
  ASSERT_TRUE(prepared.defects().empty());
  for (const std::size_t blockSize : {std::size_t{500}, kGaugeBlock}) {
    const Gauges gauges = gaugesOf(prepared, blockSize);
    EXPECT_EQ(gauges.components, copies);
    expectSpanning(prepared, gauges);
    const Gauges inParallel = gaugesOf(prepared, blockSize, 3);
    EXPECT_EQ(gauges.of, inParallel.of);
    EXPECT_EQ(gauges.component, inParallel.component);
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

/// Without singularities or handles, there is nothing that ways through the mesh could disagree on.
TEST(Gauges, AgreeEverywhereInABox) {
  const TetMap map =
      generateSample(SampleKind::Box, {.refine = 8, .charts = ChartStyle::Random, .jitter = 0.5})
          .map;
  for (const TetMap& other : {map, shuffled(map, 4)}) {
    const Prepared prepared(other);
    ASSERT_TRUE(areMostlyNonTrivial(prepared.topology(), prepared.transitions()));
    const Gauges gauges = gaugesOf(prepared, 1000);
    const Array<HalfFace>& mate = prepared.topology().mate;
    std::size_t disagreements = 0;
    for (HalfFace h = 0; h < mate.size(); ++h) {
      disagreements += mate[h] != kNone && !agree(prepared, gauges, h) ? 1 : 0;
    }
    EXPECT_EQ(disagreements, 0U);
  }
}

}  // namespace
}  // namespace hexhex
