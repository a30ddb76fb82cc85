// The sanitized map fulfils all constraints exactly, changes little, and depends on nothing but the
// map.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/check.hpp>

#include <igm/sanitization.hpp>

#include "map_samples.hpp"

namespace hexhex::igm {
namespace {

using test::Prepared;

class SanitizeKind : public test::EveryKind {};

bool isInteger(std::int64_t coordinate, std::int64_t unit) { return coordinate % unit == 0; }

const lattice::LatticePoint& cornerOf(const ExactMap& map, Index tet, int corner) {
  return map.corners[tet][static_cast<std::size_t>(corner)];
}

/// (IGM1) on inner faces, without any tolerance.
std::size_t openFaces(const adjacency::TetTopology& topology, const ExactMap& map) {
  std::size_t count = 0;
  for (adjacency::HalfFace here = 0; here < topology.mate.size(); ++here) {
    const adjacency::HalfFace there = topology.mate[here];
    if (there == kNone) continue;
    bool open = false;
    for (const int corner : lattice::kFaceCorners[here % 4]) {
      const Index vertex = topology.vertex(4 * adjacency::tetOf(here) + static_cast<Index>(corner));
      open = open || map.transitions.across(here)(cornerOf(map, adjacency::tetOf(here), corner),
                                                  map.unit) !=
                         cornerOf(map, adjacency::tetOf(there),
                                  topology.localCorner(adjacency::tetOf(there), vertex));
    }
    count += open ? 1 : 0;
  }
  return count;
}

/// (IGM2): boundary triangles that are on no integer plane.
std::size_t boundaryOffPlanes(const adjacency::TetTopology& topology, const ExactMap& map) {
  std::size_t count = 0;
  for (adjacency::HalfFace here = 0; here < topology.mate.size(); ++here) {
    if (!topology.isBoundary(here)) continue;
    const std::array<int, 3>& face = lattice::kFaceCorners[here % 4];
    bool onPlane = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t x = cornerOf(map, adjacency::tetOf(here), face[0])[k];
      onPlane = onPlane ||
                (isInteger(x, map.unit) && cornerOf(map, adjacency::tetOf(here), face[1])[k] == x &&
                 cornerOf(map, adjacency::tetOf(here), face[2])[k] == x);
    }
    count += onPlane ? 0 : 1;
  }
  return count;
}

/// (IGM3): singular edges that are on no integer line.
std::size_t singularEdgesOffLines(const Singularities& singularities, const ExactMap& map) {
  std::size_t count = 0;
  for (const SingularEdge& edge : singularities.edges) {
    const lattice::LatticePoint& p = cornerOf(map, edge.tet, edge.corner0);
    const lattice::LatticePoint& q = cornerOf(map, edge.tet, edge.corner1);
    int onPlanes = 0;
    for (std::size_t k = 0; k < 3; ++k) onPlanes += p[k] == q[k] && isInteger(p[k], map.unit);
    count += onPlanes == 2 ? 0 : 1;
  }
  return count;
}

/// (IGM3): corners at singular nodes that are on no integer point.
std::size_t nodesOffPoints(const adjacency::TetTopology& topology,
                           const Singularities& singularities, const ExactMap& map) {
  std::size_t count = 0;
  for (Index v = 0; v < topology.pointCount; ++v) {
    if (!singularities.isNode(v)) continue;
    for (const adjacency::CornerIndex corner : topology.star(v)) {
      const lattice::LatticePoint& p = cornerOf(map, corner / 4, adjacency::localOf(corner));
      const bool onPoint =
          std::all_of(p.begin(), p.end(), [&](std::int64_t x) { return isInteger(x, map.unit); });
      count += onPoint ? 0 : 1;
    }
  }
  return count;
}

void expectExact(const Prepared& prepared, const ExactMap& map) {
  EXPECT_EQ(openFaces(prepared.topology(), map), 0U);
  EXPECT_EQ(boundaryOffPlanes(prepared.topology(), map), 0U);
  EXPECT_EQ(singularEdgesOffLines(prepared.singularities(), map), 0U);
  EXPECT_EQ(nodesOffPoints(prepared.topology(), prepared.singularities(), map), 0U);
  // Where possible, tets were found positive in floating point.
  for (const lattice::LatticeTet& tet : map.corners) {
    EXPECT_GT(lattice::orientationDeterminant(tet[0], tet[1], tet[2], tet[3]).sign(), 0);
  }
}

/// The volume was summed over faces.
void expectVolumeOfTets(const ExactMap& map) {
  lattice::Int192 difference = -map.sixfoldVolume;
  for (const lattice::LatticeTet& tet : map.corners) {
    difference += lattice::orientationDeterminant(tet[0], tet[1], tet[2], tet[3]);
  }
  EXPECT_EQ(difference.sign(), 0);
}

/// Samples with noise from nothing to a thousandth, in all chart styles.
template <class Visit>
void forEachNoise(SampleKind kind, const Visit& visit) {
  for (const double noise : {0.0, 1e-9, 1e-6, 1e-4, 1e-3}) {
    for (const ChartStyle charts : test::kChartStyles) {
      visit(generateSample(kind, {.charts = charts, .jitter = 0.3, .noise = noise}).map, noise);
    }
  }
}

TEST_P(SanitizeKind, FulfilsAllConstraintsExactly) {
  forEachNoise(kind(), [](const TetMap& map, double noise) {
    SCOPED_TRACE(noise);
    const Prepared prepared(map);
    ASSERT_TRUE(prepared.defects().empty());
    expectExact(prepared, prepared.exact());
    expectVolumeOfTets(prepared.exact());
  });
}

TEST_P(SanitizeKind, MovesByTheNoiseOnly) {
  forEachNoise(kind(), [](const TetMap& map, double noise) {
    const Prepared prepared(map);
    // The representative and the corner that receives its value are both off by the noise; rounding
    // to the lattice adds half a unit.
    const double limit = 2 * noise + 1.0 / static_cast<double>(prepared.exact().unit);
    EXPECT_LE(prepared.exact().maxDisplacement, limit);
    if (noise == 0) {
      EXPECT_EQ(prepared.exact().maxDisplacement, 0);
    }
  });
}

TEST_P(SanitizeKind, DisplacementIsTheLargestChange) {
  const TetMap map = generateSample(kind(), {.noise = 1e-3}).map;  // charts close to the origin
  const Prepared prepared(map);
  double largest = 0;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double after = static_cast<double>(prepared.exact().corners[t][i][k]) /
                             static_cast<double>(prepared.exact().unit);
        largest = std::max(largest, std::abs(after - map.parameters[t][i][k]));
      }
    }
  }
  EXPECT_EQ(prepared.exact().maxDisplacement, largest);
}

