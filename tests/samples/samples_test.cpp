// Every sample is a valid integer-grid map with the answer that it claims.
#include <bit>
#include <cmath>
#include <limits>
#include <rapidcheck.h>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/error.hpp>
#include <hexhex/samples.hpp>

#include <samples/inspection.hpp>

namespace hexhex {
namespace {

using test::inspect;
using test::Inspection;

constexpr ChartStyle kChartStyles[] = {ChartStyle::Aligned, ChartStyle::Blocks, ChartStyle::Random,
                                       ChartStyle::Scattered};

std::string describe(SampleKind kind, const SampleOptions& options) {
  std::string text;
  for (const SampleKindName& entry : sampleKinds()) {
    if (entry.kind == kind) text = entry.name;
  }
  return text + " cells " + std::to_string(options.cells) + " refine " +
         std::to_string(options.refine) + " valence " + std::to_string(options.valence) +
         " charts " + std::to_string(static_cast<int>(options.charts)) + " jitter " +
         std::to_string(options.jitter) + " onLattice " + std::to_string(options.onLattice) +
         " noise " + std::to_string(options.noise) + " offset " + std::to_string(options.offset) +
         " seed " + std::to_string(options.seed);
}

/// Lengths agree with numbers of edges up to `share`.
void expectLengths(const std::map<int, double>& found, const std::map<int, std::uint64_t>& expected,
                   double share) {
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [valence, count] : expected) {
    ASSERT_TRUE(found.contains(valence)) << "valence " << valence;
    const auto length = static_cast<double>(count);
    EXPECT_NEAR(found.at(valence), length, share * length) << "valence " << valence;
  }
}

void expectValid(SampleKind kind, const SampleOptions& options) {
  SCOPED_TRACE(describe(kind, options));
  const Sample sample = generateSample(kind, options);
  const Expectation& expected = sample.answer.expected;
  const Inspection found = inspect(sample.map);

  EXPECT_TRUE(found.conforming);
  EXPECT_GT(found.leastDeterminantInMap, 0);
  EXPECT_GT(found.leastDeterminantInSpace, 0);
  EXPECT_EQ(found.eulerCharacteristic, expected.eulerCharacteristic);
  EXPECT_EQ(found.components, expected.components);
  EXPECT_EQ(found.boundaryComponents, expected.boundaryComponents);

  // Differences of two noisy numbers, and one more for the translation that is rounded from them.
  const double tolerance = 4 * options.noise;
  EXPECT_LE(found.worstTransition, tolerance);
  EXPECT_LE(found.worstBoundary, tolerance);
  EXPECT_LE(found.worstSingularity, tolerance);
  // Sums over noisy tets agree only roughly.
  const double share = options.noise > 0 ? 0.1 : 1e-9;
  const auto cells = static_cast<double>(expected.cells);
  const auto quads = static_cast<double>(expected.boundaryQuads);
  EXPECT_NEAR(found.volume, cells, share * cells);
  EXPECT_NEAR(found.boundaryArea, quads, share * quads);
  EXPECT_LT(found.worstAngle, options.noise > 0 ? 0.75 : 1e-6);
  expectLengths(found.innerSingularLength, expected.innerSingularEdges, share);
  expectLengths(found.boundarySingularLength, expected.boundarySingularEdges, share);
}

class EveryKind : public testing::TestWithParam<SampleKindName> {};

TEST_P(EveryKind, IsValidForAnySize) {
  for (const auto& [cells, refine] : {std::array{1, 1}, {3, 1}, {4, 2}, {2, 3}, {5, 4}, {1, 6}}) {
    SampleOptions options;
    options.cells = cells;
    options.refine = refine;
    expectValid(GetParam().kind, options);
  }
}

TEST_P(EveryKind, IsValidForEveryChartStyle) {
  for (const ChartStyle charts : kChartStyles) {
    for (const double offset : {0.0, 1e9}) {
      SampleOptions options;
      options.cells = 3;
      options.charts = charts;
      options.offset = offset;
      options.jitter = 0.4;
      expectValid(GetParam().kind, options);
    }
  }
}

TEST_P(EveryKind, IsValidWhenPerturbed) {
  struct Perturbation {
    double jitter, onLattice, noise;
  };
  for (const auto& [jitter, onLattice, noise] : {Perturbation{0.3, 0, 0},
                                                 {1, 0, 0},
                                                 {0, 0.5, 0},
                                                 {0.3, 1, 0},
                                                 {0, 0, 0.005},
                                                 {0.3, 0.5, 0.005},
                                                 {1, 1, 0.005}}) {
    SampleOptions options;
    options.cells = 5;
    options.refine = 3;
    options.charts = ChartStyle::Blocks;
    options.jitter = jitter;
    options.onLattice = onLattice;
    options.noise = noise;
    expectValid(GetParam().kind, options);
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, EveryKind, testing::ValuesIn(sampleKinds()),
                         [](const auto& instance) {
                           std::string name(instance.param.name);
                           std::erase(name, '-');
                           return name;
                         });

TEST(Samples, StarsOfEveryValenceAreValid) {
  for (int valence = 3; valence <= 12; ++valence) {
    for (const int refine : {1, 2, 4}) {
      SampleOptions options;
      options.valence = valence;
      options.refine = refine;
      options.jitter = 0.2;
      expectValid(SampleKind::Star, options);
    }
  }
}

/// Counts of the coarse complexes, by hand.
struct Coarse {
  SampleKind kind;
  std::uint64_t vertices, edges, faces, blocks, boundaryFaces;
  std::map<int, std::uint64_t> inner, boundary;
  std::int64_t euler;
  std::uint64_t boundaryComponents;
};

TEST(Samples, AnswersAgreeWithCountsByHand) {
  const std::vector<Coarse> all = {
      {SampleKind::Box, 27, 54, 36, 8, 24, {}, {{1, 24}}, 1, 1},
      {SampleKind::Cylinder, 16, 32, 22, 5, 14, {{3, 4}}, {{1, 8}}, 1, 1},
      {SampleKind::Sphere, 16, 32, 24, 7, 6, {{3, 20}}, {}, 1, 1},
      {SampleKind::Star, 22, 41, 25, 5, 20, {{5, 1}}, {{1, 25}}, 1, 1},
      {SampleKind::Tetrahedron, 15, 28, 18, 4, 12, {{3, 4}}, {{1, 12}}, 1, 1},
      {SampleKind::Torus, 48, 120, 102, 30, 24, {{3, 24}}, {}, 0, 1},
      {SampleKind::Shell, 16, 32, 24, 6, 12, {{3, 8}}, {}, 2, 2},
      {SampleKind::HandleBody, 48, 100, 64, 13, 50, {}, {{1, 52}, {3, 8}}, -1, 1},
  };
  for (const Coarse& coarse : all) {
    for (const std::uint64_t n : {1U, 2U, 7U}) {
      SampleOptions options;
      options.cells = static_cast<int>(n);
      options.refine = 1;
      SCOPED_TRACE(describe(coarse.kind, options));
      const SampleAnswer answer = generateSample(coarse.kind, options).answer;
      const std::uint64_t m = n - 1;
      EXPECT_EQ(answer.vertices, coarse.vertices + m * coarse.edges + m * m * coarse.faces +
                                     m * m * m * coarse.blocks);
      EXPECT_EQ(answer.expected.cells, coarse.blocks * n * n * n);
      EXPECT_EQ(answer.expected.boundaryQuads, coarse.boundaryFaces * n * n);
      const auto times = [n](std::map<int, std::uint64_t> counts) {
        for (auto& [valence, count] : counts) count *= n;
        return counts;
      };
      EXPECT_EQ(answer.expected.innerSingularEdges, times(coarse.inner));
      EXPECT_EQ(answer.expected.boundarySingularEdges, times(coarse.boundary));
      EXPECT_EQ(answer.expected.eulerCharacteristic, coarse.euler);
      EXPECT_EQ(answer.expected.components, 1U);
      EXPECT_EQ(answer.expected.boundaryComponents, coarse.boundaryComponents);
    }
  }
}

TEST(Samples, HaveTwelveTetsPerSubBlock) {
  SampleOptions options;
  options.refine = 3;
  EXPECT_EQ(generateSample(SampleKind::Sphere, options).map.tets.size(), 7U * 27 * 12);
}

TEST(Samples, AlignedBoxHasNoChartJumps) {
  for (const double offset : {0.0, 1e6}) {
    SampleOptions options;
    options.offset = offset;
    options.jitter = 0.5;
    EXPECT_EQ(inspect(generateSample(SampleKind::Box, options).map).chartJumps, 0U);
  }
}

TEST(Samples, AlignedChartsJumpOnlyBetweenSomeBlocks) {
  SampleOptions options;
  options.refine = 4;
  const Inspection aligned = inspect(generateSample(SampleKind::Sphere, options).map);
  options.charts = ChartStyle::Blocks;
  const Inspection blocks = inspect(generateSample(SampleKind::Sphere, options).map);
  // 18 inner faces of 4 x 4 x 2 triangles; 6 blocks are reached across one of them each.
  EXPECT_EQ(aligned.chartJumps, 12U * 32);
  EXPECT_EQ(blocks.chartJumps, 18U * 32);
}

TEST(Samples, RandomChartsJumpNearlyEverywhere) {
  SampleOptions options;
  options.charts = ChartStyle::Random;
  const Inspection found = inspect(generateSample(SampleKind::Cylinder, options).map);
  EXPECT_GT(found.chartJumps * 100, found.innerFaces * 99);
}

TEST(Samples, ScatteredChartsJumpHereAndThere) {
  SampleOptions options;
  options.charts = ChartStyle::Scattered;
  const Inspection found = inspect(generateSample(SampleKind::Box, options).map);
  EXPECT_GT(found.chartJumps * 100, found.innerFaces * 15);
  EXPECT_LT(found.chartJumps * 100, found.innerFaces * 35);
}

TEST(Samples, OffsetMovesChartsFarAway) {
  for (const ChartStyle charts : kChartStyles) {
    SampleOptions options;
    options.charts = charts;
    options.offset = 1e9;
    double largest = 0;
    for (const TetParameters& tet : generateSample(SampleKind::Shell, options).map.parameters) {
      for (const Vec3& corner : tet) {
        for (const double x : corner) largest = std::max(largest, std::abs(x));
      }
    }
    EXPECT_GT(largest, 1e8);
    EXPECT_LT(largest, 1e9 + 1000);
  }
}

bool sameMap(const TetMap& a, const TetMap& b) {
  return a.points == b.points && a.tets == b.tets && a.parameters == b.parameters;
}

SampleOptions everything() {
  SampleOptions options;
  options.charts = ChartStyle::Random;
  options.refine = 3;
  options.jitter = 0.4;
  options.onLattice = 0.3;
  options.noise = 0.001;
  options.offset = 1000;
  return options;
}

TEST(Samples, SameSeedSameMap) {
  const SampleOptions options = everything();
  EXPECT_TRUE(sameMap(generateSample(SampleKind::Torus, options).map,
                      generateSample(SampleKind::Torus, options).map));
}

TEST(Samples, SeedChangesEveryRandomOption) {
  std::vector<SampleOptions> variants(5);
  variants[0].jitter = 0.4;
  variants[1].noise = 0.01;
  variants[2].charts = ChartStyle::Blocks;
  variants[3].charts = ChartStyle::Random;
  variants[4].onLattice = 0.5;
  variants[4].refine = 3;
  for (SampleOptions options : variants) {
    SCOPED_TRACE(describe(SampleKind::Sphere, options));
    const TetMap first = generateSample(SampleKind::Sphere, options).map;
    options.seed = 2;
    EXPECT_FALSE(sameMap(first, generateSample(SampleKind::Sphere, options).map));
  }
}

/// FNV-1a over all bits of a map.
std::uint64_t fingerprint(const TetMap& map) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto add = [&hash](std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) {
      hash = (hash ^ (value >> (8 * byte) & 0xff)) * 0x100000001b3ULL;
    }
  };
  for (const Vec3& point : map.points) {
    for (const double x : point) add(std::bit_cast<std::uint64_t>(x));
  }
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c) {
      add(map.tets[t][c]);
      for (const double x : map.parameters[t][c]) add(std::bit_cast<std::uint64_t>(x));
    }
  }
  return hash;
}

