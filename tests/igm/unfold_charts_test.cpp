// Unfolded charts: the same map, to the last bit, in fewer charts.
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <igm/transition_fit.hpp>
#include <igm/unfold_charts.hpp>

#include "map_samples.hpp"

namespace hexhex::igm {
namespace {

using test::Prepared;

/// A map before and after its charts are unfolded.
struct Unfolded : test::Topology {
  OrientedMap given;
  bool needed;
  Array<lattice::Gauge> gauges;

  explicit Unfolded(const TetMapView& map)
      : Topology(map),
        given(readInput(map, stage, defects)),
        needed(needsUnfolding(topology, input)),
        gauges(unfoldCharts(topology, input, stage)) {
    EXPECT_TRUE(defects.empty());
  }

  /// Faces on which tets do not agree.
  [[nodiscard]] std::size_t unequalFaces() const {
    const LocalParameters parameters(input);
    std::size_t count = 0;
    for (adjacency::HalfFace h = 0; h < topology.mate.size(); ++h) {
      const adjacency::HalfFace mate = topology.mate[h];
      if (mate != kNone && h < mate && !agree(topology, parameters, h)) ++count;
    }
    return count;
  }
};

/// Whether a rotation and an integer translation carry four corners over without rounding, as
/// trying all rotations tells.
bool areCongruent(const TetParameters& from, const TetParameters& to) {
  for (int r = 0; r < lattice::Rotation::kCount; ++r) {
    bool fits = true;
    std::array<long double, 3> shift{};
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Vec3 turned = lattice::Rotation(r)(from[corner]);
      for (std::size_t k = 0; k < 3; ++k) {
        // Exact: samples have 20 bits before and 30 behind the point.
        const long double difference = static_cast<long double>(to[corner][k]) - turned[k];
        if (corner == 0) shift[k] = difference;
        fits = fits && difference == shift[k] && difference == std::floor(difference);
      }
    }
    if (fits) return true;
  }
  return false;
}

class UnfoldChartsOfKind : public test::EveryKind {};

TEST_P(UnfoldChartsOfKind, GivesTheSameMapWithFewJumps) {
  for (const double offset : {0.0, 1e6}) {
    const TetMap map = generateSample(kind(), {.refine = 6,
                                               .charts = ChartStyle::Random,
                                               .jitter = 0.6,
                                               .onLattice = 0.3,
                                               .offset = offset})
                           .map;
    const Unfolded unfolded(map);
    EXPECT_TRUE(unfolded.needed);
    const TetMapView& view = unfolded.input.view;
    double largest = 0;
    for (std::size_t t = 0; t < map.tets.size(); ++t) {
      EXPECT_TRUE(areCongruent(unfolded.given.view.parameters[t], view.parameters[t])) << t;
      for (const Vec3& u : view.parameters[t]) {
        for (const double x : u) largest = std::max(largest, std::abs(x));
      }
    }
    EXPECT_EQ(unfolded.input.largestCoordinate, largest);
    EXPECT_FALSE(LocalParameters(unfolded.input).moved());
    EXPECT_LT(10 * unfolded.unequalFaces(), map.tets.size());
  }
}

/// What is said of the caller's charts does not depend on which are used.
TEST_P(UnfoldChartsOfKind, AreReportedAsGiven) {
  for (const double noise : {0.0, 1e-4}) {
    const TetMap map =
        generateSample(kind(),
                       {.refine = 3, .charts = ChartStyle::Random, .jitter = 0.4, .noise = noise})
            .map;
    const Prepared given(map, 1e-2, 1, 1, ChartChoice::AsGiven);
    const Prepared unfolded(map, 1e-2, 1, 3, ChartChoice::Unfolded);
    ASSERT_TRUE(given.defects().empty());
    ASSERT_TRUE(unfolded.defects().empty());
    EXPECT_EQ(given.map().chartJumps, given.transitions().nonTrivial);
    EXPECT_EQ(unfolded.map().chartJumps, given.map().chartJumps);
    EXPECT_EQ(unfolded.map().isUnfolded, noise == 0);
    if (noise == 0) {
      EXPECT_LT(10 * unfolded.transitions().nonTrivial, given.transitions().nonTrivial);
    } else {
      EXPECT_EQ(unfolded.transitions().nonTrivial, given.transitions().nonTrivial);
    }
    EXPECT_EQ(unfolded.singularities().edges.size(), given.singularities().edges.size());
  }
}

TEST_P(UnfoldChartsOfKind, DefectsAreThoseInGivenCharts) {
  for (const DefectKindName& defect : defectKinds()) {
    const TetMap map = generateSample(kind(), {.refine = 4,
                                               .charts = ChartStyle::Random,
                                               .jitter = 0.3,
                                               .defects = 3,
                                               .defectKind = defect.kind})
                           .map;
    EXPECT_TRUE(Unfolded(map).needed);
    const Prepared given(map, 1e-2, 1, 1, ChartChoice::AsGiven);
    const Prepared unfolded(map, 1e-2, 1, 1, ChartChoice::Unfolded);
    const std::vector<Defect> expected = given.defects().defects();
    const std::vector<Defect> found = unfolded.defects().defects();
    ASSERT_FALSE(expected.empty());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].code, expected[i].code);
      EXPECT_EQ(found[i].count, expected[i].count);
      ASSERT_EQ(found[i].worst.size(), expected[i].worst.size());
      for (std::size_t k = 0; k < found[i].worst.size(); ++k) {
        EXPECT_EQ(toString(found[i].worst[k].place), toString(expected[i].worst[k].place));
        EXPECT_EQ(found[i].worst[k].amount, expected[i].worst[k].amount);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, UnfoldChartsOfKind, testing::ValuesIn(sampleKinds()),
                         test::kindTestName);

TEST(UnfoldCharts, LeaveNoJumpInABox) {
  const TetMap map =
      generateSample(SampleKind::Box, {.refine = 12, .charts = ChartStyle::Random, .jitter = 0.5})
          .map;
  EXPECT_EQ(Unfolded(map).unequalFaces(), 0U);
}

TEST(UnfoldCharts, AreNotNeededWhereChartsAreFewOrRotationsGiven) {
  for (const ChartStyle charts : {ChartStyle::Aligned, ChartStyle::Blocks}) {
    EXPECT_FALSE(
        Unfolded(generateSample(SampleKind::Torus, {.refine = 9, .charts = charts}).map).needed);
  }
  const TetMap map = generateSample(SampleKind::Torus, {.charts = ChartStyle::Random}).map;
  EXPECT_TRUE(Unfolded(map).needed);
  TetMapView view(map);
  const std::vector<std::array<std::int8_t, 4>> unknown(map.tets.size(), {-1, -1, -1, -1});
  view.rotations = unknown;
  EXPECT_FALSE(Unfolded(view).needed);
}

/// Where a sum would have to be rounded, a tet keeps its chart.
TEST(UnfoldCharts, KeepTetsThatWouldBeRounded) {
  TetMap map =
      generateSample(SampleKind::Box, {.refine = 4, .charts = ChartStyle::Random, .jitter = 0.5})
          .map;
  // The last bits of small coordinates.
  std::vector<Index> fine;
  for (std::size_t t = 0; t < map.tets.size(); t += 7) {
    for (Vec3& u : map.parameters[t]) {
      for (double& x : u) {
        if (std::abs(x) < 1) x = std::nextafter(x, 2);
      }
    }
    fine.push_back(static_cast<Index>(t));
  }
  const Unfolded unfolded(map);
  EXPECT_TRUE(unfolded.needed);
  std::size_t kept = 0;
  std::size_t moved = 0;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    if (map.parameters[t] == unfolded.input.view.parameters[t]) {
      ++kept;
      continue;
    }
    ++moved;
    // Edges are as long as before, to the last bit.
    for (std::size_t corner = 1; corner < 4; ++corner) {
      std::array<double, 3> before{};
      std::array<double, 3> after{};
      for (std::size_t k = 0; k < 3; ++k) {
        before[k] = std::abs(map.parameters[t][corner][k] - map.parameters[t][0][k]);
        after[k] = std::abs(unfolded.input.view.parameters[t][corner][k] -
                            unfolded.input.view.parameters[t][0][k]);
      }
      std::sort(before.begin(), before.end());
      std::sort(after.begin(), after.end());
      EXPECT_EQ(before, after);
    }
  }
  EXPECT_GT(kept, fine.size() / 20);
  EXPECT_GT(moved, map.tets.size() / 2);
}

}  // namespace
}  // namespace hexhex::igm
