// Every format that is read and written, and every pair of them: what one of them held, bit for
// bit, is what the other gives back.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/compressions.hpp>
#include <support/effort.hpp>

#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>
#include <hexhex/summary.hpp>

#include <io/io_test_support.hpp>

namespace hexhex::test {
namespace {

/// One way to write files, all of which hold the same.
struct Way {
  std::string format;
  Compression compress = Compression::None;

  [[nodiscard]] WriteOptions writing() const {
    WriteOptions options;
    options.format = format;
    options.compress = compress;
    return options;
  }
  [[nodiscard]] ReadOptions reading() const {
    ReadOptions options;
    options.format = format;
    return options;
  }
};

std::vector<Way> waysOf(bool (*fits)(const FileFormat&)) {
  std::vector<Way> ways;
  for (const FileFormat& format : fileFormats()) {
    if (!fits(format)) continue;
    for (const Compression how : compressions()) {
      if (how != Compression::None && !format.compresses) continue;
      ways.push_back({std::string(format.name), how});
    }
  }
  return ways;
}

std::vector<Way> mapWays() {
  return waysOf([](const FileFormat& format) { return format.readsMaps && format.writesMaps; });
}

std::vector<Way> meshWays() {
  return waysOf([](const FileFormat& format) {
    // Abaqus reads 20 characters of a number: not all come back to the bit. OpenFOAM's folders hold
    // faces, without an order of a cell's corners.
    return format.readsHexMeshes && format.writesHexMeshes && format.name != "inp" &&
           format.name != "openfoam";
  });
}

void expectSameMaps(const TetMap& a, const TetMap& b) {
  expectSameBits(a.points, b.points);
  EXPECT_EQ(a.tets, b.tets);
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  for (std::size_t t = 0; t < a.parameters.size(); ++t) {
    expectSameBits(a.parameters[t], b.parameters[t]);
  }
}

void expectSameMeshes(const HexMesh& a, const HexMesh& b) {
  expectSameBits(a.points, b.points);
  EXPECT_EQ(a.cells, b.cells);
}

std::vector<TetMap> maps() {
  std::vector<TetMap> result;
  for (const SampleKind kind : {SampleKind::Sphere, SampleKind::Star, SampleKind::Torus}) {
    SampleOptions options;
    options.cells = 2;
    options.refine = 1;
    options.charts = kind == SampleKind::Star ? ChartStyle::Aligned : ChartStyle::Random;
    options.jitter = 0.3;
    options.noise = 1e-4;
    options.offset = kind == SampleKind::Torus ? 1e6 : 0;
    result.push_back(generateSample(kind, options).map);
  }
  return result;
}

/// The same with numbers that are easily lost.
std::vector<TetMap> oddMaps() {
  std::vector<TetMap> result = maps();
  for (TetMap& map : result) {
    map.points[0] = {-0.0, 5e-324, 1e300};
    map.parameters[1][2] = {-0.0, 0.1, 1.0 / 3};
  }
  return result;
}

/// Writes, and reads what was written.
TetMap through(const Way& way, const TetMap& map, const std::filesystem::path& file) {
  Context context(2);
  writeMap(map, file, way.writing(), context);
  return readMap(file, way.reading(), context);
}
HexMesh through(const Way& way, const HexMesh& mesh, const std::filesystem::path& file) {
  Context context(2);
  writeHexMesh(mesh, file, way.writing(), context);
  return readHexMesh(file, way.reading(), context);
}

TEST(RoundTrips, MapsThroughEveryPairOfFormats) {
  const std::vector<Way> ways = mapWays();
  EXPECT_GE(ways.size(), 6U);
  const TemporaryFolder folder;
  for (const TetMap& map : oddMaps()) {
    for (const Way& first : ways) {
      const TetMap between = through(first, map, folder / "a");
      for (const Way& second : ways) {
        SCOPED_TRACE(first.format + " to " + second.format);
        expectSameMaps(through(second, between, folder / "b"), map);
      }
    }
  }
}

/// Puts the mark in front that editors of Windows write.
void addByteOrderMark(const std::filesystem::path& file) {
  writeText(file, "\xef\xbb\xbf" + contentOf(file));
}

/// Whether files of a format are text, which the mark may precede.
bool isText(const Way& way) {
  return way.format != "meshb" && way.format != "ovmb" && way.format != "vtk-binary" &&
         way.format != "msh" && way.format != "cgns" && way.format != "vtkhdf" &&
         !way.format.starts_with("exodus");
}

TEST(RoundTrips, OfTextsWithAByteOrderMark) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a";
  Context context(2);
  const TetMap map = maps()[0];
  // More than the head by which large files of other kinds are told.
  const HexMesh mesh = gridMesh(20, 20, 20);
  for (const Way& way : mapWays()) {
    if (!isText(way)) continue;
    SCOPED_TRACE(way.format);
    writeMap(map, file, way.writing(), context);
    addByteOrderMark(file);
    expectSameMaps(readMap(file, way.reading(), context), map);
  }
  for (const Way& way : meshWays()) {
    if (!isText(way)) continue;
    SCOPED_TRACE(way.format);
    writeHexMesh(mesh, file, way.writing(), context);
    addByteOrderMark(file);
    ASSERT_GT(std::filesystem::file_size(file), 1U << 16);
    expectSameMeshes(readHexMesh(file, way.reading(), context), mesh);
    SummarySink sink(context);
    readHexMeshTo(sink, file, way.reading(), context);
    EXPECT_EQ(sink.result().cellChecksum, summarize(mesh, context).cellChecksum);
  }
  const std::filesystem::path mfem = folder / "a.mesh";  // known by its first word
  WriteOptions options;
  options.format = "mfem";
  writeHexMesh(mesh, mfem, options, context);
  addByteOrderMark(mfem);
  expectSameMeshes(readHexMesh(mfem), mesh);
}

TEST(RoundTrips, HexMeshesThroughEveryPairOfFormats) {
  const std::vector<Way> ways = meshWays();
  EXPECT_GE(ways.size(), 10U);
  const TemporaryFolder folder;
  std::vector<HexMesh> meshes;
  for (const TetMap& map : maps()) {
    meshes.push_back(extract(map));
  }
  meshes[0].points[3] = {-0.0, 5e-324, 1e300};
  meshes.push_back(gridMesh(3, 2, 2));
  // One mesh of large numbers and one of small ones.
  if (effort() < kEffortOfLargeTests) meshes.erase(meshes.begin() + 1, meshes.end() - 1);
  for (const HexMesh& mesh : meshes) {
    for (const Way& first : ways) {
      const HexMesh between = through(first, mesh, folder / "a");
      for (const Way& second : ways) {
        SCOPED_TRACE(first.format + " to " + second.format);
        expectSameMeshes(through(second, between, folder / "b"), mesh);
      }
    }
  }
}

TEST(RoundTrips, GeneratorsSurviveWhereTheFormatHoldsThem) {
  const TemporaryFolder folder;
  const HexMesh mesh = extract(maps()[0]);
  std::vector<Way> ways = {{"ovm"}, {"ovmb"}};
  for (const Compression how : compressions()) ways.push_back({"vtu", how});
  for (const Way& way : ways) {
    const HexMesh read = through(way, mesh, folder / "a");
    EXPECT_EQ(read.generatorTet, mesh.generatorTet) << way.format;
    EXPECT_EQ(read.generatorCorners, mesh.generatorCorners) << way.format;
  }
}

TEST(RoundTrips, FilesDoNotDependOnTheNumberOfThreads) {
  const TemporaryFolder folder;
  const HexMesh mesh = gridMesh(40, 30, 20);
  const TetMap map = generateSample(SampleKind::Sphere, {.cells = 2, .refine = 4}).map;
  const auto expectSame = [&folder](const Way& way) {
    EXPECT_TRUE(contentOf(folder / "1") == contentOf(folder / "3")) << way.format;
  };
  for (const Way& way : meshWays()) {
    for (const int threads : {1, 3}) {
      Context context(threads);
      writeHexMesh(mesh, folder / std::to_string(threads), way.writing(), context);
    }
    expectSame(way);
  }
  for (const Way& way : mapWays()) {
    for (const int threads : {1, 3}) {
      Context context(threads);
      writeMap(map, folder / std::to_string(threads), way.writing(), context);
    }
    expectSame(way);
  }
}

TEST(Formats, NamesAreUniqueAndOtherNamesAreUnderstood) {
  std::vector<std::string_view> names;
  for (const FileFormat& format : fileFormats()) {
    EXPECT_EQ(std::count(names.begin(), names.end(), format.name), 0) << format.name;
    names.push_back(format.name);
    EXPECT_FALSE(format.description.empty());
    EXPECT_TRUE(format.readsMaps || format.writesMaps || format.readsHexMeshes ||
                format.writesHexMeshes || format.readsSurfaces || format.readsTets)
        << format.name;
  }
  EXPECT_NO_THROW(requireHexMeshFormat("out.dat", "gmsh22"));
  EXPECT_NO_THROW(requireHexMeshFormat("out.dat", "gmsh"));
  EXPECT_EQ(failureOf([] { requireHexMeshFormat("out.dat", "hexex"); }).code,
            ErrorCode::FileUnsupported);
}

TEST(Formats, CompressionIsForVtuOnly) {
  const TemporaryFolder folder;
  Context context;
  WriteOptions options;
  options.compress = Compression::Zlib;
  const Failure failure =
      failureOf([&] { writeHexMesh(gridMesh(1, 1, 1), folder / "a.mesh", options, context); });
  EXPECT_EQ(failure.code, ErrorCode::FileUnsupported);
  EXPECT_NE(failure.sentence.find("no compression"), std::string::npos) << failure.sentence;
  EXPECT_EQ(failureOf([&] { writeMap(smallMap(), folder / "a.hexex", options, context); }).code,
            ErrorCode::FileUnsupported);
  EXPECT_EQ(
      failureOf([&] { static_cast<void>(openMeshSink(folder / "a.vtu", options, context)); }).code,
      ErrorCode::FileUnsupported);
  EXPECT_EQ(folder.fileCount(), 0U);
}

TEST(Formats, EitherMapOrMeshIsFound) {
  const TemporaryFolder folder;
  Context context;
  for (const std::string name : {"a.vtu", "a.vtk", "a.ovmb", "a.ovm"}) {
    writeMap(maps()[0], folder / name);
    EXPECT_TRUE(std::holds_alternative<TetMap>(readMapOrHexMesh(folder / name, {}, context)));
    writeHexMesh(gridMesh(2, 1, 1), folder / name);
    EXPECT_TRUE(std::holds_alternative<HexMesh>(readMapOrHexMesh(folder / name, {}, context)));
  }
}

}  // namespace
}  // namespace hexhex::test