// The numbers were recorded once; a change means that maps of old seeds cannot be had any more, or
// that compilers disagree.
TEST(Samples, SameMapOnEveryMachine) {
  EXPECT_EQ(fingerprint(generateSample(SampleKind::Torus, everything()).map), 4532028927376472981U);
  EXPECT_EQ(fingerprint(generateSample(SampleKind::Sphere, everything()).map),
            12440884287155940078U);
}

std::size_t countDifferent(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i] ? 1 : 0;
  return count;
}

TEST(Samples, JitterMovesMostVerticesInMapAndSpace) {
  SampleOptions options;
  options.refine = 6;
  const TetMap still = generateSample(SampleKind::Sphere, options).map;
  options.jitter = 0.3;
  const TetMap moved = generateSample(SampleKind::Sphere, options).map;
  ASSERT_EQ(still.tets, moved.tets);
  // Most points are inside.
  EXPECT_GT(countDifferent(still.points, moved.points), still.points.size() * 3 / 4);
  std::size_t corners = 0;
  for (std::size_t t = 0; t < still.tets.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c) {
      corners += still.parameters[t][c] != moved.parameters[t][c] ? 1 : 0;
    }
  }
  EXPECT_GT(corners, still.tets.size() * 4 * 9 / 10);
}

TEST(Samples, OnLatticePutsMoreCoordinatesOnIntegers) {
  SampleOptions options;
  options.cells = 10;
  options.refine = 3;
  options.jitter = 0.3;
  std::uint64_t previous = 0;
  for (const double onLattice : {0.0, 0.3, 0.6, 1.0}) {
    options.onLattice = onLattice;
    const std::uint64_t count =
        inspect(generateSample(SampleKind::Torus, options).map).integerCoordinates;
    EXPECT_GT(count, previous + previous / 8);
    previous = count;
  }
}

