// Which surfaces bound bodies, and what is said of those that do not.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fill/closed_surface.hpp>
#include <fill/exact_signs.hpp>
#include <fill/intersections.hpp>
#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "support/random.hpp"
#include "surfaces.hpp"

namespace hexhex::test {
namespace {

fill::Bodies allOf(const TriangleMesh& surface) {
  Context context(1);
  Stage stage(context, "bodies");
  return fill::bodiesOf(surface, stage);
}
std::vector<fill::Body> bodies(const TriangleMesh& surface) { return allOf(surface).bodies; }

Error refusal(const TriangleMesh& surface) {
  return errorOf([&] { return bodies(surface); });
}

bool says(const Error& error, const std::string& words) {
  const bool found = std::string(error.what()).find(words) != std::string::npos;
  EXPECT_TRUE(found) << error.what();
  return found;
}

TEST(ClosedSurface, KnowsVolumes) {
  const auto box = bodies(boxSurface({2, 1, 1}));
  ASSERT_EQ(box.size(), 1U);
  EXPECT_DOUBLE_EQ(box[0].volume, 2);
  EXPECT_EQ(box[0].voidCount, 0U);
  // That of Pappus, less what 32 by 16 quads cut off.
  const double torus = 2 * std::numbers::pi * std::numbers::pi * 0.16;
  EXPECT_NEAR(bodies(torusSurface())[0].volume, torus, 0.05 * torus);
}

TEST(ClosedSurface, TakesTrianglesInAnyOrientation) {
  TriangleMesh ball = ballSurface();
  for (std::size_t t = 0; t < ball.triangles.size(); t += 3) {
    std::swap(ball.triangles[t][1], ball.triangles[t][2]);
  }
  const auto mixed = bodies(ball);
  EXPECT_DOUBLE_EQ(mixed[0].volume, bodies(ballSurface())[0].volume);
  EXPECT_EQ(fill::windings(mixed[0].surface, {0, 0, 0}), 1);
  EXPECT_EQ(fill::windings(mixed[0].surface, {2, 0, 0}), 0);
}

// Balls in balls are in turn bodies, cavities and bodies; others are beside them.
TEST(ClosedSurface, TellsBodiesFromVoids) {
  TriangleMesh all = boxSurface({1, 1, 1}, {5, 0, 0});
  for (const double radius : {0.25, 1.0, 0.5, 0.75}) all = joined(all, ballSurface(radius));
  const auto found = bodies(joined(all, ballSurface(0.1, {0, 0, 0.88})));
  ASSERT_EQ(found.size(), 3U);
  std::vector<std::uint64_t> voids;
  for (const fill::Body& body : found) voids.push_back(body.voidCount);
  EXPECT_EQ(voids, (std::vector<std::uint64_t>{0, 2, 1}));  // in the order of the file
  const auto volume = [](double radius) { return bodies(ballSurface(radius))[0].volume; };
  EXPECT_NEAR(found[1].volume, volume(1) - volume(0.75) - volume(0.1), 1e-12);
  EXPECT_NEAR(found[2].volume, volume(0.5) - volume(0.25), 1e-12);
  EXPECT_EQ(fill::windings(found[1].surface, {0, 0, 0.88}), 0);
  EXPECT_EQ(fill::windings(found[1].surface, {0.9, 0, 0}), 1);
}

TEST(ClosedSurface, RefusesHoles) {
  TriangleMesh open = boxSurface();
  open.triangles.pop_back();
  const Error error = refusal(open);
  EXPECT_EQ(error.code(), ErrorCode::NonManifoldEdge);
  EXPECT_TRUE(says(error, "open: the edge from (1, 0, 0) to (1, 0, 1)") &&
              says(error, "and so have 2 others"));
}

TEST(ClosedSurface, RefusesBodiesThatTouch) {
  const auto glued = [](const Vec3& from) {
    TriangleMesh both = joined(boxSurface(), boxSurface({1, 1, 1}, from));
    // What is read from files is one vertex at one place.
    std::vector<Index> first(both.points.size());
    for (Index v = 0; v < both.points.size(); ++v) {
      while (both.points[first[v]] != both.points[v]) ++first[v];
    }
    for (Triangle& t : both.triangles) {
      for (Index& v : t) v = first[v];
    }
    return both;
  };
  const Error edge = refusal(glued({1, 1, 0}));
  EXPECT_EQ(edge.code(), ErrorCode::NonManifoldEdge);
  says(edge, "4 triangles of the surface meet in the edge from (1, 1, 0) to (1, 1, 1)");
  const Error point = refusal(glued({1, 1, 1}));
  EXPECT_EQ(point.code(), ErrorCode::NonManifoldVertex);
  says(point, "touches itself in the point (1, 1, 1)");
}

TEST(ClosedSurface, RefusesOneSidedOnes) {
  const Error error = refusal(kleinSurface());
  EXPECT_EQ(error.code(), ErrorCode::Orientation);
  says(error, "one side only");
}

TEST(ClosedSurface, RefusesSheetsAndFlatTriangles) {
  TriangleMesh sheet;
  sheet.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
  says(refusal(sheet), "no thickness");
  EXPECT_EQ(refusal(sheet).code(), ErrorCode::NotMeshable);
  // A corner cut off a box at half of an edge: the triangle beside it is a line.
  TriangleMesh box = boxSurface();
  box.points.push_back({0.5, 0, 0});
  box.triangles.push_back({0, 8, 1});
  const Error error = refusal(box);
  EXPECT_EQ(error.code(), ErrorCode::NotMeshable);
  says(error, "no area, and no neighbour");
  says(error, "its corners (0, 0, 0), (0.5, 0, 0), (1, 0, 0)");
  EXPECT_EQ(refusal({}).code(), ErrorCode::EmptyMesh);
}

/// A box, one of whose edges has further vertices on one of its sides, and flat triangles between.
TriangleMesh boxWithFlatTriangles() {
  TriangleMesh box = boxSurface();
  box.points.insert(box.points.end(), {{0.5, 0, 0}, {0.25, 0, 0}});
  // The edge from 0 to 1 has the triangles 0 2 3, 0 3 1 below it and 0 1 5, 0 5 4 in front of it.
  const auto beside = std::ranges::find(box.triangles, Triangle{0, 3, 1});
  *beside = {0, 3, 9};
  box.triangles.insert(box.triangles.end(),
                       {{9, 3, 8}, {8, 3, 1}, {0, 9, 8}, {8, 1, 0}, {4, 4, 5}});
  return box;
}

TEST(ClosedSurface, UnitesFlatTrianglesWithTheirNeighbours) {
  const fill::Bodies all = allOf(boxWithFlatTriangles());
  EXPECT_EQ(all.flatTriangles, 3U);  // the second only after the first; one has a corner twice
  ASSERT_EQ(all.bodies.size(), 1U);
  EXPECT_DOUBLE_EQ(all.bodies[0].volume, 1);
  EXPECT_EQ(all.bodies[0].surface.triangles.size(), 12U + 4U);
  EXPECT_EQ(allOf(boxSurface()).flatTriangles, 0U);
  TriangleMesh line = boxSurface();
  for (Vec3& point : line.points) point = {point[0], 0, 0};
  EXPECT_EQ(refusal(line).code(), ErrorCode::NotMeshable);
  line.triangles = {{3, 3, 1}};
  EXPECT_EQ(refusal(line).code(), ErrorCode::EmptyMesh);
}

TEST(ClosedSurface, RefusesIntersections) {
  for (const Vec3& from : std::vector<Vec3>{{0.5, 0.25, 0.25},  // one end is in the other
                                            {0.25, 0.25, 1},    // faces in one plane
                                            {0.25, 0.25, -1}}) {
    const Error error = refusal(joined(boxSurface(), boxSurface({0.5, 0.5, 1}, from)));
    EXPECT_EQ(error.code(), ErrorCode::NotMeshable);
    says(error, "intersects or touches itself");
  }
  EXPECT_EQ(bodies(joined(boxSurface(), boxSurface({0.5, 0.5, 1}, {0.25, 0.25, 1 + 1e-15}))).size(),
            2U);
  // Through a vertex of its own: the tip of a pyramid touches its base, exactly, or not.
  TriangleMesh folded;
  folded.points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, 2, 1}, {2, 2, 0}};
  folded.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {1, 2, 5}, {2, 3, 5}, {3, 0, 5}};
  says(refusal(folded), "touches itself");
  folded.points[5][2] = 1e-300;
  EXPECT_EQ(bodies(folded).size(), 1U);
}

