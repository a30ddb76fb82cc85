// One prepared map, several meshes.
#include <stdexcept>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace hexhex {
namespace {

bool sameBits(const HexMesh& a, const HexMesh& b) {
  return a.points == b.points && a.cells == b.cells && a.generatorTet == b.generatorTet &&
         a.generatorCorners == b.generatorCorners;
}

TetMap sampleMap(ChartStyle charts) {
  SampleOptions options;
  options.charts = charts;
  options.jitter = 0.3;
  options.noise = 1e-4;
  return generateSample(SampleKind::Sphere, options).map;
}

TEST(Extractor, GivesTheSameBitsAsExtractAtEveryScaleInAnyOrder) {
  for (const ChartStyle charts : {ChartStyle::Aligned, ChartStyle::Random}) {
    const TetMap map = sampleMap(charts);
    Extractor extractor(map);
    EXPECT_EQ(extractor.cellsAtScaleOne(), 448U);
    for (const Engine engine : {Engine::Atlas, Engine::Propeller}) {
      for (const int scale : {3, 1, 2, 2, 1}) {
        SCOPED_TRACE(scale);
        ExtractOptions options;
        options.engine = engine;
        options.scale = scale;
        Context first;
        Context second;
        ExtractStatistics expected;
        ExtractStatistics found;
        const HexMesh mesh = extractor.extract(options, first, &found);
        EXPECT_TRUE(sameBits(mesh, extract(map, options, second, &expected)));
        EXPECT_EQ(found.chartJumps, expected.chartJumps);
        EXPECT_EQ(found.maxDisplacement, expected.maxDisplacement);
        EXPECT_EQ(found.vertices, expected.vertices);
        EXPECT_EQ(found.singularEdges, expected.singularEdges);
      }
    }
  }
}

TEST(Extractor, GivesOtherOrdersAndOutputsLikeTheFunctions) {
  for (const ChartStyle charts : {ChartStyle::Random, ChartStyle::Aligned}) {
    if (charts == ChartStyle::Aligned && test::effort() < test::kEffortOfLargeTests) break;
    const TetMap map = sampleMap(charts);
    Extractor extractor(map);
    Context context;
    // The first call leaves the working copy scaled, without an unscaled one beside it yet.
    for (const auto& [order, scale] : {std::pair{3, 1}, {2, 2}, {1, 1}, {3, 1}}) {
      const ExtractOptions options{.scale = scale};
      const LagrangeMesh found = extractor.extractLagrange(order, options, context);
      const LagrangeMesh expected = extractLagrange(map, order, options, context);
      EXPECT_EQ(found.points, expected.points);
      EXPECT_EQ(found.nodes, expected.nodes);
      EXPECT_EQ(found.generatorCorners, expected.generatorCorners);
      EXPECT_TRUE(sameBits(extractor.extract(options, context), extract(map, options)));
      const auto parts = PiecewiseLinearParts::ArcsAndPatches;
      const auto pieces = extractor.extractPiecewiseLinear(parts, options, context);
      const auto expectedPieces = extractPiecewiseLinear(map, parts, options, context);
      EXPECT_EQ(pieces.arcs.points, expectedPieces.arcs.points);
      EXPECT_EQ(pieces.patches.corners, expectedPieces.patches.corners);
    }
    EXPECT_EQ(test::codeOf(
                  [&] { static_cast<void>(extractor.extractLagrange(2, {.scale = 33}, context)); }),
              ErrorCode::InvalidArgument);
    EXPECT_EQ(test::codeOf([&] { static_cast<void>(extractor.extractLagrange(10, {}, context)); }),
              ErrorCode::InvalidArgument);
  }
}

TEST(Extractor, VerifiesMeshesOfAllScalesAsTheFunctionDoes) {
  const TetMap map = sampleMap(ChartStyle::Random);
  Extractor extractor(map);
  Context context;
  for (const int scale : {2, 1, 3}) {
    SCOPED_TRACE(scale);
    HexMesh mesh = extractor.extract(scale);
    VerifyOptions options;
    options.scale = scale;
    EXPECT_TRUE(extractor.verify(mesh, options, context).passed());
    std::swap(mesh.points[1], mesh.points[2]);
    const VerifyReport found = extractor.verify(mesh, options, context);
    const VerifyReport expected = verify(map, mesh, options, context);
    EXPECT_FALSE(found.passed());
    ASSERT_EQ(found.items.size(), expected.items.size());
    for (std::size_t i = 0; i < found.items.size(); ++i) {
      EXPECT_EQ(found.items[i].name, expected.items[i].name);
      EXPECT_EQ(found.items[i].expected, expected.items[i].expected);
      EXPECT_EQ(found.items[i].found, expected.items[i].found);
      EXPECT_EQ(found.items[i].passed, expected.items[i].passed);
    }
  }
}

TEST(Extractor, IsUsableAfterACancellationInTheMiddleOfScaling) {
  const TetMap map = sampleMap(ChartStyle::Random);
  Extractor extractor(map);
  ExtractOptions options;
  options.scale = 3;
  // Ends at the first report of every stage, the scaling among them.
  for (const std::string stage : {"scaling", "sweep", "cells"}) {
    Context stopped(1, [&](std::string_view name, double) {
      if (name == stage) throw std::runtime_error("enough");
    });
    EXPECT_THROW(static_cast<void>(extractor.extract(options, stopped)), std::runtime_error);
    Context context;
    EXPECT_TRUE(sameBits(extractor.extract(2), extract(map, {.scale = 2}))) << stage;
    EXPECT_TRUE(sameBits(extractor.extract(options, context), extract(map, options))) << stage;
  }
}

TEST(Extractor, RefusesScalesThatItWasNotMadeFor) {
  const TetMap map = sampleMap(ChartStyle::Aligned);
  Extractor extractor(map, {.maxScale = 4});
  for (const int scale : {-1, 0, 5}) {
    try {
      static_cast<void>(extractor.extract(scale));
      FAIL() << scale;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    }
  }
  EXPECT_EQ(extractor.extract(4).cells.size(), 64 * extractor.cellsAtScaleOne());
}

TEST(Extractor, ThrowsDefectsAtOnce) {
  TetMap map = sampleMap(ChartStyle::Aligned);
  map.parameters[7][0] = map.parameters[7][1];
  try {
    const Extractor extractor(map);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::FlippedTet);
  }
}

TEST(Extractor, Streams) {
  const TetMap map = sampleMap(ChartStyle::Random);
  Extractor extractor(map);
  ExtractOptions options;
  options.scale = 2;
  Context context;
  SummarySink sink(context);
  extractor.extractTo(sink, options, context);
  Context other;
  EXPECT_EQ(sink.result(), summarize(extract(map, options), other));
}

}  // namespace
}  // namespace hexhex