TEST(Samples, NoiseIsBounded) {
  SampleOptions options;
  const TetMap exact = generateSample(SampleKind::Star, options).map;
  options.noise = 0.01;
  const TetMap noisy = generateSample(SampleKind::Star, options).map;
  double largest = 0;
  for (std::size_t t = 0; t < exact.tets.size(); ++t) {
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t a = 0; a < 3; ++a) {
        largest =
            std::max(largest, std::abs(exact.parameters[t][c][a] - noisy.parameters[t][c][a]));
      }
    }
  }
  EXPECT_GT(largest, 0.009);
  EXPECT_LE(largest, 0.01 + 1e-12);
}

TEST(Samples, NamesAreUniqueAndComplete) {
  ASSERT_EQ(sampleKinds().size(), 8U);
  for (std::size_t i = 0; i < sampleKinds().size(); ++i) {
    EXPECT_EQ(sampleKinds()[i].kind, static_cast<SampleKind>(i));
    EXPECT_FALSE(sampleKinds()[i].description.empty());
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(sampleKinds()[i].name, sampleKinds()[j].name);
  }
  ASSERT_EQ(chartStyles().size(), 4U);
  for (std::size_t i = 0; i < chartStyles().size(); ++i) {
    EXPECT_EQ(chartStyles()[i].kind, static_cast<ChartStyle>(i));
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(chartStyles()[i].name, chartStyles()[j].name);
  }
}

