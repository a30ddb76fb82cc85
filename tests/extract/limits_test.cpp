// Quantities of large maps that must not overflow.
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include <gtest/gtest.h>
#include <support/effort.hpp>

#include <hexhex/check.hpp>
#include <hexhex/partial.hpp>

#include <mesh/grid_meshes.hpp>

#include "extract/support.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

namespace {

/// Unit cubes that do not touch, all at the origin of parameter space.
TetMap separateCubes(std::size_t count) {
  const TetMap cube = testing::identityMap(1);
  TetMap map;
  for (std::size_t i = 0; i < count; ++i) {
    const auto first = static_cast<Index>(map.points.size());
    for (Vec3 point : cube.points) {
      point[0] += 2 * static_cast<double>(i);
      map.points.push_back(point);
    }
    for (Tet tet : cube.tets) {
      for (Index& v : tet) v += first;
      map.tets.push_back(tet);
    }
    map.parameters.insert(map.parameters.end(), cube.parameters.begin(), cube.parameters.end());
  }
  return map;
}

/// Unit cubes around a common edge, each in a chart of its own with the edge along the third axis.
TetMap cubesAroundEdge(Index valence) {
  const TetMap model = testing::identityMap(1);  // numbers its corners as a cell does
  TetMap map;
  const auto ring = [valence](Index level, Index place) {
    return level + 2 * (1 + place % (2 * valence));
  };
  for (Index v = 0; v <= 2 * valence; ++v) {
    const double angle = v * std::numbers::pi / valence;
    const double radius = v == 0 ? 0 : v % 2 == 1 ? 1 : 1.2;
    for (const double z : {0.0, 1.0}) {
      map.points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
  }
  for (Index i = 0; i < valence; ++i) {
    const std::array<Index, 8> cube = {0, ring(0, 2 * i), ring(0, 2 * i + 1), ring(0, 2 * i + 2),
                                       1, ring(1, 2 * i), ring(1, 2 * i + 1), ring(1, 2 * i + 2)};
    for (const Tet& tet : model.tets) {
      map.tets.push_back({cube[tet[0]], cube[tet[1]], cube[tet[2]], cube[tet[3]]});
    }
    map.parameters.insert(map.parameters.end(), model.parameters.begin(), model.parameters.end());
  }
  return map;
}

TEST(Limits, ValencesOfAThousand) {
  for (const Index valence : {3U, 255U, 500U, 1000U}) {
    for (const int scale : {1, 2}) {
      ExtractOptions options;
      options.scale = scale;
      const HexMesh mesh = verifiedExtraction(cubesAroundEdge(valence), options);
      EXPECT_EQ(mesh.cells.size(), valence * static_cast<std::size_t>(scale * scale * scale));
    }
  }
}

/// A box of one cube in space.
TetMap boxOf(double x, double y, double z) {
  TetMap map = testing::identityMap(1);
  for (TetParameters& u : map.parameters) {
    for (Vec3& corner : u) corner = {x * corner[0], y * corner[1], z * corner[2]};
  }
  return map;
}

TEST(Limits, AreasAndVolumesOf10To12) {
  const Expectation cube = check(boxOf(1e4, 1e4, 1e4)).expected;
  EXPECT_EQ(cube.cells, 1'000'000'000'000U);
  EXPECT_EQ(cube.boundaryQuads, 600'000'000U);
  const CheckReport plate = check(boxOf(1e6, 1e6, 1), {1e-2, 10});
  EXPECT_EQ(plate.expected.cells, 1'000'000'000'000'000U);
  EXPECT_EQ(plate.expected.boundaryQuads, 200'000'400'000'000U);
  EXPECT_EQ(plate.expected.boundarySingularEdges.at(1), 80'000'040U);
  EXPECT_EQ(codeOf([] { static_cast<void>(extract(boxOf(1e4, 1e4, 1e4))); }), ErrorCode::TooLarge);
}

/// 2^60 cells are counted no more, neither by the map's own size nor by the scale.
TEST(Limits, CellsThatCannotBeCounted) {
  for (const double size : {0x1p20, 0x1p21, 0x1p22, 0x1p22 + 1, 0x1p24, 0x1p26}) {
    const TetMap map = boxOf(size, size, size);
    EXPECT_EQ(codeOf([&] { static_cast<void>(extract(map)); }), ErrorCode::TooLarge) << size;
    const CheckReport report = check(map);
    ASSERT_EQ(report.defects.size(), 1U) << size;
    EXPECT_EQ(report.defects[0].code, ErrorCode::TooLarge);
  }
  EXPECT_EQ(check(boxOf(1, 1, 1), {1e-2, 1'000'000}).expected.cells, 1'000'000'000'000'000'000U);
  EXPECT_EQ(check(boxOf(1, 1, 1), {1e-2, 1 << 20}).defects.at(0).code, ErrorCode::TooLarge);
  for (const int scale :
       {1'626, 1 << 16, 1 << 21, 1 << 22, 1 << 27, 1 << 28, 1 << 30, 0x7fffffff}) {
    ExtractOptions options;
    options.scale = scale;
    const Error error = errorOf([&] { static_cast<void>(extract(boxOf(1, 1, 1), options)); });
    EXPECT_EQ(error.code(), ErrorCode::TooLarge) << scale;
  }
}

/// Views that say that they have more tets than there are indices for, and nothing behind them.
TEST(Limits, TetsThatCannotBeNumbered) {
  const TetMap one = boxOf(1, 1, 1);
  for (const std::size_t tets :
       {std::size_t{1} << 30, std::size_t{1} << 31, std::size_t{1} << 40}) {
    TetMapView view = one;
    view.tets = std::span(one.tets.data(), tets);
    view.parameters = std::span(one.parameters.data(), tets);
    const CheckReport report = check(view);
    ASSERT_EQ(report.defects.size(), 1U);
    EXPECT_EQ(report.defects[0].code, ErrorCode::TooLarge);
    Context context;
    EXPECT_EQ(codeOf([&] { static_cast<void>(extract(view)); }), ErrorCode::TooLarge);
    EXPECT_EQ(codeOf([&] { static_cast<void>(extractPartial(view, {}, context)); }),
              ErrorCode::TooLarge);
    EXPECT_FALSE(verify(view, {}).passed());
  }
}

/// 12 unit lengths of singular edges each.
TEST(Limits, ManyComponents) {
  HEXHEX_LARGE_TEST();
  const auto count = static_cast<std::size_t>(cases(1 << 18));
  const TetMap map = separateCubes(count);
  const HexMesh mesh = extract(map);
  EXPECT_EQ(mesh.cells.size(), count);
  const VerifyReport report = verify(map, mesh);
  EXPECT_TRUE(report.passed()) << failures(report);
}

/// The lattice has 2^50 points per unit length here: 64 bits hold 8,191 unit lengths.
TEST(Limits, LengthOfSingularEdgesBeyond64Bits) {
  constexpr std::size_t kCubes = 1000;
  const HexMesh mesh = verifiedExtraction(separateCubes(kCubes));
  EXPECT_EQ(mesh.cells.size(), kCubes);
}

}  // namespace

}  // namespace hexhex::test
