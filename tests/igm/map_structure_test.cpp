// findMapStructure(): chart jumps that carry parameters over, singular edges that check() counts.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <hexhex/check.hpp>
#include <hexhex/map_structure.hpp>

#include "map_samples.hpp"

namespace hexhex {
namespace {

class MapStructureOf : public test::EveryKind {};

TetMap sampleMap(SampleKind kind, ChartStyle charts, double offset = 0) {
  SampleOptions options;
  options.charts = charts;
  options.jitter = 0.3;
  options.offset = offset;
  return generateSample(kind, options).map;
}

/// u1 = R u0 + t at the three corners of the face.
void expectTransition(const TetMap& map, const ChartJump& jump) {
  EXPECT_LT(jump.tets[0], jump.tets[1]);
  for (const Index vertex : jump.vertices) {
    std::array<Vec3, 2> u{};
    for (std::size_t side = 0; side < 2; ++side) {
      const Tet& tet = map.tets[jump.tets[side]];
      const auto* const at = std::find(tet.begin(), tet.end(), vertex);
      ASSERT_NE(at, tet.end());
      u[side] = map.parameters[jump.tets[side]][static_cast<std::size_t>(at - tet.begin())];
    }
    for (std::size_t row = 0; row < 3; ++row) {
      double image = jump.translation[row];
      for (std::size_t k = 0; k < 3; ++k) image += jump.rotation[row][k] * u[0][k];
      EXPECT_NEAR(image, u[1][row], 1e-6);
      EXPECT_EQ(jump.translation[row], std::nearbyint(jump.translation[row]));
    }
  }
}

int determinant(const ChartJump& jump) {
  const auto& r = jump.rotation;
  return r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) -
         r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0]) +
         r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
}

void expectStructure(const TetMap& map) {
  Context context(1);
  const MapStructure structure = findMapStructure(map, 1e-2, context);
  const CheckReport report = check(map, {}, context);
  EXPECT_TRUE(structure.defects.empty());
  for (const ChartJump& jump : structure.chartJumps) {
    expectTransition(map, jump);
    EXPECT_EQ(determinant(jump), 1);
  }
  std::map<int, std::uint64_t> inner;
  std::map<int, std::uint64_t> boundary;
  for (const SingularTetEdge& edge : structure.singularEdges) {
    EXPECT_LT(edge.vertex0, edge.vertex1);
    ++(edge.boundary ? boundary : inner)[edge.valence];
  }
  EXPECT_EQ(inner, report.innerSingularTetEdges);
  EXPECT_EQ(boundary, report.boundarySingularTetEdges);
}

TEST_P(MapStructureOf, SamplesOfAnyCharts) {
  for (const ChartStyle charts : test::kChartStyles) {
    const TetMap map = sampleMap(kind(), charts);
    expectStructure(map);
    Context context(1);
    EXPECT_EQ(findMapStructure(map, 1e-2, context).chartJumps.size(),
              check(map, {}, context).chartJumps);
  }
}

TEST_P(MapStructureOf, ReflectionsAndFarCharts) {
  TetMap map = sampleMap(kind(), ChartStyle::Random, 1e6);
  expectStructure(map);
  for (TetParameters& tet : map.parameters) {
    for (Vec3& u : tet) u[1] = -u[1];
  }
  expectStructure(map);
}

INSTANTIATE_TEST_SUITE_P(Kinds, MapStructureOf, testing::ValuesIn(sampleKinds()),
                         test::kindTestName);

TEST(MapStructure, TellsWhatIsWrong) {
  TetMap map = sampleMap(SampleKind::Box, ChartStyle::Aligned);
  map.tets.front()[0] = 1000000;
  Context context(1);
  const MapStructure structure = findMapStructure(map, 1e-2, context);
  ASSERT_FALSE(structure.defects.empty());
  EXPECT_EQ(structure.defects.front().code, ErrorCode::IndexOutOfRange);
  EXPECT_TRUE(structure.chartJumps.empty());
  EXPECT_TRUE(structure.singularEdges.empty());
}

}  // namespace
}  // namespace hexhex