template <class Change>
void expectRefused(const Change& change, const std::string& option,
                   ErrorCode code = ErrorCode::InvalidArgument,
                   SampleKind kind = SampleKind::Star) {
  SampleOptions options;
  change(options);
  SCOPED_TRACE(describe(kind, options));
  try {
    (void)generateSample(kind, options);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_NE(std::string(error.what()).find(option), std::string::npos) << error.what();
  }
}

TEST(Samples, RefusesIllegalOptions) {
  using Options = SampleOptions;
  for (const int value : {-1, 0, 10001, std::numeric_limits<int>::min()}) {
    expectRefused([=](Options& options) { options.cells = value; }, "'cells'");
    expectRefused([=](Options& options) { options.refine = value; }, "'refine'");
    expectRefused([=](Options& options) { options.valence = value; }, "'valence'");
  }
  expectRefused([](Options& options) { options.refine = 501; }, "'refine'");
  expectRefused([](Options& options) { options.valence = 2; }, "'valence'");
  expectRefused([](Options& options) { options.valence = 13; }, "'valence'");
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double value : {-1e-9, 1.1e9, kNan, kInfinity, -kInfinity}) {
    expectRefused([=](Options& options) { options.jitter = value; }, "'jitter'");
    expectRefused([=](Options& options) { options.onLattice = value; }, "'onLattice'");
    expectRefused([=](Options& options) { options.noise = value; }, "'noise'");
    expectRefused([=](Options& options) { options.offset = value; }, "'offset'");
  }
  expectRefused(
      [](Options& options) {
        options.cells = 100;
        options.noise = 0.25;
      },
      "'noise'");
  expectRefused([](Options& options) { options.refine = 500, options.noise = 0.01; }, "refine 500");
}

