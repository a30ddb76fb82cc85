// Transitions between charts: they carry parameters over, and are inverse to each other.
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/check.hpp>

#include <base/vector3.hpp>
#include <igm/transition_fit.hpp>
#include <igm/transitions.hpp>

#include "map_samples.hpp"

namespace hexhex::igm {
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
double worstImage(const adjacency::TetTopology& topology, const LocalParameters& parameters,
                  const Transitions& transitions) {
  double worst = 0;
  for (adjacency::HalfFace here = 0; here < topology.mate.size(); ++here) {
    const adjacency::HalfFace there = topology.mate[here];
    if (there == kNone) continue;
    for (const int corner : lattice::kFaceCorners[here % 4]) {
      const Index vertex = topology.vertex(4 * adjacency::tetOf(here) + static_cast<Index>(corner));
      const Vec3 image = transitions.across(here)(parameters(adjacency::tetOf(here), corner), 1.0);
      const Vec3 actual = parameters(adjacency::tetOf(there),
                                     topology.localCorner(adjacency::tetOf(there), vertex));
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
    const adjacency::TetTopology& topology = prepared.topology();
    const Transitions& transitions = prepared.transitions();
    std::uint64_t count = 0;
    std::uint64_t innerFaces = 0;
    for (adjacency::HalfFace here = 0; here < topology.mate.size(); ++here) {
      const adjacency::HalfFace there = topology.mate[here];
      EXPECT_EQ(transitions.isNonTrivial(here), !transitions.across(here).isIdentity());
      if (there == kNone) {
        EXPECT_FALSE(transitions.isNonTrivial(here));
        continue;
      }
      EXPECT_EQ(transitions.across(there), transitions.across(here).inverse());
      innerFaces += here < there ? 1 : 0;
      count += here < there && transitions.isNonTrivial(here) ? 1 : 0;
    }
    EXPECT_EQ(transitions.nonTrivial, count);
    EXPECT_EQ(transitions.innerFaces, innerFaces);
  }
}

/// AlgoHex's index of every rotation of this library.
std::array<std::int8_t, lattice::Rotation::kCount> algoHexIndices() {
  std::array<std::int8_t, lattice::Rotation::kCount> indices{};
  indices.fill(-1);
  for (std::int8_t index = 0; index < lattice::Rotation::kCount; ++index) {
    indices[static_cast<std::size_t>(lattice::rotationFromAlgoHex(index).index())] = index;
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
      const adjacency::HalfFace halfFace = adjacency::halfFaceOf(static_cast<Index>(t), face);
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
  EXPECT_EQ(given.transitions().ofFace, computed.transitions().ofFace);
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
    EXPECT_EQ(prepared.transitions().nonTrivial, 0U);
    EXPECT_EQ(prepared.transitions().table.size(), 1U);
    EXPECT_EQ(prepared.transitions().maxResidual, 0);
  }
}

TEST(Transitions, RandomChartsJumpNearlyEverywhere) {
  const TetMap map = generateSample(SampleKind::Box, {.charts = ChartStyle::Random}).map;
  const Prepared prepared(map);
  const Transitions& transitions = prepared.transitions();
  EXPECT_GT(transitions.nonTrivial * 100, transitions.innerFaces * 99);
}

/// Whether a + b is c without rounding (Knuth's TwoSum).
bool isExactSum(double a, double b, double c) {
  const double sum = a + b;
  const double ofB = sum - a;
  const double error = (a - (sum - ofB)) + (b - ofB);
  return sum == c && error == 0;
}

/// Moves all parameters of all tets by up to half of the noise.
void addNoise(TetMap& map, double noise) {
  std::uint64_t seed = 1;
  for (TetParameters& u : map.parameters) {
    for (Vec3& corner : u) {
      for (double& x : corner) {
        seed = seed * 6364136223846793005U + 1442695040888963407U;
        x += noise * (static_cast<double>(seed >> 40) * 0x1p-24 - 0.5);
      }
    }
  }
}

/// Compares the transition across a half-face with what its corners say.
void expectBest(const adjacency::TetTopology& topology, const Transitions& transitions,
                const LocalParameters& parameters, adjacency::HalfFace here) {
  const adjacency::HalfFace there = topology.mate[here];
  const adjacency::SharedFace face(topology, here, there);
  std::array<Vec3, 3> u{};
  std::array<Vec3, 3> v{};
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_EQ(topology.tets[adjacency::tetOf(here)][face.here(k)],
              topology.tets[adjacency::tetOf(there)][face.there(k)]);
    u[k] = parameters.at(adjacency::tetOf(here), face.here(k));
    v[k] = parameters.at(adjacency::tetOf(there), face.there(k));
  }
  const lattice::Rotation rotation = bestRotationOfAll({minus(u[1], u[0]), minus(u[2], u[0])},
                                                       {minus(v[1], v[0]), minus(v[2], v[0])});
  ASSERT_EQ(transitions.across(here).rotation, rotation);
  bool isExact = true;
  for (std::size_t k = 0; k < 3; ++k) {
    double mean = 0;
    for (std::size_t i = 0; i < 3; ++i) mean += (v[i][k] - rotation(u[i])[k]) / 3;
    ASSERT_EQ(transitions.across(here).translation[k], std::nearbyint(mean));
    for (std::size_t i = 0; i < 3; ++i) {
      isExact &= isExactSum(rotation(u[i])[k], std::nearbyint(mean), v[i][k]);
    }
  }
  const Index index = transitions.ofFace[here];
  if (index != 0) {
    ASSERT_EQ(transitions.isExact[index] != 0, isExact);
  }
  ASSERT_EQ(transitions.ofFace[there], Transitions::inverse(index));
}

TEST(Transitions, AreTheBestRotationAndTheMeanTranslation) {
  // Noise below and above what can be seen without the mean; exact charts, and far away ones.
  for (const double noise : {0.0, 1e-9, 1e-3, 0.2, 0.6}) {
    SampleOptions options;
    options.refine = 2;
    options.jitter = 0.3;
    options.charts = ChartStyle::Random;
    TetMap map = generateSample(SampleKind::Cylinder, options).map;
    addNoise(map, noise);
    const Prepared prepared(map, 0.2);
    const adjacency::TetTopology& topology = prepared.topology();
    if (prepared.transitions().ofFace.empty()) continue;  // a defect of the mesh in the map
    const LocalParameters parameters(prepared.map().input);
    for (adjacency::HalfFace here = 0; here < topology.mate.size(); ++here) {
      if (topology.mate[here] == kNone || topology.mate[here] < here) continue;
      ASSERT_NO_FATAL_FAILURE(expectBest(topology, prepared.transitions(), parameters, here));
    }
  }
}

TEST(Transitions, ResidualAboveTheToleranceIsReported) {
  TetMap map = generateSample(SampleKind::Box).map;
  const Prepared before(map);
  // A tet inside the mesh, one of whose corners moves in this tet alone: three faces notice.
  Index tet = 0;
  const auto isInner = [&](Index t) {
    for (int face = 0; face < 4; ++face) {
      if (before.topology().isBoundary(adjacency::halfFaceOf(t, face))) return false;
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
}  // namespace hexhex::igm
