// Files of parts, glued, are the mesh in one piece.
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <string>
#if !defined(_WIN32)
#include <sys/stat.h>
#endif

#include <gtest/gtest.h>
#include <support/effort.hpp>

#include <hexhex/parts.hpp>
#include <hexhex/samples.hpp>

#include "support/damaged_maps.hpp"

namespace hexhex {
namespace {

namespace fs = std::filesystem;

class PartFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("hexhex-parts-" + std::to_string(std::random_device()()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static TetMap sample(bool features) {
    SampleOptions options;
    options.cells = 3;
    options.features = features;
    options.jitter = 0.5;
    return generateSample(SampleKind::Shell, options).map;
  }
  void write(const TetMap& map, const fs::path& file, const PartOptions& parts,
             const WriteOptions& writing = {}) const {
    Context context;
    const std::unique_ptr<PartSink> sink = openPartSink(file, writing, context);
    PartSummarySink checked(*sink);
    extractParts(checked, map, {}, parts, context);
  }
  static std::string textOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  fs::path folder_;
};

void expectSame(const HexMesh& a, const HexMesh& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.generatorTet, b.generatorTet);
  EXPECT_EQ(a.generatorCorners, b.generatorCorners);
  EXPECT_EQ(a.features, b.features);
  EXPECT_EQ(a.regions, b.regions);
}

TEST_F(PartFiles, OfVtkAreGluedToTheMesh) {
  for (const bool features : {false, true}) {
    const TetMap map = sample(features);
    const HexMesh whole = extract(map);
    for (const std::uint32_t parts : {1U, 12U, 4U}) {
      for (const std::uint32_t ghosts : {0U, 1U}) {
        write(map, folder_ / "mesh.pvtu", {parts, ghosts});
        expectSame(readHexMesh(folder_ / "mesh.pvtu"), whole);
        const auto pieces = std::distance(fs::directory_iterator(folder_ / "mesh"), {});
        EXPECT_EQ(pieces, parts) << "those of earlier runs are gone";
      }
    }
  }
}

TEST_F(PartFiles, AreManyAndMostlyEmpty) {
  SampleOptions options;
  options.cells = 2;
  const TetMap map = generateSample(SampleKind::Box, options).map;
  write(map, folder_ / "mesh.pvtu", {60, 1});
  expectSame(readHexMesh(folder_ / "mesh.pvtu"), extract(map));
}

/// Threads make, prove and write parts side by side.
TEST_F(PartFiles, AreTheSameForAnyNumberOfThreads) {
  const TetMap map = sample(true);
  for (const PartFormat& format : partFormats()) {
    WriteOptions writing;
    writing.format = format.name;
    std::array<std::map<fs::path, std::string>, 2> files;
    for (const int threads : {1, 4}) {
      const fs::path folder = folder_ / format.name;
      fs::create_directories(folder);
      Context context(threads);
      const auto sink =
          openPartSink(folder / ("m" + std::string(format.extension)), writing, context);
      PartOptions parts;
      parts.parts = 11;
      parts.verify = true;
      extractParts(*sink, map, {}, parts, context);
      for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        files[threads == 1 ? 0 : 1][fs::relative(entry.path(), folder)] = textOf(entry.path());
      }
      fs::remove_all(folder);
    }
    EXPECT_FALSE(files[0].empty()) << format.name;
    EXPECT_TRUE(files[0] == files[1]) << format.name;
  }
}

TEST_F(PartFiles, AppearWhenAllAreWrittenOrNotAtAll) {
  for (const PartFormat& format : partFormats()) {
    WriteOptions writing;
    writing.format = format.name;
    const fs::path file = folder_ / ("x" + std::string(format.extension));
    Context context;
    {
      const std::unique_ptr<PartSink> sink = openPartSink(file, writing, context);
      std::vector<MeshPart> parts = extractParts(sample(true), {}, {3}, context);
      sink->begin({3, 0, 1000, 1000});
      sink->part(std::move(parts[0]));
    }
    EXPECT_TRUE(fs::is_empty(folder_)) << format.name;
  }
}

TEST_F(PartFiles, OfManyMapsAreWritten) {
  HEXHEX_LARGE_TEST();
  std::mt19937_64 random(3);
  for (const PartFormat& format : partFormats()) {
    for (int i = 0; i < 2; ++i) {
      test::MapDamage draw(random());
      const TetMap map = draw.sample();
      WriteOptions writing;
      writing.format = format.name;
      // More parts than cells, too.
      const fs::path file = folder_ / std::to_string(i) / ("x" + std::string(format.extension));
      fs::create_directories(file.parent_path());
      EXPECT_NO_THROW(write(map, file, {1U << draw.below(4U)}, writing)) << format.name;
    }
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
}

TEST_F(PartFiles, OfOtherFormatsAreRefused) {
  Context context;
  EXPECT_THROW(static_cast<void>(openPartSink(folder_ / "x.obj", {}, context)), Error);
  EXPECT_THROW(requirePartFormat("x.hexex", {}), Error);
}

TEST_F(PartFiles, ThatDoNotFitTogetherAreRefused) {
  const TetMap map = sample(false);
  write(map, folder_ / "a.pvtu", {3});
  const std::string index = textOf(folder_ / "a.pvtu");
  const auto refuse = [&](const std::string& text) {
    std::ofstream(folder_ / "b.pvtu") << text;
    EXPECT_THROW(static_cast<void>(readHexMesh(folder_ / "b.pvtu")), Error) << text;
  };
  const auto without = [&](const std::string& what) {
    std::string text = index;
    const std::size_t place = text.find(what);
    EXPECT_NE(place, std::string::npos);
    return text.erase(place, what.size());
  };
  refuse("");
  refuse("<VTKFile><PUnstructuredGrid></PUnstructuredGrid></VTKFile>");
  refuse(without("a/a_1.vtu"));
  refuse(without("    <Piece Source=\"a/a_1.vtu\"/>\n"));
  const auto with = [&](const std::string& file) {
    std::string text = index;
    return text.insert(text.find("    <Piece"), "    <Piece Source=\"" + file + "\"/>\n");
  };
  // The same pieces again and again: a small file that takes much memory.
  refuse(with("a/a_1.vtu"));
  refuse(with("./a/../a/a_1.vtu"));
  // What has no end.
  refuse(with("/dev/zero"));
#if !defined(_WIN32)
  ASSERT_EQ(::mkfifo((folder_ / "pipe.vtu").c_str(), 0600), 0);
  refuse(with("pipe.vtu"));
#endif
  refuse(with("a"));
  refuse(with("b.pvtu"));
  fs::remove(folder_ / "a" / "a_2.vtu");
  EXPECT_THROW(static_cast<void>(readHexMesh(folder_ / "a.pvtu")), Error);
}

}  // namespace
}  // namespace hexhex
