// Tags and regions come back from every format that holds them, also by way of each other.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/compressions.hpp>

#include <hexhex/io.hpp>
#include <hexhex/samples.hpp>

#include <io/core/mesh_groups.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test {

using namespace io;
namespace {

/// 24 cells with tags of all kinds. Regions are sorted, as some formats list cells by region.
HexMesh taggedMesh() {
  HexMesh mesh = gridMesh(4, 3, 2);
  mesh.features.vertices = {{0, 4}, {7, 9}, {59, 4}};
  mesh.features.edges = {{{0, 1}, 5}, {{1, 2}, 5}, {{21, 26}, 2147483646}};
  // Two on the boundary, one inside.
  mesh.features.quads = {{{0, 5, 6, 1}, 7}, {{1, 6, 7, 2}, 3}, {{21, 26, 46, 41}, 7}};
  mesh.regions.assign(mesh.cells.size(), 0);
  std::fill_n(mesh.regions.begin(), 9, 2);
  std::fill_n(mesh.regions.begin() + 9, 8, 2147483646);
  return mesh;
}

/// Features without the order in which files list them.
HexFeatures sorted(HexFeatures features) {
  const auto sort = [](auto& all) {
    for (auto& feature : all) std::sort(feature.vertices.begin(), feature.vertices.end());
    std::sort(all.begin(), all.end(),
              [](const auto& a, const auto& b) { return a.vertices < b.vertices; });
  };
  std::sort(features.vertices.begin(), features.vertices.end(),
            [](const auto& a, const auto& b) { return a.vertex < b.vertex; });
  sort(features.edges);
  sort(features.quads);
  return features;
}

HexMesh through(const std::string& format, const HexMesh& mesh, const std::filesystem::path& file,
                Compression compress = Compression::None) {
  Context context(2);
  WriteOptions writing;
  writing.format = format;
  writing.compress = compress;
  writeHexMesh(mesh, file, writing, context);
  ReadOptions reading;
  reading.format = format;
  return readHexMesh(file, reading, context);
}

void expectSame(const HexMesh& read, const HexMesh& wanted) {
  expectSameBits(read.points, wanted.points);
  EXPECT_EQ(read.cells, wanted.cells);
  EXPECT_EQ(read.regions, wanted.regions);
  const HexFeatures a = sorted(read.features);
  const HexFeatures b = sorted(wanted.features);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.quads, b.quads);
}

TEST(Tags, ComeBackThroughEveryPairOfFormatsThatHoldThem) {
  const std::vector<std::string> formats = {"vtu",  "ovm",         "ovmb",        "meshb",
                                            "mesh", "msh41-ascii", "msh22-ascii", "msh"};
  const TemporaryFolder folder;
  for (const std::string& first : formats) {
    HexMesh mesh = taggedMesh();
    if (first == "mesh") mesh.features.edges.clear();  // viewers stumble over them
    const HexMesh between = through(first, mesh, folder / "a");
    for (const std::string& second : formats) {
      SCOPED_TRACE(first + " to " + second);
      if (second == "mesh") mesh.features.edges.clear();
      expectSame(through(second, between, folder / "b"), mesh);
      if (second == "mesh") mesh.features.edges = between.features.edges;
    }
  }
}

TEST(Tags, ComeBackFromCompressedFiles) {
  const TemporaryFolder folder;
  for (const Compression how : compressions()) {
    expectSame(through("vtu", taggedMesh(), folder / "a", how), taggedMesh());
  }
}

TEST(Tags, MayBeNegativeWhereNamesOrArraysHoldThem) {
  const TemporaryFolder folder;
  HexMesh mesh = taggedMesh();
  mesh.features.vertices[0].tag = mesh.features.edges[0].tag = mesh.features.quads[0].tag = -8;
  for (const char* format : {"vtu", "ovm", "ovmb", "msh", "msh41-ascii", "msh22-ascii"}) {
    SCOPED_TRACE(format);
    expectSame(through(format, mesh, folder / "a"), mesh);
  }
}

TEST(Tags, RegionsComeBackFromLegacyFiles) {
  const TemporaryFolder folder;
  HexMesh mesh = taggedMesh();
  mesh.regions.front() = -3;
  for (const char* format : {"vtk", "vtk-binary"}) {
    const HexMesh read = through(format, mesh, folder / "a");
    EXPECT_EQ(read.regions, mesh.regions) << format;
    EXPECT_TRUE(read.features.empty()) << format;
  }
}

