#include "campaign/examination.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include <io/io_test_support.hpp>

#include "curved/same_arcs.hpp"
#include "extract/support.hpp"
#include "support/collecting_sink.hpp"
#include "support/error_of.hpp"
#include "support/scaled_map.hpp"

namespace hexhex::campaign {

using namespace test;

namespace {

void expectSame(const Expectation& found, const Expectation& wanted) {
  EXPECT_EQ(found.cells, wanted.cells);
  EXPECT_EQ(found.boundaryQuads, wanted.boundaryQuads);
  EXPECT_EQ(found.innerSingularEdges, wanted.innerSingularEdges);
  EXPECT_EQ(found.boundarySingularEdges, wanted.boundarySingularEdges);
  EXPECT_EQ(found.eulerCharacteristic, wanted.eulerCharacteristic);
  EXPECT_EQ(found.components, wanted.components);
  EXPECT_EQ(found.boundaryComponents, wanted.boundaryComponents);
}

/// Numbers of elements by tag.
template <class Elements>
std::map<std::int32_t, std::uint64_t> countsByTag(const Elements& elements) {
  std::map<std::int32_t, std::uint64_t> counts;
  for (const auto& element : elements) ++counts[element.tag];
  return counts;
}

void expectAnswer(const SampleAnswer& answer, const TetMap& map, const HexMesh& mesh) {
  const CheckReport report = check(map);
  EXPECT_TRUE(report.valid()) << (report.valid() ? "" : report.defects[0].sentence);
  expectSame(report.expected, answer.expected);
  EXPECT_EQ(mesh.points.size(), answer.vertices);
  EXPECT_EQ(mesh.cells.size(), answer.expected.cells);
  if (answer.features.regions == 0) return;
  EXPECT_EQ(countsByTag(mesh.features.vertices), answer.features.vertices);
  EXPECT_EQ(countsByTag(mesh.features.edges), answer.features.edges);
  EXPECT_EQ(countsByTag(mesh.features.quads), answer.features.quads);
}

void expectSameWithTags(const HexMesh& found, const HexMesh& wanted) {
  EXPECT_TRUE(sameBits(found, wanted));
  EXPECT_EQ(found.features, wanted.features);
  EXPECT_EQ(found.regions, wanted.regions);
}

int drawThreads(Random& random) { return static_cast<int>(2 + random.below(3)); }

/// The ways to extract one mesh: engines, threads, in pieces, prepared.
void expectSameInAllWays(const TetMap& map, const ExtractOptions& options, const HexMesh& mesh,
                         Random& random) {
  Context one(1);
  expectSameWithTags(extract(map, withOtherEngine(options), one), mesh);
  Context several(drawThreads(random));
  ExtractOptions either = options;
  either.engine = random.below(2) == 0 ? Engine::Atlas : Engine::Propeller;
  expectSameWithTags(extract(map, either, several), mesh);
  CollectingSink sink;
  extractTo(sink, map, options, several);
  EXPECT_TRUE(sink.ended);
  EXPECT_TRUE(sameBits(sink.mesh, mesh));
  Extractor extractor(map, {}, several);
  expectSameWithTags(extractor.extract(options, several), mesh);
}

void verifyAll(const TetMap& map, const HexMesh& mesh, int scale) {
  VerifyOptions options;
  options.scale = scale;
  options.countElements = true;
  const VerifyReport report = verify(map, mesh, options);
  EXPECT_TRUE(report.passed()) << failures(report);
}

/// A mesh with two vertices of a cell exchanged is another one.
void expectDamageIsSeen(const TetMap& map, HexMesh mesh, int scale, Random& random) {
  Hex& cell = mesh.cells[random.below(mesh.cells.size())];
  const std::size_t a = random.below(8);
  std::swap(cell[a], cell[(a + 1 + random.below(7)) % 8]);
  VerifyOptions options;
  options.scale = scale;
  EXPECT_FALSE(verify(map, mesh, options).passed());
}

/// A format of those for which `fits` holds.
template <class Fits>
const FileFormat& drawFormat(const Fits& fits, Random& random) {
  std::vector<const FileFormat*> formats;
  for (const FileFormat& format : fileFormats()) {
    if (fits(format)) formats.push_back(&format);
  }
  return *formats[random.below(formats.size())];
}

WriteOptions drawWriting(const FileFormat& format, Random& random) {
  WriteOptions writing;
  writing.format = format.name;
  if (format.compresses && random.below(2) == 0) writing.compress = Compression::Zlib;
  return writing;
}

void sendMapThroughFile(const TetMap& map, Random& random, const std::filesystem::path& file) {
  const FileFormat& format =
      drawFormat([](const FileFormat& f) { return f.readsMaps && f.writesMaps; }, random);
  SCOPED_TRACE("a map as " + std::string(format.name));
  ReadOptions reading;
  reading.format = format.name;
  const WriteOptions writing = drawWriting(format, random);
  Context context(drawThreads(random));
  writeMap(map, file, writing, context);
  const TetMap read = readMap(file, reading, context);
  expectSameBits(read.points, map.points);
  EXPECT_EQ(read.tets, map.tets);
  ASSERT_EQ(read.parameters.size(), map.parameters.size());
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    expectSameBits(read.parameters[t], map.parameters[t]);
  }
}

void expectMeshInFile(const HexMesh& mesh, const FileFormat& format, Context& context,
                      const std::filesystem::path& file) {
  ReadOptions reading;
  reading.format = format.name;
  const HexMesh read = readHexMesh(file, reading, context);
  expectSameBits(read.points, mesh.points);
  // Some formats list cells by region.
  EXPECT_TRUE(!mesh.regions.empty() || read.cells == mesh.cells);
}

void sendMeshThroughFile(const HexMesh& mesh, Random& random, const std::filesystem::path& file) {
  const FileFormat& format = drawFormat(
      [](const FileFormat& f) {
        // Numbers in .inp files are cut off at 20 characters; OpenFOAM's are folders of faces.
        return f.readsHexMeshes && f.writesHexMeshes && f.name != "inp" && f.name != "openfoam";
      },
      random);
  SCOPED_TRACE("a mesh as " + std::string(format.name));
  const WriteOptions writing = drawWriting(format, random);
  Context context(drawThreads(random));
  writeHexMesh(mesh, file, writing, context);
  expectMeshInFile(mesh, format, context, file);
}

/// Extracts into a file.
void streamIntoFile(const TetMap& map, const ExtractOptions& options, HexMesh mesh, Random& random,
                    const std::filesystem::path& file) {
  const FileFormat& format =
      drawFormat([](const FileFormat& f) { return f.streams && f.readsHexMeshes; }, random);
  SCOPED_TRACE("a stream as " + std::string(format.name));
  WriteOptions writing;
  writing.format = format.name;
  Context context(drawThreads(random));
  extractTo(*openMeshSink(file, writing, context), map, options, context);
  mesh.regions = {};
  expectMeshInFile(mesh, format, context, file);
}

void expectSameCurves(const TetMap& map, const ExtractOptions& options, const HexMesh& mesh,
                      Random& random) {
  Context one(1);
  Context several(drawThreads(random));
  const PiecewiseLinearMesh a =
      extractPiecewiseLinear(map, PiecewiseLinearParts::ArcsAndPatches, options, one);
  const PiecewiseLinearMesh b = extractPiecewiseLinear(map, PiecewiseLinearParts::ArcsAndPatches,
                                                       withOtherEngine(options), several);
  EXPECT_TRUE(sameBits(a.mesh, mesh));
  EXPECT_TRUE(sameBits(b.mesh, mesh));
  expectSameBits(a.arcs, b.arcs);
  EXPECT_EQ(a.patches.vertices, b.patches.vertices);
  EXPECT_EQ(a.patches.polygonBegin, b.patches.polygonBegin);
  EXPECT_EQ(a.patches.corners, b.patches.corners);
  EXPECT_EQ(a.patches.parameters, b.patches.parameters);
  EXPECT_EQ(a.patches.points, b.patches.points);
  const LagrangeMesh lagrange = extractLagrange(map, 2, options, several);
  EXPECT_TRUE(sameBits(straightMesh(lagrange), mesh));
  EXPECT_EQ(lagrange.points, extractLagrange(map, 2, options, one).points);
}

template <class Counts>
std::vector<int> valences(const Counts& counts) {
  std::vector<int> found;
  for (const auto& [valence, count] : counts) {
    if (count > 0) found.push_back(valence);
  }
  return found;
}

/// The map at a scale that makes it seamless instead of integer, quantized, with one thread as with
/// several: its curves and topology stay, and its mesh is right.
void expectQuantized(const SampleAnswer& answer, const TetMap& integerMap, Random& random,
                     ExaminedSizes& sizes) {
  constexpr std::array<double, 4> kFactors = {1, 0.618, 1.414, 2.2};
  const TetMap map = scaled(integerMap, kFactors[random.below(kFactors.size())]);
  QuantizeOptions options;
  options.scale = 1;
  options.densify = true;
  options.tolerance = 1e-4;  // for the noise of some samples
  Context one(1);
  Context several(drawThreads(random));
  QuantizedMap quantized;
  const auto begin = std::chrono::steady_clock::now();
  try {
    quantized = quantize(map, options, one);
    sizes.isQuantized = true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::FlippedTet) << error.what();
    sizes.notQuantized = error.what();
  }
  sizes.quantizationSeconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!sizes.isQuantized) return;
  const TetMap same = quantize(map, options, several).map;
  EXPECT_EQ(same.tets, quantized.map.tets);
  EXPECT_EQ(same.parameters, quantized.map.parameters);
  const CheckReport report = check(quantized.map, {.tolerance = 0});
  EXPECT_TRUE(report.valid()) << report.defects[0].sentence;
  EXPECT_EQ(report.expected.cells, quantized.report.cells);
  EXPECT_EQ(report.expected.components, answer.expected.components);
  EXPECT_EQ(report.expected.eulerCharacteristic, answer.expected.eulerCharacteristic);
  EXPECT_EQ(report.expected.boundaryComponents, answer.expected.boundaryComponents);
  EXPECT_EQ(valences(report.expected.innerSingularEdges),
            valences(answer.expected.innerSingularEdges));
  EXPECT_EQ(valences(report.expected.boundarySingularEdges),
            valences(answer.expected.boundarySingularEdges));
  verifyAll(quantized.map, extract(quantized.map, {.tolerance = 0}, several), 1);
}

