// The library prints nothing, whatever happens to it.
#include <cstdio>
#include <filesystem>
#include <string>
#include <unistd.h>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include "support/error_of.hpp"

namespace hexhex {
namespace {

/// Everything that goes to the file descriptors 1 and 2 while this lives.
class Captured {
 public:
  Captured() : file_(std::tmpfile()) {
    std::fflush(nullptr);
    for (int i = 0; i < 2; ++i) {
      saved_[i] = dup(i + 1);
      dup2(fileno(file_), i + 1);
    }
  }
  std::string finish() {
    std::fflush(nullptr);
    for (int i = 0; i < 2; ++i) {
      dup2(saved_[i], i + 1);
      close(saved_[i]);
    }
    std::string text;
    std::rewind(file_);
    for (int c = std::fgetc(file_); c != EOF; c = std::fgetc(file_)) {
      text.push_back(static_cast<char>(c));
    }
    std::fclose(file_);
    return text;
  }

 private:
  std::FILE* file_;
  int saved_[2] = {};
};

void useEverything(const std::filesystem::path& folder) {
  const TetMap map = generateSample(SampleKind::Sphere).map;
  writeMap(map, folder / "map.hexex");
  TetMap broken = readMap(folder / "map.hexex");
  broken.parameters[0][0] = broken.parameters[0][1];
  EXPECT_FALSE(check(broken).valid());
  EXPECT_EQ(test::codeOf([&] { static_cast<void>(extract(broken)); }), ErrorCode::FlippedTet);
  EXPECT_EQ(test::codeOf([&] { static_cast<void>(extract(map, {.scale = 0})); }),
            ErrorCode::InvalidArgument);
  Context cancelled;
  cancelled.cancel();
  EXPECT_EQ(test::codeOf([&] { static_cast<void>(extract(map, {}, cancelled)); }),
            ErrorCode::Cancelled);
  for (const Engine engine : {Engine::Atlas, Engine::Propeller}) {
    const HexMesh mesh = extract(map, {.engine = engine, .scale = 2});
    EXPECT_TRUE(verify(map, mesh, {.scale = 2}).passed());
    EXPECT_FALSE(verify(map, mesh, {.scale = 3}).passed());
    for (const char* name : {"m.mesh", "m.vtu", "m.ovm", "m.ovmb", "m.vtk", "m.msh", "m.meshb"}) {
      writeHexMesh(mesh, folder / name);
      EXPECT_EQ(readHexMesh(folder / name).cells.size(), mesh.cells.size()) << name;
    }
  }
  Context context;
  SampleOptions damage;
  damage.cells = 8;
  damage.refine = 4;
  damage.defects = 2;
  const TetMap bad = generateSample(SampleKind::Sphere, damage).map;
  EXPECT_GT(extractPartial(bad, {}, context).holes.size(), 0U);
  if (canRepair()) {
    EXPECT_TRUE(check(repair(bad)).valid());
    broken.parameters.resize(1);
    EXPECT_EQ(test::codeOf([&] { static_cast<void>(repair(broken)); }), ErrorCode::InvalidArgument);
  }
  const auto pieces =
      extractPiecewiseLinear(map, PiecewiseLinearParts::ArcsAndPatches, {}, context);
  writePatches(pieces, folder / "patches.vtu", context);
  writeLagrangeMesh(extractLagrange(map, 2, {}, context), folder / "c.vtu", {}, context);
  EXPECT_EQ(readLagrangeMesh(folder / "c.vtu", context).cellCount(), pieces.mesh.cells.size());
  extractToFile(folder / "stream.vtu", map, {}, context);
  EXPECT_EQ(summarizeFile(folder / "stream.vtu", context), summarize(pieces.mesh, context));
  EXPECT_GT(findMapStructure(map, 1e-2, context).singularEdges.size(), 0U);
  EXPECT_EQ(test::codeOf([&] { static_cast<void>(readMap(folder / "m.vtu")); }),
            ErrorCode::FileUnsupported);
  EXPECT_EQ(test::codeOf([&] { static_cast<void>(readHexMesh(folder / "none.mesh")); }),
            ErrorCode::FileNotFound);
}

TEST(Library, PrintsNothing) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("hexhex-silent-" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  Captured captured;
  std::printf("this is noticed");
  useEverything(folder);
  EXPECT_EQ(captured.finish(), "this is noticed");
  std::filesystem::remove_all(folder);
}

TEST(Library, KnowsItsVersion) { EXPECT_STREQ(version(), HEXHEX_VERSION); }

}  // namespace
}  // namespace hexhex
