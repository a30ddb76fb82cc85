// Vertices by grid point: from tables of boxes and from swept lines, for all points in and around
// the tets.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <base/stage.hpp>
#include <igm/defects.hpp>
#include <sweep/vertex_tables.hpp>

#include "curved/curved_maps.hpp"

namespace hexhex::test {

namespace {

/// How many points were asked for.
struct PointCounts {
  std::size_t found = 0;
  std::size_t missed = 0;
};

/// Finds the same points in several ways.
class TableExaminer {
 public:
  TableExaminer(const igm::PreparedMap& map, PointCounts& counts, Stage& stage)
      : map_(map),
        counts_(counts),
        lines_(map, stage, 0),  // no box has room
        some_(map, stage, 2),
        tables_(map, stage),
        seen_(tables_.count()) {}

  /// All points of the bounding box and a little around it.
  void examine(Index tet) {
    const lattice::GridBox box = lattice::gridBox(map_.exact.corners[tet], map_.exact.unit);
    lattice::GridPoint z;
    for (z[0] = box.range[0].first - 2; z[0] <= box.range[0].last + 2; ++z[0]) {
      for (z[1] = box.range[1].first - 2; z[1] <= box.range[1].last + 2; ++z[1]) {
        for (z[2] = box.range[2].first - 2; z[2] <= box.range[2].last + 2; ++z[2]) {
          examine(tet, z);
        }
      }
    }
  }
  /// Every vertex is in some tet.
  [[nodiscard]] bool haveSeenAll() const {
    return std::find(seen_.begin(), seen_.end(), false) == seen_.end();
  }

 private:
  void examine(Index tet, const lattice::GridPoint& z) {
    const lattice::CornerMask simplex =
        lattice::simplexOf(map_.exact.corners[tet], z, map_.exact.unit);
    const sweep::VertexTables::Found found = tables_.find(tet, z);
    EXPECT_EQ(found.simplex, simplex);
    EXPECT_EQ(found.vertex == kNone, simplex == lattice::kNoSimplex);
    for (const sweep::VertexTables* numbers : {&lines_, &some_}) {
      const sweep::VertexTables::Found other = numbers->find(tet, z);
      EXPECT_EQ(found.simplex, other.simplex);
      EXPECT_EQ(found.vertex, other.vertex);
    }
    ++(simplex == lattice::kNoSimplex ? counts_.missed : counts_.found);
    if (found.vertex != kNone) seen_[found.vertex] = true;
  }

  const igm::PreparedMap& map_;
  PointCounts& counts_;
  sweep::VertexTables lines_;
  sweep::VertexTables some_;
  sweep::VertexTables tables_;
  std::vector<bool> seen_;
};

void compareTables(const TetMap& given, PointCounts& counts) {
  Context context(2);
  igm::DefectCollector defects;
  const igm::PreparedMap map = igm::prepareMap(given, 1e-3, 1, context, defects);
  defects.throwIfAny();
  Stage stage(context, "numbers");
  TableExaminer examiner(map, counts, stage);
  for (std::size_t t = 0; t < map.topology.tetCount(); ++t) {
    examiner.examine(static_cast<Index>(t));
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_TRUE(examiner.haveSeenAll());
}

TEST(VertexTables, HaveWhatLinesHave) {
  PointCounts counts;
  for (const CurvedMap& map : generatedMaps()) {
    SCOPED_TRACE(map.name);
    compareTables(map.map, counts);
  }
  EXPECT_GT(counts.found, 1000U);
  EXPECT_GT(counts.missed, 1000U);
}

}  // namespace
}  // namespace hexhex::test
