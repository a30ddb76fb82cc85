// Labels that are those of a polycube, and some that are not, for one reason each.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>
#include <shape/label_check.hpp>
#include <shape/positive_tets.hpp>

#include "support/labelled_bodies.hpp"

namespace hexhex::shape {
namespace {

using test::CubeBody;
using Cell = CubeBody::Cell;

/// What is said of a body's own labels, some of them changed.
/// @param change  of a label of a triangle with that middle
Verdict verdictOf(const CubeBody& body,
                  const std::function<int(int label, const Vec3& middle)>& change) {
  const test::Labelled input = body.labelled(3, [](const Vec3& p) { return p; });
  Context context;
  const Surface surface = readSurface(PositiveTets(input.tets), context);
  Labels labels;
  for (std::size_t t = 0; t < surface.triangleCount(); ++t) {
    const adjacency::HalfFace h = surface.faces[t];
    const int label = input.flags[adjacency::tetOf(h)][h % 4];
    labels.push_back(static_cast<lattice::Direction>(change(label, surface.centres[t])));
  }
  const LabelCosts costs(surface);
  return LabelCheck(surface, costs)(labels);
}

int asItIs(int label, const Vec3& /*middle*/) { return label; }

/// A cube on the middle of a plate.
CubeBody step() {
  return {{3, 3, 2}, [](const Cell& c) { return c[2] == 0 || (c[0] == 1 && c[1] == 1); }};
}

TEST(LabelCheck, AcceptsThoseOfBodiesOfCubes) {
  const CubeBody ring = {{3, 3, 1}, [](const Cell& c) { return c[0] != 1 || c[1] != 1; }};
  const CubeBody angle = {{2, 2, 1}, [](const Cell& c) { return c[0] + c[1] < 2; }};
  for (const CubeBody& body : {step(), ring, angle}) {
    EXPECT_TRUE(verdictOf(body, asItIs).report.isValid());
  }
}

TEST(LabelCheck, RefusesFacesWithHandles) {
  // All that is below a cube is one face around a hole, whose border is the cube's.
  const CubeBody cubeOnRing = {{3, 3, 2}, [](const Cell& c) {
                                 return c[2] == 1 ? c[0] + c[1] == 0 : c[0] != 1 || c[1] != 1;
                               }};
  const Verdict verdict = verdictOf(
      cubeOnRing, [](int label, const Vec3& middle) { return middle[2] > 1.01 ? label : 5; });
  EXPECT_EQ(verdict.report.charts, 6U);
  EXPECT_EQ(verdict.report.wrongTurns, 1U);
  EXPECT_FALSE(verdict.places.empty());
}

TEST(LabelCheck, RefusesEdgesThatBeginAndEndInOnePlane) {
  // The top of the cube comes down to the plate, over the middle of a side.
  const Verdict verdict = verdictOf(step(), [](int label, const Vec3& middle) {
    return label == 0 && middle[2] > 1 && middle[1] > 1.3 && middle[1] < 1.7 ? 4 : label;
  });
  EXPECT_EQ(verdict.report.badLoops, 2U);  // what is left of the side
  // The cube's four upright edges, and two borders of what is left, which turn back, too.
  EXPECT_EQ(verdict.report.turningPoints, 4U + 2 + 2);
}

TEST(LabelCheck, RefusesCornersWithoutRoom) {
  const CubeBody cube = {{1, 1, 1}, [](const Cell&) { return true; }};
  const Verdict verdict =
      verdictOf(cube, [](int label, const Vec3& /*middle*/) { return label ^ 1; });
  EXPECT_EQ(verdict.report.badCorners, 8U);
}

TEST(LabelCheck, NamesAllBordersOfFacesThatTurnWrong) {
  // The four sides of a hole look away from it: around each, turns are to the right.
  const CubeBody ring = {{3, 3, 1}, [](const Cell& c) { return c[0] != 1 || c[1] != 1; }};
  const Verdict verdict = verdictOf(ring, [](int label, const Vec3& middle) {
    const bool isInHole = middle[0] > 0.9 && middle[0] < 2.1 && middle[1] > 0.9 && middle[1] < 2.1;
    return isInHole && label < 4 ? label ^ 1 : label;
  });
  EXPECT_EQ(verdict.report.wrongTurns, 4U);
  EXPECT_EQ(verdict.places.size(), 4 * 4 + verdict.report.badCorners);
}

TEST(LabelCheck, RefusesFacesWithoutWidth) {
  // A handle hangs from the middle of a block. Where what is below the block, in front of one leg,
  // is taken for a part of its front, all of the handle's front is; in front of the other leg, what
  // is below the block lies between two edges of one plane.
  const CubeBody block = {{6, 3, 4}, [](const Cell& c) {
                            const bool isHandle = c[1] == 1 && c[0] > 0 && c[0] < 5;
                            return c[2] == 3 || (isHandle && (c[2] == 0 || c[0] == 1 || c[0] == 4));
                          }};
  EXPECT_TRUE(verdictOf(block, asItIs).report.isValid());
  const Verdict verdict = verdictOf(block, [](int label, const Vec3& middle) {
    const bool isInFront = middle[0] > 1 && middle[0] < 2 && middle[1] < 1;
    return label == 5 && middle[2] > 2.9 && isInFront ? 3 : label;
  });
  LabelReport rest = verdict.report;
  EXPECT_EQ(rest.flatCharts, 1U);
  EXPECT_FALSE(verdict.places.empty());
  rest.flatCharts = 0;
  EXPECT_TRUE(rest.isValid());
}

TEST(LabelCheck, TakesCornersAwayFromWhereNoMapWasFound) {
  const test::Labelled input = step().labelled(3, [](const Vec3& p) { return p; });
  Context context;
  const Surface surface = readSurface(PositiveTets(input.tets), context);
  LabelCosts costs(surface);
  costs.avoidCornersAt({0, 0, 0});
  for (Index t = 0; t < surface.triangleCount(); ++t) {
    const bool isNear = length(surface.centres[t]) < 4 * surface.meanEdge;
    EXPECT_EQ(costs.ofCorner(t) > 0, isNear);
  }
}

TEST(Smoothed, NormalsOfARoughCubeAreThoseOfItsFaces) {
  const CubeBody cube = {{1, 1, 1}, [](const Cell&) { return true; }};
  const test::Labelled input = cube.labelled(12, [](const Vec3& p) {
    const double bump = 0.04 * std::sin(70 * p[0] + 110 * p[1] + 90 * p[2]);
    return Vec3{p[0] + bump, p[1] + bump, p[2] + bump};
  });
  Context context;
  const PositiveTets tets(input.tets);
  const Surface rough = readSurface(tets, context);
  const auto meanDeviation = [&](const Surface& surface) {
    double sum = 0;
    for (std::size_t t = 0; t < surface.triangleCount(); ++t) {
      const adjacency::HalfFace h = surface.faces[t];
      const int label = input.flags[adjacency::tetOf(h)][h % 4];
      sum += 1 - cosine(surface.normals[t], static_cast<lattice::Direction>(label));
    }
    return sum / static_cast<double>(surface.triangleCount());
  };
  EXPECT_GT(meanDeviation(rough), 0.12);
  EXPECT_LT(meanDeviation(smoothed(rough, tets.mesh().points, 5)), 0.06);
}

}  // namespace
}  // namespace hexhex::shape
