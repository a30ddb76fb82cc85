// What is singular around damage, and how: from what damaged tets still tell, or the caller knows.
#include "repair/patch_charts.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include "igm/igm.hpp"
#include "repair/valid_tets.hpp"

namespace hexhex::test {

using namespace repairs;

namespace {

/// All edges of the patches around the bad tets of a map.
std::vector<PatchEdge> edgesAroundDamage(const TetMap& map) {
  Context context;
  Stage stage(context, "test");
  igm::DefectCollector defects;
  const igm::PreparedMap prepared = igm::prepareMap(map, 1e-2, 1, context, defects);
  const igm::LocalParameters parameters(prepared.input);
  const std::vector<Index> bad = findBadTets(map.tets.size(), parameters, stage);
  EXPECT_FALSE(bad.empty());
  std::vector<PatchEdge> edges;
  for (const std::vector<Index>& region : separateRegions(prepared.topology, bad, 2)) {
    const Patch patch = growPatch(prepared.topology, region, 2);
    const PatchCharts charts(prepared.input.view, prepared.topology, parameters, patch, 1e-2);
    EXPECT_EQ(charts.impossibleEdge(), nullptr);
    edges.insert(edges.end(), charts.edges().begin(), charts.edges().end());
  }
  return edges;
}

TEST(PatchCharts, KnowValencesInSpiteOfDamage) {
  for (const int valence : {3, 5, 7, 8}) {
    SCOPED_TRACE(valence);
    int knownBesideDamage = 0;
    int knownInDamage = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      SampleOptions options;
      options.valence = valence;
      options.refine = 2;
      options.charts = ChartStyle::Random;
      options.defects = 12;
      options.seed = seed;
      for (const PatchEdge& edge :
           edgesAroundDamage(generateSample(SampleKind::Star, options).map)) {
        if (edge.boundary || !edge.singular) continue;
        if (edge.sound) {
          EXPECT_EQ(edge.valence, valence);
          ++knownBesideDamage;
        } else {
          EXPECT_TRUE(edge.valence == valence || edge.valence == 0) << edge.valence;
          knownInDamage += edge.valence == valence ? 1 : 0;
        }
      }
    }
    EXPECT_GT(knownBesideDamage, 0);
    if (valence < 6) {
      EXPECT_GT(knownInDamage, 0);  // around more cells, no sum of angles was clear
    }
  }
}

/// A regular edge of which the caller says that there are eight cells around it.
TEST(PatchCharts, BelieveKnownValences) {
  SampleOptions options;
  options.refine = 3;
  options.defects = 4;
  TetMap map = generateSample(SampleKind::Box, options).map;
  std::vector<PatchEdge> edges = edgesAroundDamage(map);
  const auto inner = std::find_if(edges.begin(), edges.end(),
                                  [](const PatchEdge& edge) { return !edge.boundary; });
  ASSERT_NE(inner, edges.end());
  EXPECT_FALSE(inner->singular);
  map.edgeValences = {{inner->vertex1, inner->vertex0, 4}};
  int others = 0;
  for (const PatchEdge& edge : edgesAroundDamage(map)) {
    if (edge.vertex0 == inner->vertex0 && edge.vertex1 == inner->vertex1) {
      EXPECT_TRUE(edge.singular);
      EXPECT_EQ(edge.valence, 8);
    } else if (!edge.boundary) {
      EXPECT_FALSE(edge.singular);
      EXPECT_EQ(edge.valence, 4);
      ++others;
    }
  }
  EXPECT_GT(others, 0);
}

}  // namespace

}  // namespace hexhex::test
