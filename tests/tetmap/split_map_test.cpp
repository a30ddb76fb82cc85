// Edges of maps are split with all that is known of the map.
#include <algorithm>

#include <gtest/gtest.h>
#include <tetmap/split_map.hpp>

#include <hexhex/context.hpp>
#include <hexhex/samples.hpp>

namespace hexhex::tetmap {
namespace {

TEST(SplitMap, CarriesEveryArray) {
  SampleOptions options;
  options.refine = 2;
  options.features = true;
  const TetMap before = generateSample(SampleKind::Box, options).map;
  TetMap map = before;
  map.regions.clear();
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    map.regions.push_back(static_cast<std::int32_t>(t));
  }
  map.rotations.assign(map.tets.size(), {0, 0, 0, 0});
  Context context;
  Stage stage(context, "topology");
  auto topology = adjacency::manifoldTopology(before.tets, before.points.size(), stage);
  ASSERT_TRUE(topology);
  // A feature edge first; the second is in the way of the third, which has a tet in common with it.
  const std::array<Index, 2> feature = before.features.edges[0].vertices;
  const auto at = std::find_if(before.tets.begin(), before.tets.end(), [&](const Tet& tet) {
    return std::count(tet.begin(), tet.end(), feature[0]) +
               std::count(tet.begin(), tet.end(), feature[1]) ==
           2;
  });
  ASSERT_NE(at, before.tets.end());
  const auto tet = static_cast<Index>(at - before.tets.begin());
  const auto end = std::find_if(at->begin(), at->end(),
                                [&](Index v) { return v != feature[0] && v != feature[1]; });
  map.edgeValences = {{feature[1], feature[0], 1}, {*end, feature[0], 2}};
  const std::vector<EdgeInTet> edges = {{pairOf(feature[0], feature[1]), tet},
                                        {pairOf(feature[0], *end), tet}};
  ASSERT_EQ(splitEdges(map, *topology, edges), 1U);
  const auto middle = static_cast<Index>(before.points.size());
  ASSERT_EQ(map.points.size(), middle + 1U);
  EXPECT_EQ(map.points[middle], middleOf(before.points[feature[0]], before.points[feature[1]]));
  ASSERT_GT(map.tets.size(), before.tets.size());
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    const auto parent = static_cast<std::size_t>(map.regions[t]);
    const auto corner = std::find(map.tets[t].begin(), map.tets[t].end(), middle);
    if (corner == map.tets[t].end()) {
      EXPECT_EQ(map.tets[t], before.tets[parent]);
      EXPECT_EQ(map.parameters[t], before.parameters[parent]);
      continue;
    }
    // One of the two ends is missing; at its place is the middle, of the parameters, too.
    const auto c = static_cast<std::size_t>(corner - map.tets[t].begin());
    const Tet& whole = before.tets[parent];
    const Index other = feature[whole[c] == feature[0] ? 1 : 0];
    const auto o =
        static_cast<std::size_t>(std::find(whole.begin(), whole.end(), other) - whole.begin());
    EXPECT_EQ(map.parameters[t][c],
              middleOf(before.parameters[parent][c], before.parameters[parent][o]));
    for (std::size_t i = 0; i < 4; ++i) {
      // Opposite the end that is left, the other part: nothing is known there.
      EXPECT_EQ(map.rotations[t][i], i == o ? -1 : 0);
    }
  }
  ASSERT_EQ(map.features.edges.size(), before.features.edges.size() + 1);
  EXPECT_EQ(map.features.edges.back().tag, before.features.edges[0].tag);
  const auto pairs = [&](const FeatureEdge& edge) {
    return pairOf(edge.vertices[0], edge.vertices[1]);
  };
  std::vector<VertexPair> halves = {pairs(map.features.edges[0]), pairs(map.features.edges.back())};
  std::sort(halves.begin(), halves.end());
  std::vector<VertexPair> expected = {pairOf(feature[0], middle), pairOf(feature[1], middle)};
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(halves, expected);
  std::size_t faces = 0;  // two of each that has the edge
  for (const FeatureFace& face : map.features.faces) {
    const auto& v = face.vertices;
    EXPECT_LT(
        std::count(v.begin(), v.end(), feature[0]) + std::count(v.begin(), v.end(), feature[1]), 2);
    faces += static_cast<std::size_t>(std::count(v.begin(), v.end(), middle));
  }
  EXPECT_EQ(faces, 2 * (map.features.faces.size() - before.features.faces.size()));
  ASSERT_EQ(map.edgeValences.size(), 3U);
  EXPECT_EQ(pairOf(map.edgeValences[0].vertex0, map.edgeValences[0].vertex1),
            pairOf(std::min(feature[0], feature[1]), middle));
  EXPECT_EQ(map.edgeValences[2].offset, 1);
  EXPECT_EQ(map.edgeValences[1].offset, 2);
}

}  // namespace
}  // namespace hexhex::tetmap
