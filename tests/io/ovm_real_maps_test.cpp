// Real maps through `.ovmb` and `.ovm`: the same mesh comes out as from their `.hexex` files. And
// real files of OpenVolumeMesh, if there are any.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/extract.hpp>
#include <hexhex/io.hpp>

#include "ovm_test_support.hpp"

namespace hexhex::test {
namespace {

std::filesystem::path dataFolder() {
  const char* chosen = std::getenv("HEXHEX_DATA");
  return chosen != nullptr ? chosen : HEXHEX_DATA_DIR;
}

/// All files below the data folder with one of these extensions.
std::vector<std::filesystem::path> filesWith(const std::vector<std::string>& extensions) {
  std::vector<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(dataFolder(), none)) {
    for (const std::string& extension : extensions) {
      if (entry.path().extension() == extension) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(OvmRealMaps, GiveTheSameMeshAsHexex) {
  const TemporaryFolder folder;
  std::size_t tried = 0;
  for (const std::filesystem::path& file : filesWith({".hexex"})) {
    if (file.parent_path().filename() != "maps") continue;
    const std::string name = file.stem().string();
    // The small ones: the size of the mesh tests nothing here.
    if (name.ends_with("r100") || name.ends_with("r10")) continue;
    const TetMap map = readMap(file);
    const HexMesh expected = extract(map);
    for (const char* other : {"a.ovmb", "a.ovm"}) {
      writeMap(map, folder / other);
      const TetMap read = readMap(folder / other);
      expectSameMap(map, read);
      const HexMesh mesh = extract(read);
      expectSameMesh(expected, mesh);
      // And the mesh itself through the same format.
      const std::string meshFile = std::string("mesh") + other;
      writeHexMesh(mesh, folder / meshFile);
      expectSameMesh(expected, readHexMesh(folder / meshFile));
    }
    EXPECT_FALSE(::testing::Test::HasFailure()) << name;
    ++tried;
  }
  if (tried == 0) GTEST_SKIP() << "skipped: no real maps here";
}

TEST(OvmRealMaps, FilesOfOpenVolumeMesh) {
  const std::vector<std::filesystem::path> files = filesWith({".ovm", ".ovmb"});
  if (files.empty()) GTEST_SKIP() << "skipped: no files of OpenVolumeMesh here";
  for (const std::filesystem::path& file : files) {
    // Tets with a map, tets without, or hexahedra: one way of reading must do, or say why.
    std::string sentence;
    try {
      EXPECT_FALSE(readMap(file).tets.empty()) << file;
      continue;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::FileUnsupported) << error.what();
      sentence = error.what();
    }
    if (sentence.find("no map") != std::string::npos) continue;
    EXPECT_FALSE(readHexMesh(file).cells.empty()) << file;
  }
}

}  // namespace
}  // namespace hexhex::test
