// Charts along trees, against ways that are known.
#include <algorithm>
#include <numeric>
#include <rapidcheck.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <lattice/charts_along_trees.hpp>
#include <lattice/grid_motion.hpp>

namespace hexhex::lattice {
namespace {

using Links = std::vector<std::vector<Index>>;

/// Charts of pieces that differ as `given` says, so that all ways lead to the same one.
/// @param given  per piece: from its chart into a common one
TreeCharts<LatticeMotion> chartsOf(const Links& links, const std::vector<LatticeMotion>& given) {
  return chartsAlongTrees<LatticeMotion>(links.size(), [&](Index piece, const auto& visit) {
    for (const Index other : links[piece]) {
      visit(other, [&](const LatticeMotion& toTree) {
        return toTree * (given[piece].inverse() * given[other]);
      });
    }
  });
}

std::vector<LatticeMotion> anyMotions(std::size_t count) {
  std::vector<LatticeMotion> motions(count);
  for (LatticeMotion& motion : motions) {
    motion.rotation = Rotation(*rc::gen::inRange(0, Rotation::kCount));
    for (std::int64_t& t : motion.translation) t = *rc::gen::inRange(-1000, 1000);
  }
  return motions;
}

RC_GTEST_PROP(ChartsAlongTrees, AreThoseOfTheRoots, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(0, 12);
  Links links(count);
  for (Index a = 0; a < count; ++a) {
    for (Index b = 0; b < a; ++b) {
      if (*rc::gen::inRange(0, 6) != 0) continue;
      links[a].push_back(b);
      links[b].push_back(a);
    }
  }
  const std::vector<LatticeMotion> given = anyMotions(count);
  const TreeCharts<LatticeMotion> charts = chartsOf(links, given);
  std::vector<Index> roots;
  for (Index piece = 0; piece < count; ++piece) {
    if (charts.tree[piece] == roots.size()) roots.push_back(piece);
    const Index root = roots.at(charts.tree[piece]);
    RC_ASSERT(charts.motions[piece] == given[root].inverse() * given[piece]);
    for (const Index other : links[piece]) RC_ASSERT(charts.tree[other] == charts.tree[piece]);
  }
  RC_ASSERT(charts.trees == roots.size());
  std::vector<Index> order = charts.order;
  std::sort(order.begin(), order.end());
  std::vector<Index> all(count);
  std::iota(all.begin(), all.end(), Index{0});
  RC_ASSERT(order == all);
}

/// Of a ring in which ways differ, the shorter one counts, and the first of two.
TEST(ChartsAlongTrees, AreFoundBreadthFirst) {
  constexpr Index kPieces = 6;
  int asked = 0;
  const auto step = [](std::int64_t x) { return LatticeMotion{Rotation(), {x, 0, 0}}; };
  const TreeCharts<LatticeMotion> charts = chartsAlongTrees<LatticeMotion>(
      kPieces, [&](Index /*root*/) { return step(100); },
      [&](Index piece, const auto& visit) {
        const auto to = [&](Index other, std::int64_t x) {
          visit(other, [&, x](const LatticeMotion& toTree) {
            ++asked;
            return toTree * step(x);
          });
        };
        to((piece + 1) % kPieces, 1);
        to((piece + kPieces - 1) % kPieces, 10);
      });
  EXPECT_EQ(charts.order, (std::vector<Index>{0, 1, 5, 2, 4, 3}));
  const std::vector<std::int64_t> expected = {100, 101, 102, 103, 120, 110};
  for (Index piece = 0; piece < kPieces; ++piece) {
    EXPECT_EQ(charts.motions[piece], step(expected[piece]));
  }
  EXPECT_EQ(asked, 5);
  EXPECT_EQ(charts.trees, 1U);
}

}  // namespace
}  // namespace hexhex::lattice