/// Mostly 1, and such that there are few cells, but for one map in a hundred.
int drawScale(std::uint64_t cells, Random& random) {
  constexpr std::array<std::uint64_t, 6> kScales = {1, 1, 1, 1, 2, 3};
  const std::uint64_t scale = kScales[random.below(kScales.size())];
  const std::uint64_t most = random.below(100) == 0 ? 20000 : 800;
  return cells * scale * scale * scale <= most ? static_cast<int>(scale) : 1;
}

}  // namespace

ExaminedSizes examine(const DrawnMap& drawn, Random& random, std::uint64_t quantizedOneIn,
                      const std::filesystem::path& folder) {
  const TetMap& map = drawn.map;
  if (!drawn.answer) {
    const ErrorCode code = codeOf([&] { static_cast<void>(extract(map)); });
    EXPECT_TRUE(code == ErrorCode::NonManifoldEdge || code == ErrorCode::NonManifoldVertex)
        << name(code);
    return {map.tets.size(), 0};
  }
  ExtractOptions options;
  options.scale = drawScale(drawn.answer->expected.cells, random);
  Context one(1);
  const HexMesh mesh = extract(map, options, one);
  verifyAll(map, mesh, options.scale);
  if (options.scale == 1) expectAnswer(*drawn.answer, map, mesh);
  expectSameInAllWays(map, options, mesh, random);
  expectDamageIsSeen(map, mesh, options.scale, random);

  // Files and curves take longer than all of the above.
  const std::filesystem::path file = folder / "file";
  if (random.below(3) == 0) sendMapThroughFile(map, random, file);
  if (random.below(3) == 0) sendMeshThroughFile(mesh, random, file);
  if (random.below(3) == 0) streamIntoFile(map, options, mesh, random, file);
  if (mesh.cells.size() < 1000 && map.tets.size() < 2000 && random.below(6) == 0) {
    expectSameCurves(map, options, mesh, random);
  }
  ExaminedSizes sizes{map.tets.size(), mesh.cells.size()};
  if (quantizedOneIn > 0 && canQuantize() && map.tets.size() < 1000 &&
      random.below(quantizedOneIn) == 0) {
    expectQuantized(*drawn.answer, map, random, sizes);
  }
  return sizes;
}

}  // namespace hexhex::campaign