TEST(Tags, AreNotMadeOfReferencesThatSayNothing) {
  const TemporaryFolder folder;
  Context context(2);
  HexMesh mesh = gridMesh(2, 2, 2);
  for (const char* format : {"mesh", "meshb", "msh", "msh41-ascii", "msh22-ascii"}) {
    SCOPED_TRACE(format);
    WriteOptions writing;
    writing.format = format;
    writing.patchAngle = 0;  // one group
    writeHexMesh(mesh, folder / "a", writing, context);
    ReadOptions reading;
    reading.format = format;
    const HexMesh read = readHexMesh(folder / "a", reading, context);
    EXPECT_TRUE(read.features.empty());
    EXPECT_TRUE(read.regions.empty());
  }
}

TEST(Tags, PatchesAreTagsWhereTheyAreOnlyNumbers) {
  const TemporaryFolder folder;
  const HexMesh mesh = gridMesh(2, 2, 2);
  EXPECT_EQ(through("meshb", mesh, folder / "a").features.quads.size(), 24U);
  EXPECT_EQ(through("mesh", mesh, folder / "a").features.quads.size(), 24U);
  EXPECT_TRUE(through("msh", mesh, folder / "a").features.quads.empty());  // named patch_1 ...
}

TEST(Tags, OfMapsComeBack) {
  const TemporaryFolder folder;
  SampleOptions options;
  options.cells = 2;
  options.features = true;
  TetMap map = generateSample(SampleKind::Box, options).map;
  ASSERT_FALSE(map.features.empty());
  map.regions.assign(map.tets.size(), 0);
  map.regions[1] = -5;
  for (const char* name : {"a.vtu", "a.ovmb", "a.ovm"}) {
    writeMap(map, folder / name);
    TetMap read = readMap(folder / name);
    EXPECT_EQ(read.regions, map.regions) << name;
    EXPECT_EQ(read.features.vertices, map.features.vertices) << name;
    EXPECT_EQ(read.features.edges.size(), map.features.edges.size()) << name;
    EXPECT_EQ(read.features.faces.size(), map.features.faces.size()) << name;
  }
  const TetMap read = readMap(folder / "a.vtu");
  EXPECT_EQ(read.features, map.features);
}

TEST(Tags, ThatCannotBeAreRefused) {
  const TemporaryFolder folder;
  HexMesh mesh = taggedMesh();
  mesh.features.edges = {{{0, 1}, 5}};
  writeHexMesh(mesh, folder / "a.vtu");
  std::string text = contentOf(folder / "a.vtu");
  // The row 0 1 5 of the array feature_edges, the first of the appended data.
  const std::string row{"\0\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\5\0\0\0\0\0\0\0", 24};
  const std::size_t place = text.find(row);
  ASSERT_NE(place, std::string::npos);
  text[place + 8] = 100;
  writeText(folder / "b.vtu", text);
  const Failure failure = failureOf([&] { static_cast<void>(readHexMesh(folder / "b.vtu")); });
  EXPECT_EQ(failure.code, ErrorCode::IndexOutOfRange);
  EXPECT_NE(failure.sentence.find("feature_edges"), std::string::npos) << failure.sentence;
}

TEST(GmshNames, SayTheTag) {
  EXPECT_EQ(tagInGroupName("surface_7"), 7);
  EXPECT_EQ(tagInGroupName("curve_m2147483648"), -2147483647 - 1);
  EXPECT_EQ(tagInGroupName("boundary"), 0);
  EXPECT_EQ(tagInGroupName("patch_3"), 0);
  EXPECT_EQ(tagInGroupName("surface_7", 2), 7);
  EXPECT_EQ(tagInGroupName("surface_7", 3), std::nullopt);
  EXPECT_EQ(tagInGroupName("boundary", 3), std::nullopt);
  for (const char* other :
       {"", "inlet", "surface_", "surface_x", "surface_7 ", "region_2147483648", "surface_0",
        "patch_", "patch_antenna", "curve_m", "point_99999999999999999999"}) {
    EXPECT_EQ(tagInGroupName(other), std::nullopt) << other;
  }
}

}  // namespace
}  // namespace hexhex::test