TEST_P(SanitizeKind, DoesNotDependOnThreads) {
  SampleOptions options;
  options.refine = 6;  // more vertices than one block of a parallel loop
  options.cells = 7;
  options.charts = ChartStyle::Random;
  options.noise = 1e-3;
  const TetMap map = generateSample(kind(), options).map;
  const Prepared one(map, 1e-2, 1, 1);
  const Prepared two(map, 1e-2, 1, 2);
  EXPECT_TRUE(one.exact().corners == two.exact().corners);
  EXPECT_EQ(one.exact().unit, two.exact().unit);
  EXPECT_EQ(one.exact().maxDisplacement, two.exact().maxDisplacement);
  EXPECT_TRUE(one.transitions().ofFace == two.transitions().ofFace);
  EXPECT_TRUE(one.transitions().table == two.transitions().table);
  EXPECT_TRUE(one.topology().mate == two.topology().mate);
  for (Index v = 0; v < map.points.size(); ++v) {
    EXPECT_TRUE(std::ranges::equal(one.topology().star(v), two.topology().star(v)));
  }
}

TEST_P(SanitizeKind, DoesNotDependOnNumbering) {
  for (const ChartStyle charts : test::kChartStyles) {
    const TetMap map =
        generateSample(kind(), {.charts = charts, .jitter = 0.4, .onLattice = 0.2}).map;
    const std::vector<Index> newVertex = test::permutation(map.points.size(), 1);
    const std::vector<Index> newTet = test::permutation(map.tets.size(), 2);
    TetMap renumbered = map;
    for (std::size_t v = 0; v < map.points.size(); ++v) {
      renumbered.points[newVertex[v]] = map.points[v];
    }
    for (std::size_t t = 0; t < map.tets.size(); ++t) {
      for (std::size_t i = 0; i < 4; ++i) {
        renumbered.tets[newTet[t]][i] = newVertex[map.tets[t][i]];
      }
      renumbered.parameters[newTet[t]] = map.parameters[t];
    }
    const Prepared before(map);
    const Prepared after(renumbered);
    ASSERT_TRUE(after.defects().empty());
    ASSERT_EQ(after.exact().unit, before.exact().unit);
    for (std::size_t t = 0; t < map.tets.size(); ++t) {
      ASSERT_EQ(after.exact().corners[newTet[t]], before.exact().corners[t]);
    }
  }
}

