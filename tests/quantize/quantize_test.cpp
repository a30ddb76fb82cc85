// Quantization as a whole: whatever seamless map comes in, the map that comes out is an
// integer-grid map whose mesh is right.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <quantize/bend/edge_turns.hpp>
#include <quantize/complex/motorcycle_complex.hpp>
#include <quantize/quantized_map.hpp>
#include <quantize/seamless/seamless_map.hpp>
#include <rapidcheck/gtest.h>
#include <support/effort.hpp>

#include <hexhex/hexhex.hpp>

#include <lattice/rotation.hpp>

#include "extract/support.hpp"
#include "quantize/real_maps.hpp"
#include "support/error_of.hpp"
#include "support/scaled_map.hpp"

namespace hexhex::test {

using namespace quantization;

namespace {

/// A chart of its own for each tet.
TetMap withMovedCharts(TetMap map, std::uint64_t seed) {
  std::uint64_t state = seed;
  const auto next = [&state] {
    return (state = state * 6364136223846793005U + 1442695040888963407U) >> 33;
  };
  for (TetParameters& tet : map.parameters) {
    const lattice::Rotation rotation(static_cast<int>(next() % lattice::Rotation::kCount));
    const Vec3 move = {static_cast<double>(next() % 1000) / 7,
                       static_cast<double>(next() % 1000) / 7,
                       static_cast<double>(next() % 1000) / 7};
    for (Vec3& u : tet) {
      u = rotation(u);
      for (std::size_t k = 0; k < 3; ++k) u[k] += move[k];
    }
  }
  return map;
}

/// The map with all tets at an edge cut in two at its middle.
BentMap splitAt(const TetMap& map, const tetmap::VertexPair& edge) {
  BentMap bent;
  bent.points.assign(map.points.begin(), map.points.end());
  bent.splitEdges = {edge};
  const auto middle = static_cast<Index>(map.points.size());
  Vec3& point = bent.points.emplace_back();
  for (std::size_t k = 0; k < 3; ++k) {
    point[k] = (map.points[edge[0]][k] + map.points[edge[1]][k]) / 2;
  }
  for (Index t = 0; t < map.tets.size(); ++t) {
    const Tet& tet = map.tets[t];
    const auto placeOf = [&tet](Index v) {
      return std::find(tet.begin(), tet.end(), v) - tet.begin();
    };
    const auto a = static_cast<std::size_t>(placeOf(edge[0]));
    const auto b = static_cast<std::size_t>(placeOf(edge[1]));
    const bool isCut = a < 4 && b < 4;
    for (const std::size_t replaced : {a, b}) {
      Tet half = tet;
      TetParameters parameters = map.parameters[t];
      if (isCut) {
        half[replaced] = middle;
        for (std::size_t k = 0; k < 3; ++k) {
          parameters[replaced][k] = (map.parameters[t][a][k] + map.parameters[t][b][k]) / 2;
        }
      }
      bent.tets.push_back(half);
      bent.parameters.push_back(parameters);
      bent.parentTet.push_back(t);
      if (!isCut) break;
    }
  }
  bent.reference = bent.parameters;
  return bent;
}

tetmap::VertexPair firstSingularEdge(const TetMap& map, Context& context) {
  for (const auto& edge : findMapStructure(map, 0.01, context).singularEdges) {
    if (!edge.boundary) return {edge.vertex0, edge.vertex1};
  }
  throw Error(ErrorCode::InvalidArgument, "The map has no inner singular edge.");
}

TetMap withDigits(TetMap map, int digits) {
  for (TetParameters& tet : map.parameters) {
    for (Vec3& u : tet) {
      for (double& x : u) {
        std::ostringstream out;
        out.precision(digits);
        out << x;
        x = std::strtod(out.str().c_str(), nullptr);
      }
    }
  }
  return map;
}

QuantizeOptions cells(double number) {
  QuantizeOptions options;
  options.cells = number;
  return options;
}

QuantizeOptions sameScale() {
  QuantizeOptions options;
  options.scale = 1;
  return options;
}

/// Quantizes, checks without any tolerance, extracts and verifies.
QuantizedMap expectRightMesh(const TetMap& map, const QuantizeOptions& options) {
  QuantizedMap result = quantize(map, options);
  EXPECT_TRUE(check(result.map, {.tolerance = 0}).valid());
  ExtractOptions exact;
  exact.tolerance = 0;
  EXPECT_EQ(verifiedExtraction(result.map, exact).cells.size(), result.report.cells);
  return result;
}

SampleKind anyKind() {
  return sampleKinds()[*rc::gen::inRange<std::size_t>(0, sampleKinds().size())].kind;
}

RC_GTEST_PROP(Quantize, GivesAnIntegerGridMapItsIntegersBack, ()) {
  SampleOptions options;
  options.cells = *rc::gen::inRange(1, 6);
  options.jitter = *rc::gen::element(0.0, 0.3, 0.8);
  options.charts = *rc::gen::element(ChartStyle::Aligned, ChartStyle::Blocks, ChartStyle::Random);
  options.seed = *rc::gen::arbitrary<std::uint64_t>();
  const Sample sample = generateSample(anyKind(), options);
  const QuantizedMap result = expectRightMesh(sample.map, sameScale());
  const Expectation expected = check(result.map).expected;
  RC_ASSERT(expected.cells == sample.answer.expected.cells);
  RC_ASSERT(expected.boundaryQuads == sample.answer.expected.boundaryQuads);
  RC_ASSERT(expected.innerSingularEdges == sample.answer.expected.innerSingularEdges);
  RC_ASSERT(expected.boundarySingularEdges == sample.answer.expected.boundarySingularEdges);
  RC_ASSERT(result.report.addedTets == 0U);
}

RC_GTEST_PROP(Quantize, TakesAnySeamlessSample, ()) {
  SampleOptions options;
  options.cells = *rc::gen::inRange(2, 6);
  options.stretch = *rc::gen::element(0.1, 0.5, 0.9);
  options.charts = *rc::gen::element(ChartStyle::Aligned, ChartStyle::Blocks, ChartStyle::Random);
  options.noise = *rc::gen::element(0.0, 1e-9);
  options.seed = *rc::gen::arbitrary<std::uint64_t>();
  const Sample sample = generateSample(anyKind(), options);
  const QuantizedMap result = expectRightMesh(sample.map, sameScale());
  const CheckReport before = check(sample.map);
  const CheckReport after = check(result.map);
  // The same curves of the same valences, the same topology.
  const Expectation& known = sample.answer.expected;
  const auto valences = [](const auto& counts) {
    std::vector<int> list;
    for (const auto& [valence, count] : counts) list.push_back(valence);
    return list;
  };
  RC_ASSERT(valences(after.expected.innerSingularEdges) == valences(known.innerSingularEdges));
  RC_ASSERT(valences(after.expected.boundarySingularEdges) ==
            valences(known.boundarySingularEdges));
  RC_ASSERT(after.expected.eulerCharacteristic == known.eulerCharacteristic);
  RC_ASSERT(after.boundaryGenus == before.boundaryGenus);
}

RC_GTEST_PROP(Quantize, DoesNotCareForChartsAndOrder, ()) {
  SampleOptions options;
  options.jitter = *rc::gen::element(0.0, 0.5);
  options.seed = *rc::gen::arbitrary<std::uint64_t>();
  TetMap map = scaled(generateSample(anyKind(), options).map, 0.618);
  const std::uint64_t expected = expectRightMesh(map, sameScale()).report.cells;
  RC_ASSERT(quantize(withMovedCharts(map, options.seed), sameScale()).report.cells == expected);
  std::reverse(map.tets.begin(), map.tets.end());
  std::reverse(map.parameters.begin(), map.parameters.end());
  RC_ASSERT(quantize(map, sameScale()).report.cells == expected);
}

TEST(Quantize, KeepsCurvesWithSeveralFullTurns) {
  // Around them charts agree, so that nothing but their valence tells of them.
  for (const int valence : {8, 12}) {
    SampleOptions options;
    options.valence = valence;
    options.stretch = 0.5;
    options.noise = 1e-7;
    const TetMap map = generateSample(SampleKind::Star, options).map;
    const Expectation after = check(expectRightMesh(map, sameScale()).map).expected;
    ASSERT_EQ(after.innerSingularEdges.size(), 1U);
    EXPECT_EQ(after.innerSingularEdges.begin()->first, valence);
  }
}

TEST(Quantize, TakesTetsThatSeveralWallsCross) {
  HEXHEX_LARGE_TEST();
  // Few and badly shaped tets: walls of parallel planes cross the same edges.
  for (const SampleKindName& kind : sampleKinds()) {
    for (const double jitter : {0.8, 1.0}) {
      SCOPED_TRACE(std::string(kind.name) + ", jitter " + std::to_string(jitter));
      SampleOptions options;
      options.cells = 5;
      options.refine = 1;
      options.jitter = jitter;
      expectRightMesh(scaled(generateSample(kind.kind, options).map, 0.618), sameScale());
    }
  }
}

TEST(Quantize, DoesNotDependOnThreads) {
  const TetMap map = scaled(generateSample(SampleKind::Sphere, {.jitter = 0.5}).map, 0.7);
  Context one(1);
  Context two(2);
  const QuantizedMap a = quantize(map, sameScale(), one);
  const QuantizedMap b = quantize(map, sameScale(), two);
  EXPECT_EQ(a.map.parameters, b.map.parameters);
  EXPECT_EQ(a.map.tets, b.map.tets);
}

TEST(Quantize, KeepsFeaturesAndRegions) {
  SampleOptions options;
  options.features = true;
  options.jitter = 0.4;
  const Sample sample = generateSample(SampleKind::Cylinder, options);
  const QuantizedMap result = expectRightMesh(scaled(sample.map, 0.77), sameScale());
  const HexMesh mesh = extract(result.map);
  // As many curves as before, all of them on edges of the mesh; blocks as regions.
  std::map<std::int32_t, std::uint64_t> edges;
  for (const FeatureEdge& edge : mesh.features.edges) ++edges[edge.tag];
  EXPECT_EQ(edges.size(), sample.answer.features.edges.size());
  EXPECT_EQ(mesh.features.vertices.size(), sample.answer.features.vertices.size());
  EXPECT_EQ(mesh.regions.size(), mesh.cells.size());
  EXPECT_EQ(static_cast<std::uint64_t>(*std::max_element(mesh.regions.begin(), mesh.regions.end())),
            sample.answer.features.regions);
}

TEST(Quantize, TagsAndSingularEdgesGoToBothHalvesOfASplitEdge) {
  SampleOptions options;
  options.features = true;
  const TetMap map = generateSample(SampleKind::Cylinder, options).map;
  Context context;
  const CheckReport before = check(map);
  ASSERT_FALSE(before.expected.innerSingularEdges.empty());
  for (const tetmap::VertexPair edge :
       {map.features.edges.front().vertices, firstSingularEdge(map, context)}) {
    BentMap bent = splitAt(map, edge);
    const SeamlessMap seamless = makeSeamless(map, {1e-5, 1e-5}, context);
    const IrregularEdges irregular =
        irregularEdges(adjacency::EdgeFans(seamless.topology), seamless.topology.tets,
                       std::span<const lattice::LatticeTet>(seamless.corners));
    const QuantizedMap result = finishQuantization({bent, irregular, {}}, map, context);
    const Expectation after = check(result.map).expected;
    EXPECT_EQ(after.cells, before.expected.cells);
    EXPECT_EQ(after.innerSingularEdges, before.expected.innerSingularEdges);
    EXPECT_EQ(after.boundarySingularEdges, before.expected.boundarySingularEdges);
    const HexFeatures whole = extract(map).features;
    const HexFeatures split = extract(result.map).features;
    EXPECT_EQ(split.edges.size(), whole.edges.size());
    EXPECT_EQ(split.quads.size(), whole.quads.size());
    EXPECT_GT(result.map.features.edges.size() + result.map.features.faces.size(),
              map.features.edges.size() + map.features.faces.size());
  }
}

TEST(Quantize, RefusesOptionsThatMakeNoSense) {
  const TetMap map = generateSample(SampleKind::Box).map;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const QuantizeOptions& options :
       {QuantizeOptions{}, QuantizeOptions{.cells = -1}, QuantizeOptions{.cells = nan},
        QuantizeOptions{.cells = 10, .scale = 1}, QuantizeOptions{.scale = 1, .tolerance = 2}}) {
    EXPECT_EQ(codeOf([&] { static_cast<void>(quantize(map, options)); }),
              ErrorCode::InvalidArgument);
  }
  EXPECT_EQ(codeOf([&] { static_cast<void>(quantize(map, cells(1e12))); }), ErrorCode::TooLarge);
}

TEST(Quantize, RefusesMapsThatAreNotSeamless) {
  TetMap noisy = generateSample(SampleKind::Sphere, {.noise = 0.005}).map;
  EXPECT_EQ(codeOf([&] { static_cast<void>(quantize(noisy, sameScale())); }),
            ErrorCode::TransitionResidual);
  const TetMap flipped =
      generateSample(SampleKind::Sphere, {.cells = 8, .refine = 6, .defects = 5}).map;
  EXPECT_EQ(codeOf([&] { static_cast<void>(quantize(flipped, sameScale())); }),
            ErrorCode::FlippedTet);
  EXPECT_EQ(codeOf([&] { static_cast<void>(quantize(TetMap{}, sameScale())); }),
            ErrorCode::EmptyMesh);
}

TEST(Quantize, TellsSeamlessMapsFromOthers) {
  Context context;
  const auto kindOf = [&](const TetMap& map) { return examineSeamless(map, context).kind; };
  EXPECT_EQ(kindOf(generateSample(SampleKind::Torus, {.stretch = 0.5}).map),
            SeamlessKind::Seamless);
  EXPECT_EQ(kindOf(generateSample(SampleKind::Torus, {.noise = 0.005}).map),
            SeamlessKind::AlmostSeamless);
  TetMap wild = generateSample(SampleKind::Torus).map;
  for (TetParameters& tet : wild.parameters) tet[1][0] += 3 * std::sin(tet[0][1] + tet[2][2]);
  EXPECT_EQ(kindOf(wild), SeamlessKind::Neither);
}

TEST(Quantize, FindsTheFactorOfMapsThatAreIntegerUpToAScale) {
  Context context;
  const TetMap whole = generateSample(SampleKind::Shell, {.cells = 1}).map;
  for (const double scale : {1.0 / 3, 0.25, 0.618}) {
    EXPECT_NEAR(examineSeamless(scaled(whole, scale), context).integerFactor, 1 / scale, 1e-5)
        << scale;
  }
  const TetMap stretched = generateSample(SampleKind::Torus, {.stretch = 0.5}).map;
  EXPECT_EQ(examineSeamless(stretched, context).integerFactor, 0);
}

TEST(MotorcycleComplex, ConsistsOfBoxes) {
  for (const SampleKindName& kind : sampleKinds()) {
    SCOPED_TRACE(kind.name);
    Context context;
    const TetMap map = generateSample(kind.kind, {.charts = ChartStyle::Random, .jitter = 0.6}).map;
    const SeamlessMap seamless = makeSeamless(map, {1e-6, 0, 0}, context);
    for (const bool reduced : {false, true}) {
      // That blocks are boxes is proven inside, by their volumes.
      const MotorcycleComplex complex = traceComplex(seamless, reduced, context);
      for (const PatchSide& patch : complex.patches) {
        std::array<std::int64_t, 3> sum{};
        for (const ArcSide& side : patch.border) {
          sum[side.axis] += side.sign * complex.arcs[side.arc].length;
        }
        EXPECT_EQ(sum, (std::array<std::int64_t, 3>{}));
      }
    }
  }
}

TEST(Quantize, NamesEachAttempt) {
  std::vector<std::string> stages;
  Context context(
      1, [&stages](std::string_view stage, double /*share*/) { stages.emplace_back(stage); });
  const TetMap map = generateSample(SampleKind::Sphere, {.stretch = 0.5}).map;
  const QuantizeReport report = quantize(map, sameScale(), context).report;
  const std::string first = "bending 1 of at most 40: " + std::to_string(report.cells) +
                            " cells in " + std::to_string(report.blocks) + " blocks";
  const auto isFirst = [&](const std::string& stage) { return stage.starts_with(first); };
  EXPECT_TRUE(std::any_of(stages.begin(), stages.end(), isFirst)) << first;
}

std::filesystem::path dataFolder() {
  const char* chosen = std::getenv("HEXHEX_DATA");
  return chosen != nullptr ? chosen : HEXHEX_DATA_DIR;
}

TEST(QuantizeRealMaps, ThatHaveFaultsAreRefusedForThese) {
  const std::filesystem::path folder = dataFolder() / "seamless-faults";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real maps";
  const auto error = [&](const std::string& name, double number) {
    const TetMap map = readMap(folder / (name + ".hexex"));
    return errorOf([&] { static_cast<void>(quantize(map, cells(number))); });
  };
  for (const std::string name :
       {"compound_s10c_cyl_cutsphere", "compound_s14c_cube_corner_sub_sphere"}) {
    const Error diagonal = error(name, 1000);
    EXPECT_EQ(diagonal.place().kind, PlaceKind::Edge);
    EXPECT_NE(std::string(diagonal.what()).find("parallel to no axis"), std::string::npos)
        << diagonal.what();
  }
  const Error flipped = error("notch_12_flips", 1000);
  EXPECT_EQ(flipped.code(), ErrorCode::FlippedTet);
  EXPECT_NE(std::string(flipped.what()).find("Found 12 times"), std::string::npos)
      << flipped.what();
  const std::string bent = error("two_components_flipped_block", 4.32).what();
  unsigned block = 0;
  unsigned blocks = 0;
  const std::size_t at = bent.find("in block ");
  ASSERT_NE(at, std::string::npos) << bent;
  ASSERT_EQ(std::sscanf(bent.c_str() + at, "in block %u of %u", &block, &blocks), 2) << bent;
  EXPECT_GE(block, 1U);
  EXPECT_LE(block, blocks);
  // What it says works does.
  unsigned works = 0;
  const std::size_t after = bent.find(" cells work");
  ASSERT_NE(after, std::string::npos) << bent;
  const std::size_t before = bent.rfind(". ", after);
  ASSERT_EQ(std::sscanf(bent.c_str() + before, ". %u cells work", &works), 1) << bent;
  const TetMap map = readMap(folder / "two_components_flipped_block.hexex");
  EXPECT_EQ(quantize(map, cells(works)).report.cells, works);
}

TEST(QuantizeRealMaps, WithWallsNearVertices) {
  HEXHEX_LARGE_TEST();
  const std::filesystem::path file = dataFolder() / "seamless-faults" / "hand.hexex";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no real maps";
  for (const double number : {1000, 5000}) expectRightMesh(readMap(file), cells(number));
}

TEST(QuantizeRealMaps, AtAllDensities) {
  if (realMaps().empty()) GTEST_SKIP() << "no real maps";
  for (const std::filesystem::path& file : realMaps()) {
    const TetMap map = readMap(file);
    for (const double density : {0.01, 0.1, 1.0, 10.0}) {
      SCOPED_TRACE(file.stem().string() + " at " + std::to_string(density));
      const double wanted = density * static_cast<double>(map.tets.size());
      const QuantizeReport report = expectRightMesh(map, cells(wanted)).report;
      const double ratio = static_cast<double>(report.cells) / wanted;
      // At the lowest density, some curves are longer than that with one cell each.
      if (density >= 0.1) {
        EXPECT_LT(std::max(ratio, 1 / ratio), density < 1 ? 2 : 1.25);
      }
      EXPECT_LE(static_cast<double>(report.addedTets), 0.2 * static_cast<double>(map.tets.size()));
    }
  }
}

TEST(QuantizeRealMaps, WithFewDigitsAndOtherCharts) {
  if (realMaps().empty()) GTEST_SKIP() << "no real maps";
  for (const std::filesystem::path& file : realMaps()) {
    SCOPED_TRACE(file.stem().string());
    const TetMap map = readMap(file);
    const auto wanted = static_cast<double>(map.tets.size());
    expectRightMesh(withDigits(map, 6), cells(wanted));
    expectRightMesh(withMovedCharts(map, 7), cells(wanted));
  }
}

}  // namespace

}  // namespace hexhex::test
