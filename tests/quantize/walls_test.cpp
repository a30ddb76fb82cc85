// Walls of the motorcycle complex that pass very near to vertices, and to each other.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include "extract/support.hpp"
#include "lattice/random.hpp"
#include "support/effort.hpp"

namespace hexhex::test::walls {

using testing::LatticeRandom;

namespace {

constexpr int kCubes = 3;  // along an edge of each of eight blocks
constexpr std::array<std::array<std::size_t, 2>, 6> kEdges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// Vertices of an n x n x n grid of cubes, moved a little, and edges between some of them, each
/// along an axis and to be kept: walls begin there in planes that nearly are one.
struct NearlyIntegerBox {
  std::vector<Vec3> parameters;
  std::vector<FeatureEdge> edges;
};

NearlyIntegerBox nearlyInteger(const TetMap& map, double distance, std::uint64_t oneIn,
                               LatticeRandom& random) {
  NearlyIntegerBox box;
  box.parameters.resize(map.points.size());
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) box.parameters[map.tets[t][i]] = map.parameters[t][i];
  }
  const std::vector<Vec3> whole = box.parameters;
  const auto ends = std::minmax_element(whole.begin(), whole.end());
  const auto isInner = [&](Index v, std::size_t k) {
    return whole[v][k] != (*ends.first)[k] && whole[v][k] != (*ends.second)[k];
  };
  for (Index v = 0; v < whole.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double share = static_cast<double>(random.between(-1000, 1000)) / 1000;
      if (isInner(v, k)) box.parameters[v][k] += share * distance;
    }
  }
  std::vector<bool> isUsed(whole.size());
  for (std::size_t i = 0; i < 6 * map.tets.size(); ++i) {
    const Tet& tet = map.tets[i / 6];
    const Index a = tet[kEdges[i % 6][0]];
    const Index b = tet[kEdges[i % 6][1]];
    std::size_t along = 0;
    while (along < 3 && whole[a][along] == whole[b][along]) ++along;
    const std::size_t k = (along + 1) % 3;
    const std::size_t l = (along + 2) % 3;
    if (along == 3 || whole[a][k] != whole[b][k] || whole[a][l] != whole[b][l]) continue;
    if (isUsed[a] || isUsed[b] || !random.oneIn(oneIn)) continue;
    isUsed[a] = isUsed[b] = true;
    for (const std::size_t across : {k, l}) box.parameters[b][across] = box.parameters[a][across];
    box.edges.push_back({{a, b}, 1});
  }
  return box;
}

TEST(Walls, MayPassNearVertices) {
  HEXHEX_LARGE_TEST();
  const TetMap whole =
      generateSample(SampleKind::Box,
                     {.cells = kCubes, .refine = kCubes, .charts = ChartStyle::Aligned})
          .map;
  for (const double distance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    for (const std::uint64_t oneIn : {50U, 200U}) {
      SCOPED_TRACE(std::to_string(distance) + ", one edge in " + std::to_string(oneIn));
      LatticeRandom random(oneIn);
      const NearlyIntegerBox box = nearlyInteger(whole, distance, oneIn, random);
      ASSERT_GT(box.edges.size(), 5U);
      TetMap map = whole;
      for (std::size_t t = 0; t < map.tets.size(); ++t) {
        for (std::size_t i = 0; i < 4; ++i) map.parameters[t][i] = box.parameters[map.tets[t][i]];
      }
      map.features.edges = box.edges;
      const QuantizedMap result = quantize(map, {.scale = 1});
      EXPECT_EQ(verifiedExtraction(result.map, {.tolerance = 0}).cells.size(), result.report.cells);
    }
  }
}

}  // namespace

}  // namespace hexhex::test::walls
