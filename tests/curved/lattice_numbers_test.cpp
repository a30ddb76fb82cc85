// Vertices by grid point: from tables of boxes and from swept lines, for all points in and around
// the tets.
#include <curved/lattice_numbers.hpp>
#include <gtest/gtest.h>

#include <base/stage.hpp>
#include <map/defects.hpp>

#include "curved/curved_maps.hpp"

namespace hexhex::test {

namespace {

/// How many points were asked for.
struct PointCounts {
  std::size_t found = 0;
  std::size_t missed = 0;
};

void compareTables(const TetMap& given, PointCounts& counts) {
  Context context(2);
  DefectCollector defects;
  const PreparedMap map = prepareMap(given, 1e-3, 1, context, defects);
  defects.throwIfAny();
  Stage stage(context, "numbers");
  const LatticeNumbers lines(map, 0, stage);  // no box has room
  const LatticeNumbers some(map, 2, stage);
  const LatticeNumbers tables(map, stage);
  std::vector<bool> seen(tables.count());
  for (std::size_t t = 0; t < map.topology.tetCount(); ++t) {
    const auto tet = static_cast<Index>(t);
    const LatticeTet& corners = map.exact.corners[t];
    GridBox box = gridBox(corners, map.exact.unit);
    for (GridRange& range : box.range) range = {range.first - 2, range.last + 2};
    for (std::int32_t x = box.range[0].first; x <= box.range[0].last; ++x) {
      for (std::int32_t y = box.range[1].first; y <= box.range[1].last; ++y) {
        for (std::int32_t z = box.range[2].first; z <= box.range[2].last; ++z) {
          const GridPoint point = {x, y, z};
          const LatticePoint place = {x * map.exact.unit, y * map.exact.unit, z * map.exact.unit};
          const CornerMask simplex =
              simplexBySides([&](std::size_t face) { return sideOfFace(corners, face, place); });
          for (const LatticeNumbers* numbers : {&lines, &some, &tables}) {
            const LatticeNumbers::Found found = numbers->find(tet, point);
            ASSERT_EQ(found.vertex == kNone, simplex == kNoSimplex);
            ASSERT_EQ(found.vertex, lines.find(tet, point).vertex);
            if (found.vertex != kNone) {
              ASSERT_EQ(found.simplex, simplex);
              ASSERT_TRUE(numbers->hasVertices(tet));
              seen[found.vertex] = true;
            }
          }
          ++(simplex == kNoSimplex ? counts.missed : counts.found);
        }
      }
    }
  }
  for (std::size_t v = 0; v < seen.size(); ++v) ASSERT_TRUE(seen[v]) << v;
}

TEST(LatticeNumbers, TablesHaveWhatLinesHave) {
  PointCounts counts;
  for (const CurvedMap& map : generatedMaps()) {
    SCOPED_TRACE(map.name);
    ASSERT_NO_FATAL_FAILURE(compareTables(map.map, counts));
  }
  EXPECT_GT(counts.found, 1000U);
  EXPECT_GT(counts.missed, 1000U);
}

}  // namespace
}  // namespace hexhex::test
