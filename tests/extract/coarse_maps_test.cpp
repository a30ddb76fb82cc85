// Maps whose cells meet themselves.
#include "support/coarse_maps.hpp"

#include <gtest/gtest.h>

#include <hexhex/check.hpp>

#include "extract/support.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

namespace {

TEST(CoarseMaps, OfATorusAreVerified) {
  for (const Index cells : {1U, 2U, 3U}) {
    const TetMap map = threeTorus(cells);
    ASSERT_TRUE(check(map).valid());
    for (const int scale : {1, 2, 3}) {
      ExtractOptions options;
      options.scale = scale;
      const HexMesh mesh = extract(map, options);
      const std::size_t along = cells * static_cast<std::size_t>(scale);
      EXPECT_EQ(mesh.cells.size(), along * along * along);
      EXPECT_EQ(mesh.points.size(), along * along * along);
      EXPECT_TRUE(sameBits(mesh, extract(map, withOtherEngine(options))));
      VerifyOptions verifyOptions;
      verifyOptions.scale = scale;
      verifyOptions.countElements = true;
      const VerifyReport report = verify(map, mesh, verifyOptions);
      EXPECT_TRUE(report.passed()) << failures(report);
      EXPECT_EQ(report.items.back().name == "faces_and_edges", along < 3);
    }
  }
}

TEST(CoarseMaps, AreNoExcuseForOtherFaults) {
  const TetMap map = threeTorus(2);
  HexMesh mesh = extract(map);
  const Hex whole = mesh.cells.back();
  mesh.cells.back() = mesh.cells.front();
  EXPECT_FALSE(verify(map, mesh).passed());
  mesh.cells.pop_back();
  EXPECT_FALSE(verify(map, mesh).passed());
  mesh.cells.push_back(whole);
  EXPECT_TRUE(verify(map, mesh).passed());
  mesh.points.push_back({0, 0, 0});
  mesh.cells[0][0] = 8;
  EXPECT_FALSE(verify(map, mesh).passed());
}

TEST(CoarseMaps, WithACellAroundAnInnerEdgeAreNamedByTheCheck) {
  for (const Index layers : {1U, 3U}) {
    const TetMap map = rolledUp(layers);
    const CheckReport report = check(map);
    ASSERT_EQ(report.defects.size(), 1U);
    EXPECT_EQ(report.defects[0].code, ErrorCode::AmbiguousMesh);
    EXPECT_EQ(report.defects[0].count, layers);
    EXPECT_EQ(report.innerSingularTetEdges, (std::map<int, std::uint64_t>{{1, layers}}));
    EXPECT_EQ(codeOf([&] { static_cast<void>(extract(map)); }), ErrorCode::AmbiguousMesh);
  }
}

}  // namespace

}  // namespace hexhex::test
