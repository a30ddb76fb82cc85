// Loops around handles of bodies whose handles one can count, and the labels along them.
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include <gtest/gtest.h>
#include <shape/labels.hpp>
#include <shape/loop_labels.hpp>
#include <shape/positive_tets.hpp>

#include <base/disjoint_sets.hpp>
#include <base/stage.hpp>

#include "support/labelled_bodies.hpp"

namespace hexhex::shape {
namespace {

using test::CubeBody;
using Cell = CubeBody::Cell;
using Deform = std::function<Vec3(const Vec3&)>;

Vec3 unmoved(const Vec3& p) { return p; }

/// Turned such that the z axis is (1, 1, 1), and the others are no axes either.
Vec3 atAnOddAngle(const Vec3& p) {
  const double cos = std::cos(0.2);
  const double sin = std::sin(0.2);
  const Vec3 q = {cos * p[0] - sin * p[1], sin * p[0] + cos * p[1], p[2]};
  const Vec3 x = times(std::sqrt(0.5), {1, -1, 0});
  const Vec3 z = times(std::sqrt(1. / 3), {1, 1, 1});
  return plus(times(q[0], x), plus(times(q[1], cross(z, x)), times(q[2], z)));
}

CubeBody ring() {
  return {{3, 3, 1}, [](const Cell& c) { return c[0] != 1 || c[1] != 1; }};
}

struct Part {
  explicit Part(const CubeBody& body, const Deform& deform = unmoved)
      : surface(readSurface(PositiveTets(TetMesh(body.labelled(3, deform).tets)), context)) {}

  Context context;
  Surface surface;
};

bool areAdjacent(const Surface& surface, Index a, Index b) {
  return surface.beyond(3 * a) == b || surface.beyond(3 * a + 1) == b ||
         surface.beyond(3 * a + 2) == b;
}

/// Number of pieces of a surface without some triangles.
std::size_t countPieces(const Surface& surface, const std::set<Index>& without) {
  DisjointSets pieces(surface.triangleCount());
  for (Side side = 0; side < surface.tails.size(); ++side) {
    const Index here = Surface::triangleOf(side);
    if (without.contains(here) || without.contains(surface.beyond(side))) continue;
    pieces.unite(here, surface.beyond(side));
  }
  return pieces.count() - without.size();
}

void expectLoops(const CubeBody& body, std::size_t handles, const Deform& deform = unmoved) {
  Part part(body, deform);
  const std::vector<HandleLoop> loops = handleLoops(part.surface, 1, part.context);
  ASSERT_EQ(loops.size(), handles);
  std::set<Index> all;
  for (const HandleLoop& loop : loops) {
    Index last = loop.triangles.back();
    for (const Index t : loop.triangles) {
      EXPECT_TRUE(areAdjacent(part.surface, last, t));
      EXPECT_TRUE(all.insert(t).second);
      last = t;
    }
    // Labels turn once around, counterclockwise.
    const Labels labels = labelsAlong(part.surface, loop);
    const std::size_t axis = dominantAxis(loop.area);
    int quarters = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const lattice::Direction next = labels[(i + 1) % labels.size()];
      if (next == labels[i]) continue;
      ASSERT_NE(next, lattice::opposite(labels[i]));
      const lattice::Direction turn = lattice::cross(labels[i], next);
      ASSERT_EQ(lattice::axisOf(turn), static_cast<int>(axis));
      quarters += lattice::signOf(turn) * (loop.area[axis] < 0 ? -1 : 1);
    }
    EXPECT_EQ(quarters, 4);
  }
  EXPECT_EQ(countPieces(part.surface, all), 1U);
}

TEST(HandleLoops, AreOnePerHandle) {
  expectLoops({{2, 2, 2}, [](const Cell&) { return true; }}, 0);
  expectLoops(ring(), 1);
  expectLoops(ring(), 1, atAnOddAngle);
  const auto isInDouble = [](const Cell& c) { return c[1] != 1 || c[0] % 2 == 0; };
  expectLoops({{5, 3, 1}, isInDouble}, 2);
  expectLoops({{5, 3, 1}, isInDouble}, 2, atAnOddAngle);
  // A ring stands on a plate.
  expectLoops({{5, 3, 4},
               [](const Cell& c) {
                 return c[2] == 0 ||
                        (c[1] == 1 && c[0] > 0 && c[0] < 4 && (c[0] != 2 || c[2] != 2));
               }},
              1);
  // A handle hangs under a block, and a frame of cubes has many.
  expectLoops({{6, 3, 4},
               [](const Cell& c) {
                 const bool isHandle = c[1] == 1 && c[0] > 0 && c[0] < 5;
                 return c[2] == 3 || (isHandle && (c[2] == 0 || c[0] == 1 || c[0] == 4));
               }},
              1);
  expectLoops(
      {{3, 3, 3}, [](const Cell& c) { return (c[0] == 1) + (c[1] == 1) + (c[2] == 1) < 2; }}, 5);
}

TEST(HandleLoops, AreAroundHolesThatAreAsNarrowAsTheSolid) {
  Part part(ring());
  const std::vector<HandleLoop> loops = handleLoops(part.surface, 1, part.context);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(dominantAxis(loops[0].area), 2U);
  for (const Index t : loops[0].triangles) {
    const Vec3 middle = part.surface.centres[t];
    EXPECT_TRUE(middle[0] > 0.9 && middle[0] < 2.1 && middle[1] > 0.9 && middle[1] < 2.1);
  }
}

/// A ring is found once its normals are turned to the axes, and its labels are those of the loop.
TEST(HandleLoops, LeadLabelsAroundARingAtAnOddAngle) {
  Part part(ring(), atAnOddAngle);
  const std::vector<HandleLoop> loops = handleLoops(part.surface, 1, part.context);
  const Labels required = turnAroundHandles(part.surface, loops);
  LabelCosts costs(part.surface);
  costs.require(required);
  double work = 1e9;
  Stage stage(part.context, "labelling");
  const CheckedLabels found = labelsOf(part.surface, costs, 1, work, stage);
  EXPECT_TRUE(found.verdict.report.isValid());
  for (std::size_t t = 0; t < required.size(); ++t) {
    if (required[t] == lattice::kDirections) continue;
    EXPECT_EQ(found.labels[t], required[t]);
  }
}

}  // namespace
}  // namespace hexhex::shape
