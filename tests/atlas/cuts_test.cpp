// Jumps, what cells remember of cuts, boxes of bricks: each against its definition.
#include <algorithm>
#include <array>
#include <rapidcheck.h>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <atlas/brick_box.hpp>
#include <atlas/charts.hpp>
#include <atlas/cut_cells.hpp>
#include <atlas/jumps.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

namespace {

Gauge anyGauge() {
  Gauge gauge{Rotation(*rc::gen::inRange(0, Rotation::kCount)), {}};
  for (std::uint32_t& t : gauge.translation) t = *rc::gen::arbitrary<std::uint32_t>();
  return gauge;
}

ChartPoint anyPoint() {
  return {*rc::gen::arbitrary<std::uint32_t>(), *rc::gen::arbitrary<std::uint32_t>(),
          *rc::gen::arbitrary<std::uint32_t>()};
}

TEST(Gauge, QuotientTakesTheOnePictureToTheOther) {
  EXPECT_TRUE(rc::check("(a / b)(b(u)) = a(u)", [] {
    const Gauge a = anyGauge();
    const Gauge b = anyGauge();
    const ChartPoint u = anyPoint();
    RC_ASSERT((a / b)(b(u)) == a(u));
  }));
}

TEST(Gauge, CornersOfACellAreCornersOfItsImage) {
  EXPECT_TRUE(rc::check("a cell's corners turn with it", [] {
    const Gauge gauge = anyGauge();
    const ChartPoint cell = anyPoint();
    const auto corner = *rc::gen::inRange<std::size_t>(0, 8);
    const CellCornerSet image = turned(gauge.rotation, CellCornerSet{1} << corner);
    RC_ASSERT(std::popcount(image) == 1);
    const auto imageCorner = static_cast<std::size_t>(std::countr_zero(image));
    RC_ASSERT(plus(gauge.cell(cell), kCellCorners[imageCorner]) ==
              gauge(plus(cell, kCellCorners[corner])));
  }));
}

/// One cut in front of some corners.
struct Added {
  CellCornerSet corners;
  JumpId jump;
};

/// The definition of what a cell should say of a corner.
JumpId commonJump(const std::vector<Added>& cuts, std::size_t corner) {
  JumpId common = kNoJump;
  for (const Added& cut : cuts) {
    if (((cut.corners >> corner) & 1U) == 0) continue;
    common = common == kNoJump || common == cut.jump ? cut.jump : kManyJumps;
  }
  return common;
}

/// All jumps that it should name, or none if it cannot.
std::set<JumpId> jumpsAt(const std::vector<Added>& cuts, std::size_t corner) {
  std::set<JumpId> jumps;
  for (const Added& cut : cuts) {
    if (((cut.corners >> corner) & 1U) != 0) jumps.insert(cut.jump);
  }
  return jumps;
}

std::vector<Added> anyCuts(int jumps) {
  std::vector<Added> cuts;
  for (int i = *rc::gen::inRange(0, 12); i > 0; --i) {
    cuts.push_back({*rc::gen::inRange<CellCornerSet>(1, 256),
                    static_cast<JumpId>(*rc::gen::inRange(1, jumps + 1))});
  }
  return cuts;
}

TEST(CutCell, KnowsTheJumpOfEachCorner) {
  EXPECT_TRUE(rc::check("of two jumps everything, of more never too little", [] {
    const int jumps = *rc::gen::inRange(1, 5);
    const std::vector<Added> cuts = anyCuts(jumps);
    CutCell cell;
    for (const Added& cut : cuts) cell = cell.with(cut.corners, cut.jump);
    RC_ASSERT(cell.isCut() == !cuts.empty());
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const JumpId expected = commonJump(cuts, corner);
      const bool isMany = jumps > 2 && expected != kNoJump && cell.jump(corner) == kManyJumps;
      RC_ASSERT(cell.jump(corner) == expected || isMany);
      RC_ASSERT((((cell.corners() >> corner) & 1U) != 0) == (expected != kNoJump));
      const auto named = cell.jumps(corner);
      std::set<JumpId> found(named.begin(), named.end());
      found.erase(kNoJump);
      RC_ASSERT(found == jumpsAt(cuts, corner) || (jumps > 2 && found.count(kManyJumps) != 0));
    }
  }));
}

