// Labels and normals around the sphere of directions, with sums that topology dictates.
#include <cmath>
#include <functional>
#include <numeric>

#include <gtest/gtest.h>
#include <shape/label_check.hpp>
#include <shape/label_winding.hpp>
#include <shape/positive_tets.hpp>

#include "support/labelled_bodies.hpp"

namespace hexhex::shape {
namespace {

using test::CubeBody;
using Cell = CubeBody::Cell;

Vec3 unmoved(const Vec3& p) { return p; }

/// Turned such that no normal is close to an axis.
Vec3 atAnOddAngle(const Vec3& p) {
  const Vec3 q = {0.8 * p[0] - 0.6 * p[1], 0.6 * p[0] + 0.8 * p[1], p[2]};
  return {q[0], 0.8 * q[1] - 0.6 * q[2], 0.6 * q[1] + 0.8 * q[2]};
}

struct WoundBody {
  WoundBody(const CubeBody& body, const std::function<Vec3(const Vec3&)>& deform)
      : input(body.labelled(2, deform)),
        surface(readSurface(PositiveTets(input.tets), context)),
        labels(surface.triangleCount()) {
    for (std::size_t t = 0; t < labels.size(); ++t) {
      const adjacency::HalfFace h = surface.faces[t];
      labels[t] = static_cast<lattice::Direction>(input.flags[adjacency::tetOf(h)][h % 4]);
    }
  }

  [[nodiscard]] std::vector<double> spheres() const { return LabelWinding(surface)(labels); }
  [[nodiscard]] double sum() const {
    const std::vector<double> all = spheres();
    return std::accumulate(all.begin(), all.end(), 0.0);
  }

  Context context;
  test::Labelled input;
  Surface surface;
  Labels labels;
};

CubeBody cube() {
  return {{1, 1, 1}, [](const Cell&) { return true; }};
}
CubeBody ring() {
  return {{3, 3, 1}, [](const Cell& c) { return c[0] != 1 || c[1] != 1; }};
}
CubeBody twoHoles() {
  return {{5, 3, 1}, [](const Cell& c) { return c[1] != 1 || c[0] % 2 == 0; }};
}
CubeBody frame() {
  return {{3, 3, 3}, [](const Cell& c) { return (c[0] == 1) + (c[1] == 1) + (c[2] == 1) < 2; }};
}

TEST(LabelWinding, IsThatOfTheSurfaceForLabelsOfPolycubes) {
  for (const CubeBody& body : {cube(), ring(), twoHoles(), frame()}) {
    for (const auto& deform : {unmoved, atAnOddAngle}) {
      for (const double spheres : WoundBody(body, deform).spheres()) EXPECT_EQ(spheres, 0);
    }
  }
}

/// The normals of a surface cover the sphere 1 - handles times (Gauss, Bonnet), a single label
/// never.
TEST(LabelWinding, AddsUpToWhatLabelsLackOfTheSphere) {
  const auto sumOfOneLabel = [](const CubeBody& body) {
    WoundBody wound(body, atAnOddAngle);
    for (lattice::Direction& label : wound.labels) label = 4;
    return wound.sum();
  };
  EXPECT_EQ(sumOfOneLabel(cube()), -1);
  EXPECT_EQ(sumOfOneLabel(ring()), 0);
  EXPECT_EQ(sumOfOneLabel(twoHoles()), 1);
  EXPECT_EQ(sumOfOneLabel(frame()), 4);
}

TEST(LabelWinding, NamesTheTipThatFacesAwayFromItsLabel) {
  const auto withTip = [](const Vec3& p) {
    const bool isTip = p == Vec3{0.5, 0.5, 0};
    return isTip ? Vec3{0.5, 0.5, -0.5} : p;
  };
  WoundBody body(cube(), withTip);
  const auto isAtTip = [&](std::size_t v) { return body.input.tets.points[v][2] < -0.4; };
  for (lattice::Direction& label : body.labels) label = 4;
  const std::vector<double> spheres = body.spheres();
  for (std::size_t v = 0; v < spheres.size(); ++v) EXPECT_EQ(spheres[v], isAtTip(v) ? -1 : 0);
  // So does the check of labels, which looks for changes there.
  const LabelCosts costs(body.surface);
  const Verdict verdict = LabelCheck(body.surface, costs)(body.labels);
  EXPECT_EQ(verdict.report.badCorners, 1U);
  ASSERT_FALSE(verdict.places.empty());
  const Side first = 3 * verdict.places.front();
  EXPECT_TRUE(isAtTip(body.surface.tails[first]) || isAtTip(body.surface.tails[first + 1]) ||
              isAtTip(body.surface.tails[first + 2]));
}

}  // namespace
}  // namespace hexhex::shape