/// Signs of integers, by integers.
int bySign(std::int64_t x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); }

using Grid = std::array<std::int64_t, 3>;
Grid between(const Grid& a, const Grid& b) { return {b[0] - a[0], b[1] - a[1], b[2] - a[2]}; }
Grid across(const Grid& a, const Grid& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::int64_t along(const Grid& a, const Grid& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Two triangles are apart if a plane is between them: along a side of each, or along one of them.
bool areApart(const std::array<Grid, 3>& s, const std::array<Grid, 3>& t) {
  const Grid n = across(between(s[0], s[1]), between(s[0], s[2]));
  const Grid m = across(between(t[0], t[1]), between(t[0], t[2]));
  std::vector<Grid> axes = {n, m};
  for (std::size_t i = 0; i < 3; ++i) {
    const Grid e = between(s[i], s[(i + 1) % 3]);
    axes.push_back(across(n, e));
    axes.push_back(across(m, between(t[i], t[(i + 1) % 3])));
    for (std::size_t j = 0; j < 3; ++j) {
      axes.push_back(across(e, between(t[j], t[(j + 1) % 3])));
    }
  }
  for (const Grid& axis : axes) {
    std::array<std::int64_t, 4> ends = {INT64_MAX, INT64_MIN, INT64_MAX, INT64_MIN};
    for (std::size_t i = 0; i < 3; ++i) {
      ends[0] = std::min(ends[0], along(axis, s[i]));
      ends[1] = std::max(ends[1], along(axis, s[i]));
      ends[2] = std::min(ends[2], along(axis, t[i]));
      ends[3] = std::max(ends[3], along(axis, t[i]));
    }
    if (ends[1] < ends[2] || ends[3] < ends[0]) return true;
  }
  return false;
}

// On a small grid, most triples are special.
TEST(Intersections, AgreeWithSeparatingPlanes) {
  Random random(7);
  Context context(1);
  Stage stage(context, "pairs");
  int meeting = 0;
  int compared = 0;
  while (compared < 20000) {
    TriangleMesh pair;
    std::array<std::array<Grid, 3>, 2> grid{};
    for (auto& triangle : grid) {
      for (Grid& p : triangle) {
        for (std::int64_t& x : p) x = static_cast<std::int64_t>(random.below(5));
        pair.points.push_back({0.5 * static_cast<double>(p[0]), 3.0 * static_cast<double>(p[1]),
                               static_cast<double>(p[2])});
      }
    }
    pair.triangles = {{0, 1, 2}, {3, 4, 5}};
    const auto& p = pair.points;
    if (fill::isFlat({p[0], p[1], p[2]}) || fill::isFlat({p[3], p[4], p[5]})) continue;
    ++compared;
    const bool meet = fill::firstIntersection(pair, stage).has_value();
    ASSERT_EQ(meet, !areApart(grid[0], grid[1])) << compared;
    meeting += meet ? 1 : 0;
  }
  EXPECT_GT(meeting, 4000);
  EXPECT_LT(meeting, 16000);
}

TEST(Intersections, SignsAreExact) {
  // The last bit of a coordinate decides, far from the origin.
  const Vec3 a = {1e5 / 3, 1, 7};
  const Vec3 b = {a[0] + 1, a[1] + 1, a[2] + 1};
  const Vec3 c = {a[0] + 2, a[1] + 3, a[2] + 4};
  Vec3 d = {a[0] + 3, a[1] + 4, a[2] + 5};  // b + c - a
  EXPECT_EQ(fill::orientation(a, b, c, d), 0);
  d[0] = std::nextafter(d[0], 1e9);
  const int up = fill::orientation(a, b, c, d);
  d[0] = std::nextafter(std::nextafter(d[0], 0), 0);
  EXPECT_EQ(up * fill::orientation(a, b, c, d), -1);
  EXPECT_EQ(fill::orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(fill::orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, -5e-324}), -1);
  EXPECT_EQ(fill::orientation({0, 0, 0}, {1e-200, 0, 0}, {0, 1e-200, 0}, std::size_t{2}), 1);
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    std::array<Grid, 4> grid{};
    std::array<Vec3, 4> p{};
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 3; ++k) {
        grid[j][k] = static_cast<std::int64_t>(random.below(4));
        p[j][k] = static_cast<double>(grid[j][k]) * 1e-3;  // rounded, each number in its way
      }
    }
    const std::int64_t exact = along(between(grid[0], grid[1]),
                                     across(between(grid[0], grid[2]), between(grid[0], grid[3])));
    // Rounded coordinates decide themselves where the grid is flat, and only there.
    const int sign = fill::orientation(p[0], p[1], p[2], p[3]);
    if (exact != 0) {
      ASSERT_EQ(sign, bySign(exact));
    }
    ASSERT_EQ(fill::orientation(p[1], p[0], p[2], p[3]), -sign);
  }
}

}  // namespace
}  // namespace hexhex::test
