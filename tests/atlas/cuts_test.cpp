// Transitions across cuts, and what cells remember of them, against their definitions.
#include <algorithm>
#include <array>
#include <rapidcheck.h>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <atlas/brick_grid.hpp>
#include <atlas/charts.hpp>
#include <atlas/cut_marks.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

using namespace atlas;

namespace {

lattice::Gauge anyGauge() {
  lattice::Gauge gauge{lattice::Rotation(*rc::gen::inRange(0, lattice::Rotation::kCount)), {}};
  for (std::uint32_t& t : gauge.translation) t = *rc::gen::arbitrary<std::uint32_t>();
  return gauge;
}

lattice::ChartPoint anyPoint() {
  return {*rc::gen::arbitrary<std::uint32_t>(), *rc::gen::arbitrary<std::uint32_t>(),
          *rc::gen::arbitrary<std::uint32_t>()};
}

TEST(Gauge, CornersOfACellAreCornersOfItsImage) {
  EXPECT_TRUE(rc::check("a cell's corners turn with it", [] {
    const lattice::Gauge gauge = anyGauge();
    const lattice::ChartPoint cell = anyPoint();
    const auto corner = *rc::gen::inRange<std::size_t>(0, 8);
    const lattice::CellCornerSet image =
        lattice::turned(gauge.rotation, lattice::CellCornerSet{1} << corner);
    RC_ASSERT(std::popcount(image) == 1);
    const auto imageCorner = static_cast<std::size_t>(std::countr_zero(image));
    RC_ASSERT(lattice::plus(gauge.cell(cell), lattice::kCellCorners[imageCorner]) ==
              gauge(lattice::plus(cell, lattice::kCellCorners[corner])));
  }));
}

/// One cut in front of some corners.
struct Added {
  lattice::CellCornerSet corners;
  CutTransitionId transition;
};

/// The definition of what a cell should say of a corner.
CutTransitionId commonTransition(const std::vector<Added>& cuts, std::size_t corner) {
  CutTransitionId common = kNoCut;
  for (const Added& cut : cuts) {
    if (((cut.corners >> corner) & 1U) == 0) continue;
    common = common == kNoCut || common == cut.transition ? cut.transition : kAnyCuts;
  }
  return common;
}

std::vector<Added> anyCuts(int transitions) {
  std::vector<Added> cuts;
  for (int i = *rc::gen::inRange(0, 12); i > 0; --i) {
    cuts.push_back({*rc::gen::inRange<lattice::CellCornerSet>(1, 256),
                    static_cast<CutTransitionId>(*rc::gen::inRange(1, transitions + 1))});
  }
  return cuts;
}

TEST(CutCell, KnowsTheTransitionOfEachCorner) {
  EXPECT_TRUE(rc::check("of two transitions everything, of more never too little", [] {
    const int transitions = *rc::gen::inRange(1, 5);
    const std::vector<Added> cuts = anyCuts(transitions);
    CutCell cell;
    for (const Added& cut : cuts) cell = cell.with(cut.corners, cut.transition);
    RC_ASSERT(cell.isCut() == !cuts.empty());
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const CutTransitionId expected = commonTransition(cuts, corner);
      const CutTransitionId found = cell.transition(corner);
      RC_ASSERT(found == expected || (transitions > 2 && expected != kNoCut && found == kAnyCuts));
      RC_ASSERT((((cell.corners() >> corner) & 1U) != 0) == (expected != kNoCut));
    }
  }));
}

TEST(CutCells, AreTheSameWhateverThreadComesFirst) {
  constexpr std::size_t kPlace = 77;
  EXPECT_TRUE(rc::check("two threads mark one cell", [] {
    const std::vector<Added> cuts = anyCuts(2);
    CutCells cells;
    const auto addEvery = [&](std::size_t first) {
      for (std::size_t i = first; i < cuts.size(); i += 2) {
        cells.add(kPlace, cuts[i].corners, cuts[i].transition);
      }
    };
    std::thread other(addEvery, 1);
    addEvery(0);
    other.join();
    for (std::size_t corner = 0; corner < 8; ++corner) {
      RC_ASSERT(cells.cells[kPlace].transition(corner) == commonTransition(cuts, corner));
    }
    RC_ASSERT(!cells.cells[kPlace + 1].isCut());
  }));
}

/// The transition leads from the chart on one side of a face to the other, and its inverse back.
TEST(CutTransitions, TakeChartsToEachOther) {
  for (const SampleKind kind : {SampleKind::Star, SampleKind::Sphere, SampleKind::Torus}) {
    SampleOptions options;
    options.cells = 3;
    options.refine = 2;
    options.charts = ChartStyle::Random;
    const Sample sample = generateSample(kind, options);
    Context context(1);
    igm::DefectCollector defects;
    const igm::PreparedMap map = igm::prepareMap(sample.map, 1e-2, 1, context, defects);
    Stage stage(context, "charts");
    const Charts charts = buildCharts(map, stage);
    CutTransitions transitions;
    std::set<CutTransitionId> ids;
    for (std::size_t h = 0; h < map.topology.mate.size(); ++h) {
      const auto halfFace = static_cast<adjacency::HalfFace>(h);
      const adjacency::HalfFace mate = map.topology.mate[h];
      if (mate == kNone || charts.isGlued(map.topology, map.exact.transitions, halfFace)) continue;
      const CutTransitionId id = transitions.across(map, charts, halfFace);
      ASSERT_NE(id, kNoCut);
      ASSERT_NE(id, kAnyCuts);
      ids.insert(id);
      EXPECT_EQ(transitions[id].inverse, transitions.across(map, charts, mate));
      const lattice::GridPoint u = {3, -5, 8};
      const lattice::GridPoint across = map.exact.transitions.across(halfFace)(u);
      EXPECT_EQ(transitions[id].map(charts.gauge(adjacency::tetOf(halfFace))(u)),
                charts.gauge(adjacency::tetOf(mate))(across));
    }
    EXPECT_FALSE(ids.empty());
    EXPECT_LT(ids.size(), 100U);
  }
}

}  // namespace
}  // namespace hexhex::test
