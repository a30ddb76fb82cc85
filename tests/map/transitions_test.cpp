// Transitions between charts: they carry parameters over, and are inverse to each other.
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/check.hpp>

#include <map/transitions.hpp>

#include "map_samples.hpp"

namespace hexhex {
namespace {

using test::Prepared;

class TransitionsOfKind : public test::EveryKind {};

/// Offsets of up to 1e9 leave 22 fractional bits to a double; parameters of samples need 16.
constexpr double kResolution = 1e-6;

std::vector<SampleOptions> chartOptions() {
  std::vector<SampleOptions> all;
  for (const ChartStyle charts : test::kChartStyles) {
    for (const double offset : {0.0, 1e3, 1e9}) {
      SampleOptions options;
      options.charts = charts;
      options.offset = offset;
      options.jitter = 0.3;
      all.push_back(options);
    }
  }
  return all;
}

/// Largest distance between a shared corner in the neighbour's chart and its image there.
double worstImage(const TetTopology& topology, const LocalParameters& parameters,
                  const Transitions& transitions) {
  double worst = 0;
  for (HalfFace here = 0; here < topology.mate.size(); ++here) {
    const HalfFace there = topology.mate[here];
    if (there == kNone) continue;
    for (const int corner : kFaceCorners[here % 4]) {
      const Index vertex = topology.vertex(4 * tetOf(here) + static_cast<Index>(corner));
      const Vec3 image = transitions.across(here)(parameters(tetOf(here), corner), 1.0);
      const Vec3 actual = parameters(tetOf(there), topology.localCorner(tetOf(there), vertex));
      for (std::size_t k = 0; k < 3; ++k) {
        worst = std::max(worst, std::abs(image[k] - actual[k]));
      }
    }
  }
  return worst;
}

TEST_P(TransitionsOfKind, CarryParametersOver) {
  for (const SampleOptions& options : chartOptions()) {
    const TetMap map = generateSample(kind(), options).map;
    const Prepared prepared(map);
    const LocalParameters parameters(prepared.map().input);
    EXPECT_TRUE(prepared.defects().empty());
    EXPECT_LE(worstImage(prepared.topology(), parameters, prepared.transitions()), kResolution);
    EXPECT_LE(prepared.transitions().maxResidual, kResolution);
  }
}

TEST_P(TransitionsOfKind, OfMatesAreInverse) {
  for (const SampleOptions& options : chartOptions()) {
    const TetMap map = generateSample(kind(), options).map;
    const Prepared prepared(map);
    const TetTopology& topology = prepared.topology();
    const Transitions& transitions = prepared.transitions();
    std::uint64_t jumps = 0;
    std::uint64_t innerFaces = 0;
    for (HalfFace here = 0; here < topology.mate.size(); ++here) {
      const HalfFace there = topology.mate[here];
      EXPECT_EQ(transitions.isJump(here), !transitions.across(here).isIdentity());
      if (there == kNone) {
        EXPECT_FALSE(transitions.isJump(here));
        continue;
      }
      EXPECT_EQ(transitions.across(there), transitions.across(here).inverse());
      innerFaces += here < there ? 1 : 0;
      jumps += here < there && transitions.isJump(here) ? 1 : 0;
    }
    EXPECT_EQ(transitions.jumps, jumps);
    EXPECT_EQ(transitions.innerFaces, innerFaces);
  }
}

/// AlgoHex's index of every rotation of this library.
std::array<std::int8_t, Rotation::kCount> algoHexIndices() {
  std::array<std::int8_t, Rotation::kCount> indices{};
  indices.fill(-1);
  for (std::int8_t index = 0; index < Rotation::kCount; ++index) {
    indices[static_cast<std::size_t>(rotationFromAlgoHex(index).index())] = index;
  }
  return indices;
}

TEST_P(TransitionsOfKind, GivenRotationsAreTheComputedOnes) {
  SampleOptions options;
  options.charts = ChartStyle::Random;
  options.jitter = 0.3;
  const TetMap map = generateSample(kind(), options).map;
  const Prepared computed(map);
  const auto indices = algoHexIndices();
  std::vector<std::array<std::int8_t, 4>> rotations(map.tets.size());
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (int face = 0; face < 4; ++face) {
      const HalfFace halfFace = halfFaceOf(static_cast<Index>(t), face);
      // Some remain unknown.
      rotations[t][static_cast<std::size_t>(face)] =
          halfFace % 7 == 0 ? std::int8_t{-1}
                            : indices[static_cast<std::size_t>(
                                  computed.transitions().across(halfFace).rotation.index())];
    }
  }
  TetMapView view(map);
  view.rotations = rotations;
  const Prepared given(view);
  EXPECT_TRUE(given.defects().empty());
  EXPECT_EQ(given.transitions().jump, computed.transitions().jump);
  EXPECT_EQ(given.transitions().table, computed.transitions().table);
}

INSTANTIATE_TEST_SUITE_P(Kinds, TransitionsOfKind, testing::ValuesIn(sampleKinds()),
                         test::kindTestName);

TEST(Transitions, WrongGivenRotationIsReported) {
  const TetMap map = generateSample(SampleKind::Cylinder, {.charts = ChartStyle::Random}).map;
  std::vector<std::array<std::int8_t, 4>> rotations(map.tets.size(), {0, 0, 0, 0});
  TetMapView view(map);
  view.rotations = rotations;
  const Prepared prepared(view);
  EXPECT_TRUE(prepared.defects().has(ErrorCode::TransitionResidual));
}

TEST(Transitions, AlignedBoxHasNoJumps) {
  for (const double offset : {0.0, 1e9}) {
    const TetMap map = generateSample(SampleKind::Box, {.jitter = 0.4, .offset = offset}).map;
    const Prepared prepared(map);
    EXPECT_EQ(prepared.transitions().jumps, 0U);
    EXPECT_EQ(prepared.transitions().table.size(), 1U);
    EXPECT_EQ(prepared.transitions().maxResidual, 0);
  }
}

TEST(Transitions, RandomChartsJumpNearlyEverywhere) {
  const TetMap map = generateSample(SampleKind::Box, {.charts = ChartStyle::Random}).map;
  const Prepared prepared(map);
  const Transitions& transitions = prepared.transitions();
  EXPECT_GT(transitions.jumps * 100, transitions.innerFaces * 99);
}

TEST(Transitions, ResidualAboveTheToleranceIsReported) {
  TetMap map = generateSample(SampleKind::Box).map;
  const Prepared before(map);
  // A tet inside the mesh, one of whose corners moves in this tet alone: three faces notice.
  Index tet = 0;
  const auto isInner = [&](Index t) {
    for (int face = 0; face < 4; ++face) {
      if (before.topology().isBoundary(halfFaceOf(t, face))) return false;
    }
    return true;
  };
  while (!isInner(tet)) ++tet;
  map.parameters[tet][1][2] += 0.03;
  EXPECT_EQ(check(map, {.tolerance = 0.05}).defects.size(), 0U);
  const CheckReport report = check(map, {.tolerance = 0.001});
  EXPECT_NEAR(report.maxTransitionResidual, 0.03, 1e-12);
  ASSERT_FALSE(report.valid());
  const Defect& defect = report.defects[0];
  EXPECT_EQ(defect.code, ErrorCode::TransitionResidual);
  EXPECT_GE(defect.count, 3U);
  EXPECT_NEAR(defect.worst[0].amount, 0.03, 1e-12);
}

TEST(Transitions, HugeParametersAreTooLarge) {
  for (const double factor : {1e8, 1e11, 1e20, 1e300}) {
    TetMap map = generateSample(SampleKind::Sphere).map;
    for (TetParameters& tet : map.parameters) {
      for (Vec3& corner : tet) {
        for (double& x : corner) x *= factor;
      }
    }
    const CheckReport report = check(map);
    ASSERT_EQ(report.defects.size(), 1U) << factor;
    EXPECT_EQ(report.defects[0].code, ErrorCode::TooLarge);
  }
}

}  // namespace
}  // namespace hexhex
