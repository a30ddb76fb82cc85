// Charts may be anywhere, as long as doubles hold the parameters there.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <hexhex/check.hpp>
#include <hexhex/map_structure.hpp>

#include "extract/support.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

namespace {

/// Parameters are multiples of 1/4.
TetMap quarters(ChartStyle charts) {
  SampleOptions options;
  options.cells = 2;
  options.refine = 2;
  options.charts = charts;
  TetMap map = generateSample(SampleKind::Sphere, options).map;
  for (const TetParameters& u : map.parameters) {
    for (const Vec3& corner : u) {
      for (const double x : corner) EXPECT_EQ(4 * x, std::round(4 * x));
    }
  }
  return map;
}

/// Moves charts by integers up to `offset`.
/// @param each  each on its own
TetMap moved(TetMap map, double offset, bool each) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  Vec3 by = {std::round(offset), std::round(-offset / 3), std::round(offset / 7)};
  for (TetParameters& u : map.parameters) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (each) by[k] = std::round(offset * anywhere(random));
      for (Vec3& corner : u) corner[k] += by[k];
    }
  }
  return map;
}

TEST(FarCharts, GiveTheSameMesh) {
  for (const ChartStyle style : {ChartStyle::Aligned, ChartStyle::Random}) {
    const TetMap near = quarters(style);
    const HexMesh expected = verifiedExtraction(near);
    for (const double offset : {1e6, 1e9, 1e12, 0x1p48, 1e15, 0x1p50, 0x1p51 - 100}) {
      SCOPED_TRACE(offset);
      for (const bool each : {false, true}) {
        const HexMesh mesh = verifiedExtraction(moved(near, offset, each));
        EXPECT_EQ(mesh.cells.size(), expected.cells.size());
        EXPECT_TRUE(sameUpToNumbering(mesh, expected));
      }
    }
  }
}

/// Only integers are left there, and this map has no others.
TEST(FarCharts, OfIntegersGoTo2To53) {
  SampleOptions options;
  options.cells = 4;
  options.refine = 2;
  const TetMap near = generateSample(SampleKind::Box, options).map;
  const HexMesh expected = verifiedExtraction(near);
  for (const double offset : {0x1p52, 0x1p53 - 100}) {
    for (const bool each : {false, true}) {
      const TetMap far = moved(near, offset, each);
      EXPECT_TRUE(sameUpToNumbering(verifiedExtraction(far), expected));
      if (offset > 0x1p52) continue;  // translations are twice as large
      Context context;
      for (const ChartJump& jump : findMapStructure(far, 1e-2, context).chartJumps) {
        // In long double, which holds sums of such integers.
        for (const Index v : jump.vertices) {
          std::array<Vec3, 2> u{};
          for (std::size_t side = 0; side < 2; ++side) {
            for (std::size_t c = 0; c < 4; ++c) {
              if (far.tets[jump.tets[side]][c] == v) u[side] = far.parameters[jump.tets[side]][c];
            }
          }
          for (std::size_t k = 0; k < 3; ++k) {
            long double image = jump.translation[k];
            for (std::size_t l = 0; l < 3; ++l)
              image += jump.rotation[k][l] * static_cast<long double>(u[0][l]);
            EXPECT_EQ(static_cast<double>(image), u[1][k]);
          }
        }
      }
    }
  }
}

TEST(FarCharts, ThatHaveLostTheirFractionsAreRefused) {
  EXPECT_EQ(codeOf([] {
              static_cast<void>(extract(moved(quarters(ChartStyle::Aligned), 0x1p54, false)));
            }),
            ErrorCode::TooLarge);
  const Error rounded = errorOf(
      [] { static_cast<void>(extract(moved(quarters(ChartStyle::Aligned), 0x1p53 - 100, true))); });
  EXPECT_NE(rounded.code(), ErrorCode::TooLarge);
  EXPECT_NE(rounded.code(), ErrorCode::Internal);
}

}  // namespace

}  // namespace hexhex::test
