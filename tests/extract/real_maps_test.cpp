// Real models with known counts, if the folder with them is there.
#include <cstdlib>
#include <filesystem>
#include <ostream>

#include <gtest/gtest.h>

#include <hexhex/io.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

namespace {

struct RealMap {
  const char* name;
  std::size_t cells;
  std::size_t vertices;
};

/// In names of tests.
void PrintTo(const RealMap& map, std::ostream* out) { *out << map.name; }

constexpr RealMap kRealMaps[] = {
    {"s17c_sphere_r0.1", 372, 488},
    {"s17c_sphere_r1", 4320, 4795},
    {"s17c_sphere_r10", 43200, 45216},
    {"s17c_sphere_r100", 414370, 423528},
    {"s15c_cylinder_r0.01", 96, 154},
    {"s15c_cylinder_r1", 6525, 7410},
    {"s15c_cylinder_r100", 665312, 683493},
    {"fanpart_r0.1", 232, 410},
    {"fanpart_r10", 22848, 26312},
    {"prisma_r1", 6160, 7200},
    {"prisma_r100", 590892, 611820},
    {"double-torus_r1", 2290, 3396},
    {"double-torus_r100", 216106, 237567},
    {"n04c_transition_prism_r1", 4264, 5586},
    {"s01c_cube_r1", 1331, 1728},
    {"fandisk_r0.01", 82, 178},
    {"fandisk_r1", 2398, 3249},
    {"fandisk_r100", 258783, 276698},
    {"n12c_limit_cycle_r10", 40100, 43186},
    {"rockerarm", 1749, 2120},
};

std::filesystem::path dataFolder() {
  const char* chosen = std::getenv("HEXHEX_DATA");
  return std::filesystem::path(chosen != nullptr ? chosen : HEXHEX_DATA_DIR) / "maps";
}

/// Cells of the largest mesh that is extracted at scales beyond 1: sanitizer runs want fewer.
std::size_t largestMesh() { return static_cast<std::size_t>(cases(8000000)); }

class RealMaps : public ::testing::TestWithParam<RealMap> {};

TEST_P(RealMaps, ExtractAndVerify) {
  const std::filesystem::path file = dataFolder() / (std::string(GetParam().name) + ".hexex");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no real maps here";
  if (std::string_view(GetParam().name).ends_with("_r100")) HEXHEX_LARGE_TEST();
  const TetMap map = readMap(file);
  const std::string name = GetParam().name;
  for (const int scale : {1, 2, 3, 16}) {
    if (scale == 16 && name != "rockerarm") continue;
    const auto s = static_cast<std::size_t>(scale);
    const std::size_t cells = GetParam().cells * s * s * s;
    if (scale > 1 && cells > largestMesh()) continue;
    SCOPED_TRACE(scale);
    ExtractOptions options;
    options.scale = scale;
    const HexMesh mesh = verifiedExtraction(map, options);
    EXPECT_EQ(mesh.cells.size(), cells);
    if (scale == 1) {
      EXPECT_EQ(mesh.points.size(), GetParam().vertices);
      Context one(1);
      EXPECT_TRUE(sameBits(mesh, extract(map, options, one)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, RealMaps, ::testing::ValuesIn(kRealMaps),
                         [](const ::testing::TestParamInfo<RealMap>& map) {
                           std::string name = map.param.name;
                           for (char& c : name) {
                             if (c == '-' || c == '.') c = '_';
                           }
                           return name;
                         });

}  // namespace
}  // namespace hexhex::test