TEST(Samples, RefusesUnknownEnumerators) {
  expectRefused([](SampleOptions&) {}, "enumerators", ErrorCode::InvalidArgument,
                static_cast<SampleKind>(99));
  expectRefused([](SampleOptions& options) { options.charts = static_cast<ChartStyle>(99); },
                "enumerators");
}

TEST(Samples, RefusesMoreTetsThanIndices) {
  expectRefused([](SampleOptions& options) { options.refine = 500; }, "smaller refine",
                ErrorCode::TooLarge, SampleKind::Box);
}

TEST(Samples, ValenceMattersOnlyForStars) {
  SampleOptions options;
  options.valence = 0;
  EXPECT_NO_THROW((void)generateSample(SampleKind::Box, options));
}

TEST(Samples, AnyOptionsGiveAValidMap) {
  // The seed and the options of a failure are printed by RapidCheck.
  const bool holds = rc::check("any options give a valid map", [] {
    SampleOptions options;
    const auto kind = static_cast<SampleKind>(*rc::gen::inRange(0, 8));
    options.cells = *rc::gen::inRange(1, 9);
    options.refine = *rc::gen::inRange(1, 4);
    options.valence = *rc::gen::inRange(3, 13);
    options.charts = static_cast<ChartStyle>(*rc::gen::inRange(0, 4));
    options.jitter = *rc::gen::inRange(0, 11) / 10.0;
    options.onLattice = *rc::gen::inRange(0, 11) / 10.0;
    options.noise = *rc::gen::inRange(0, 2) * 0.01 * options.cells / options.refine;
    options.offset = *rc::gen::element(0.0, 3.0, 1e4);
    options.seed = *rc::gen::arbitrary<std::uint64_t>();
    expectValid(kind, options);
    RC_ASSERT(!testing::Test::HasFailure());
  });
  EXPECT_TRUE(holds);
}

}  // namespace
}  // namespace hexhex