TEST(CutCells, AreTheSameWhateverThreadComesFirst) {
  constexpr std::size_t kPlace = 77;
  EXPECT_TRUE(rc::check("two threads mark one cell", [] {
    const std::vector<Added> cuts = anyCuts(2);
    CutCells cells;
    cells.clear();
    const auto addEvery = [&](std::size_t first) {
      for (std::size_t i = first; i < cuts.size(); i += 2) {
        cells.add(kPlace, cuts[i].corners, cuts[i].jump);
      }
    };
    std::thread other(addEvery, 1);
    addEvery(0);
    other.join();
    for (std::size_t corner = 0; corner < 8; ++corner) {
      RC_ASSERT(cells.cells[kPlace].jump(corner) == commonJump(cuts, corner));
    }
    RC_ASSERT(!cells.cells[kPlace + 1].isCut());
  }));
}

/// The jump leads from the picture on one side of a face to the other, and its inverse back.
TEST(Jumps, TakePicturesOfFacesToEachOther) {
  for (const SampleKind kind : {SampleKind::Star, SampleKind::Sphere, SampleKind::Torus}) {
    SampleOptions options;
    options.cells = 3;
    options.refine = 2;
    options.charts = ChartStyle::Random;
    const Sample sample = generateSample(kind, options);
    Context context(1);
    DefectCollector defects;
    const PreparedMap map = prepareMap(sample.map, 1e-2, 1, context, defects);
    Stage stage(context, "charts");
    const Charts charts = buildCharts(map, stage);
    Jumps jumps;
    std::set<JumpId> ids;
    for (std::size_t h = 0; h < map.topology.mate.size(); ++h) {
      const auto halfFace = static_cast<HalfFace>(h);
      const HalfFace mate = map.topology.mate[h];
      if (mate == kNone || charts.isGlued(map.topology, map.exact.transitions, halfFace)) continue;
      const JumpId id = jumps.across(map, charts, halfFace);
      ASSERT_NE(id, kNoJump);
      ASSERT_NE(id, kManyJumps);
      ids.insert(id);
      EXPECT_EQ(jumps[id].inverse, jumps.across(map, charts, mate));
      const GridPoint u = {3, -5, 8};
      const GridPoint across = map.exact.transitions.across(halfFace)(u);
      EXPECT_EQ(jumps[id].map(charts.gauge(tetOf(halfFace))(u)), charts.gauge(tetOf(mate))(across));
    }
    EXPECT_FALSE(ids.empty());
    EXPECT_LT(ids.size(), 100U);
  }
}

TEST(BrickBox, ContainsTheBricksThatItVisits) {
  EXPECT_TRUE(rc::check("keys in a box, across the modulus, too", [] {
    GridBox box;
    for (GridRange& range : box.range) {
      range.first = *rc::gen::arbitrary<std::int32_t>() / 4;
      range.last = range.first + *rc::gen::inRange(0, 30);
    }
    const Index chart = *rc::gen::element<Index>(0, 1, 70000);
    const BrickBox bricks(box, anyGauge());
    std::set<BrickKey> keys;
    bricks.forEach([&](const ChartPoint& c) { keys.insert(brickKey(chart, c)); });
    RC_ASSERT(keys.size() == bricks.count());
    RC_ASSERT(std::all_of(keys.begin(), keys.end(),
                          [&](BrickKey key) { return bricks.mayContain(chart, key); }));
    const BrickKey other = brickKey(chart, anyPoint());
    RC_ASSERT(other == 0 || keys.contains(other) == bricks.mayContain(chart, other));
    RC_ASSERT(!bricks.mayContain(chart + 1, other == 0 ? 1 : other));
  }));
}

}  // namespace
}  // namespace hexhex::test
