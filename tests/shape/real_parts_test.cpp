// Real parts without maps, where the folder is there: how many end in certified meshes.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include "support/effort.hpp"

namespace hexhex::test {
namespace {

/// Larger files take minutes.
constexpr std::uintmax_t kMostBytes = 500'000;

/// Tets of all files of these folders that are small, of maps without the maps.
std::vector<std::filesystem::path> realParts() {
  const char* const chosen = std::getenv("HEXHEX_DATA");
  std::vector<std::filesystem::path> files;
  for (const char* const name : {"shapes", "seamless"}) {
    const auto folder = std::filesystem::path(chosen != nullptr ? chosen : HEXHEX_DATA_DIR) / name;
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.file_size() <= kMostBytes) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  files.resize(std::min(files.size(), static_cast<std::size_t>(cases(22))));
  return files;
}

TEST(RealParts, EndInCertifiedMeshes) {
  HEXHEX_LARGE_TEST();
  const auto files = realParts();
  if (files.empty()) GTEST_SKIP() << "no shapes in " << HEXHEX_DATA_DIR;
  std::size_t valid = 0;
  std::size_t mapped = 0;
  std::size_t certified = 0;
  for (const std::filesystem::path& file : files) {
    SCOPED_TRACE(file.filename());
    Context context;
    const TetMesh tets = readTetMesh(file, {}, context);
    MeshOptions options;
    options.shape.method = ShapeMethod::Polycube;
    options.quantize = {.cells = 2000, .densify = true};
    try {
      const MeshedPart part = meshFromTets(tets, options, context);
      ++mapped;
      valid += part.shape.labels.isValid() ? 1 : 0;
      certified += part.improvement.after.allPositive() ? 1 : 0;
      EXPECT_TRUE(part.verification.passed());
      EXPECT_TRUE(check(part.map, {.tolerance = 0}, context).valid());
    } catch (const Error& error) {
      std::cout << file.filename() << ": " << error.what() << '\n';
    }
  }
  std::cout << "of " << files.size() << " parts: labels of " << valid << " are valid, " << mapped
            << " have a map, " << certified << " a certified mesh\n";
  // 95 %, as far as that is a number of parts.
  EXPECT_GE(20 * certified, 19 * files.size() - 19);
}

}  // namespace
}  // namespace hexhex::test
