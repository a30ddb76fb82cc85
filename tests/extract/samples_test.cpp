// Every kind of sample, with every sort of difficulty: the mesh agrees with the map, and with the
// answer that is known without any map.
#include <cmath>
#include <rapidcheck.h>

#include <gtest/gtest.h>

#include <extract/steps.hpp>

#include "extract/support.hpp"

namespace hexhex::test::samples {

namespace {

struct Case {
  SampleKind kind;
  SampleOptions options;
};

SampleOptions options(int cells, int refine, ChartStyle charts = ChartStyle::Aligned,
                      double jitter = 0, double onLattice = 0, double noise = 0,
                      double offset = 0) {
  SampleOptions o;
  o.cells = cells;
  o.refine = refine;
  o.charts = charts;
  o.jitter = jitter;
  o.onLattice = onLattice;
  o.noise = noise;
  o.offset = offset;
  return o;
}

void expectAnswer(const Sample& sample, const HexMesh& mesh) {
  EXPECT_EQ(mesh.cells.size(), sample.answer.expected.cells);
  EXPECT_EQ(mesh.points.size(), sample.answer.vertices);
}

class SampleExtraction : public ::testing::TestWithParam<SampleKind> {};

TEST_P(SampleExtraction, AgreesWithMapAndAnswer) {
  const SampleOptions list[] = {
      options(1, 1),                                        // one hex a block: all ties at once
      options(1, 5, ChartStyle::Random, 0.4),               // far fewer hexes than tets
      options(4, 4),                                        // tets aligned with the grid
      options(4, 2, ChartStyle::Random),                    // ... and vice versa
      options(5, 3, ChartStyle::Blocks, 0.3),               // generic position
      options(6, 3, ChartStyle::Random, 0.7, 0.6),          // degenerate and generic mixed
      options(6, 6, ChartStyle::Random, 0.5, 1.0),          // as degenerate as it gets
      options(4, 2, ChartStyle::Random, 0.3, 0.3, 1e-4),    // only approximately a map
      options(4, 2, ChartStyle::Random, 0.3, 0.3, 0, 1e9),  // charts far away
      options(12, 1, ChartStyle::Blocks, 0.2),              // 144 hexes a tet
  };
  for (const SampleOptions& o : list) {
    SCOPED_TRACE(::testing::Message() << nameOf(GetParam()) << " cells " << o.cells << " refine "
                                      << o.refine << " jitter " << o.jitter);
    const Sample sample = generateSample(GetParam(), o);
    expectAnswer(sample, verifiedExtraction(sample.map));
    if (o.charts == ChartStyle::Random) {
      expectAnswer(sample, verifiedExtraction(withChartsKept(sample.map)));
    }
  }
}

TEST_P(SampleExtraction, ChartsDoNotMatter) {
  SampleOptions o = options(4, 3, ChartStyle::Aligned, 0.3, 0.3);
  const HexMesh aligned = verifiedExtraction(generateSample(GetParam(), o).map);
  for (const ChartStyle style : {ChartStyle::Blocks, ChartStyle::Random, ChartStyle::Scattered}) {
    o.charts = style;
    const TetMap map = generateSample(GetParam(), o).map;
    EXPECT_TRUE(sameUpToNumbering(aligned, verifiedExtraction(map))) << nameOf(GetParam());
    const HexMesh inGivenCharts = verifiedExtraction(withChartsKept(map));
    EXPECT_TRUE(sameUpToNumbering(aligned, inGivenCharts)) << nameOf(GetParam());
  }
}

TEST_P(SampleExtraction, ScaleRefines) {
  const Sample sample = generateSample(GetParam(), options(2, 2, ChartStyle::Random, 0.3, 0.3));
  SampleOptions finer = options(2, 2, ChartStyle::Random, 0.3, 0.3);
  for (const int scale : {2, 3, 7}) {
    ExtractOptions extractOptions;
    extractOptions.scale = scale;
    const HexMesh mesh = verifiedExtraction(sample.map, extractOptions);
    finer.cells = 2 * scale;  // same blocks, same counts
    const SampleAnswer answer = generateSample(GetParam(), finer).answer;
    EXPECT_EQ(mesh.cells.size(), answer.expected.cells);
    EXPECT_EQ(mesh.points.size(), answer.vertices);
  }
}

TEST_P(SampleExtraction, ThreadsDoNotMatter) {
  const Sample sample =
      generateSample(GetParam(), options(7, 4, ChartStyle::Random, 0.4, 0.3, 1e-5));
  const HexMesh one = verifiedExtraction(sample.map, {}, 1);
  for (const int threads : {2, 3, 8}) {
    Context context(threads);
    EXPECT_TRUE(sameBits(one, extract(sample.map, {}, context))) << threads << " threads";
  }
}

TEST_P(SampleExtraction, EpsilonDoesNotMatter) {
  const Sample sample = generateSample(GetParam(), options(5, 3, ChartStyle::Random, 0.4, 0.4));
  const HexMesh usual = verifiedExtraction(sample.map);
  Context context;
  for (const double epsilon : {0.0, 1e-12, 1e-2, 1.0, 1e300, HUGE_VAL}) {
    extraction::EngineOptions o(ExtractOptions{.engine = Engine::Propeller});
    o.epsilon = epsilon;
    EXPECT_TRUE(sameBits(usual, extraction::extractWith(sample.map, o, context)))
        << "epsilon " << epsilon;
  }
}

std::string kindName(const ::testing::TestParamInfo<SampleKind>& info) {
  std::string name = nameOf(info.param);
  name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
  return name;
}

INSTANTIATE_TEST_SUITE_P(Kinds, SampleExtraction,
                         ::testing::Values(SampleKind::Box, SampleKind::Cylinder,
                                           SampleKind::Sphere, SampleKind::Star,
                                           SampleKind::Tetrahedron, SampleKind::Torus,
                                           SampleKind::Shell, SampleKind::HandleBody),
                         kindName);

TEST(Star, EveryValence) {
  for (int valence = 3; valence <= 12; ++valence) {
    SampleOptions o = options(3, 3, ChartStyle::Random, 0.4, 0.4);
    o.valence = valence;
    const Sample sample = generateSample(SampleKind::Star, o);
    SCOPED_TRACE(valence);
    expectAnswer(sample, verifiedExtraction(sample.map));
  }
}

/// Draws a map, logs the command that generates it, extracts and verifies.
void checkRandomSample() {
  const auto kinds = sampleKinds();
  const SampleKind kind = kinds[*rc::gen::inRange<std::size_t>(0, kinds.size())].kind;
  SampleOptions o;
  o.cells = *rc::gen::inRange(1, 8);
  o.refine = *rc::gen::inRange(1, 5);
  o.valence = *rc::gen::inRange(3, 13);
  o.charts = *rc::gen::element(ChartStyle::Aligned, ChartStyle::Blocks, ChartStyle::Random,
                               ChartStyle::Scattered);
  o.jitter = *rc::gen::element(0.0, 0.1, 0.5, 1.0);
  o.onLattice = *rc::gen::element(0.0, 0.2, 0.8, 1.0);
  o.noise = *rc::gen::element(0.0, 1e-9, 1e-5);
  o.offset = *rc::gen::element(0.0, 1e3, 1e9);
  o.seed = *rc::gen::inRange<std::uint64_t>(1, 1U << 30);
  constexpr const char* kCharts[] = {"aligned", "blocks", "random", "scattered"};
  RC_LOG() << "hexhex generate " << nameOf(kind) << " --cells " << o.cells << " --refine "
           << o.refine << " --valence " << o.valence << " --charts "
           << kCharts[static_cast<std::size_t>(o.charts)] << " --jitter " << o.jitter
           << " --on-lattice " << o.onLattice << " --noise " << o.noise << " --offset " << o.offset
           << " --seed " << o.seed << '\n';
  Sample sample = generateSample(kind, o);
  const bool areChartsKept = *rc::gen::arbitrary<bool>();
  RC_LOG() << (areChartsKept ? "with its charts kept\n" : "");
  if (areChartsKept) sample.map = withChartsKept(std::move(sample.map));
  ExtractOptions extractOptions;
  extractOptions.scale = *rc::gen::weightedElement<int>({{4, 1}, {1, 2}, {1, 3}});
  const HexMesh mesh = extract(sample.map, extractOptions);
  VerifyOptions verifyOptions;
  verifyOptions.scale = extractOptions.scale;
  const VerifyReport report = verify(sample.map, mesh, verifyOptions);
  RC_LOG() << failures(report) << '\n';
  RC_ASSERT(report.passed());
  Context threads(*rc::gen::inRange(1, 4));
  RC_ASSERT(sameBits(mesh, extract(sample.map, withOtherEngine(extractOptions), threads)));
  if (extractOptions.scale == 1) RC_ASSERT(mesh.points.size() == sample.answer.vertices);
}

/// Four maps a case, hence four hundred by default; seed and commands are printed on failure.
TEST(Property, RandomSamplesAreExtractedRight) {
  EXPECT_TRUE(rc::check("random samples are extracted right", [] {
    for (int i = 0; i < 4; ++i) checkRandomSample();
  }));
}

}  // namespace
}  // namespace hexhex::test::samples