/// Tets list their corners in any order that keeps their orientation.
TEST_P(SanitizeKind, DoesNotDependOnTheOrderOfCorners) {
  constexpr std::array<std::array<std::size_t, 4>, 4> kOrders = {
      {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 1, 0, 2}}};
  for (const ChartStyle charts : test::kChartStyles) {
    const TetMap map = generateSample(kind(), {.charts = charts, .jitter = 0.4}).map;
    TetMap turned = map;
    for (std::size_t t = 0; t < map.tets.size(); ++t) {
      for (std::size_t i = 0; i < 4; ++i) {
        turned.tets[t][i] = map.tets[t][kOrders[t % 4][i]];
        turned.parameters[t][i] = map.parameters[t][kOrders[t % 4][i]];
      }
    }
    const Prepared before(map);
    const Prepared after(turned);
    ASSERT_TRUE(after.defects().empty());
    expectExact(after, after.exact());
    EXPECT_EQ(after.exact().maxDisplacement, 0);
    EXPECT_EQ(after.exact().unit, before.exact().unit);
  }
}

TEST_P(SanitizeKind, ScalesExactly) {
  const TetMap map =
      generateSample(kind(), {.charts = ChartStyle::Random, .noise = 1e-4, .offset = 1000}).map;
  for (const int scale : {1, 2, 7, 1000}) {
    SCOPED_TRACE(scale);
    const Prepared prepared(map, 1e-2, scale);
    ASSERT_TRUE(prepared.defects().empty());
    ExactMap scaled = prepared.exact();
    Context context;
    Stage stage(context, "test");
    scaleMap(scaled, scale, stage);
    EXPECT_EQ(scaled.unit, prepared.exact().unit);
    for (std::size_t t = 0; t < scaled.corners.size(); ++t) {
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          ASSERT_EQ(scaled.corners[t][i][k], prepared.exact().corners[t][i][k] * scale);
        }
      }
    }
    expectExact(prepared, scaled);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SanitizeKind, testing::ValuesIn(sampleKinds()), test::kindTestName);

/// The error that a map with this noise ends in.
Error errorOfNoise(SampleKind kind, double noise, double tolerance) {
  const TetMap map =
      generateSample(kind, {.cells = 9, .refine = 1, .charts = ChartStyle::Blocks, .noise = noise})
          .map;
  const Prepared prepared(map, tolerance);
  try {
    prepared.defects().throwIfAny();
  } catch (const Error& error) {
    return error;
  }
  return {ErrorCode::Internal, "nothing thrown"};
}

TEST(Sanitize, NoiseBeyondTheToleranceIsAnErrorWithAPlace) {
  for (const SampleKindName& entry : sampleKinds()) {
    const Error error = errorOfNoise(entry.kind, 0.05, 1e-3);
    EXPECT_EQ(error.code(), ErrorCode::TransitionResidual);
    EXPECT_NE(error.place().kind, PlaceKind::None);
    EXPECT_NE(std::string(error.what()).find(toString(error.place())), std::string::npos);
  }
}

TEST(Sanitize, NoiseWithinAnExplicitToleranceIsNoError) {
  for (const SampleKindName& entry : sampleKinds()) {
    EXPECT_EQ(errorOfNoise(entry.kind, 0.05, 0.2).code(), ErrorCode::Internal) << entry.name;
  }
}

TEST(Sanitize, ChartsFarAwayKeepTheirPrecision) {
  for (const SampleKindName& entry : sampleKinds()) {
    const TetMap map =
        generateSample(entry.kind, {.charts = ChartStyle::Random, .jitter = 0.3, .offset = 1e9})
            .map;
    const Prepared prepared(map);
    ASSERT_TRUE(prepared.defects().empty()) << entry.name;
    expectExact(prepared, prepared.exact());
    EXPECT_EQ(prepared.exact().maxDisplacement, 0) << entry.name;
  }
}

TEST(Sanitize, ScaleThatDoesNotFitIsTooLarge) {
  const TetMap map = generateSample(SampleKind::Box).map;
  EXPECT_TRUE(check(map, {.scale = 100000}).valid());
  for (const int scale : {1000000, 2000000000}) {
    const CheckReport report = check(map, {.scale = scale});
    ASSERT_EQ(report.defects.size(), 1U);
    EXPECT_EQ(report.defects[0].code, ErrorCode::TooLarge);
  }
}

}  // namespace
}  // namespace hexhex::igm
