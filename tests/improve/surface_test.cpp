// Nearest places on surfaces, and what holds a vertex.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <base/vector3.hpp>
#include <improve/reference_surface.hpp>
#include <improve/surface_distance.hpp>
#include <improve/vertex_places.hpp>

#include "mesh/grid_meshes.hpp"

namespace hexhex::test {

using namespace improvement;

namespace {

using hexhex::testing::Random;

Vec3 randomPoint(Random& random) { return {random.real(), random.real(), random.real()}; }

double distance(const Vec3& a, const Vec3& b) { return length(minus(a, b)); }

}  // namespace

TEST(Surface, NearestPointOfATriangleIsNoFartherThanAnyOther) {
  Random random(1);
  for (int trial = 0; trial < 500; ++trial) {
    const std::array<Vec3, 3> t = {randomPoint(random), randomPoint(random), randomPoint(random)};
    const Vec3 point = randomPoint(random);
    const Vec3 nearest = nearestOf(t, point);
    for (int k = 0; k < 30; ++k) {
      double a = random.real();
      double b = random.real();
      if (a + b > 1) a = 1 - a, b = 1 - b;
      Vec3 other = t[0];
      for (std::size_t i = 0; i < 3; ++i) {
        other[i] += a * (t[1][i] - t[0][i]) + b * (t[2][i] - t[0][i]);
      }
      EXPECT_LE(distance(nearest, point), distance(other, point) + 1e-12);
    }
  }
}

TEST(Surface, ATreeFindsWhatASearchFinds) {
  Random random(2);
  for (const std::size_t n : {1U, 3U, 4U, 5U, 17U, 100U}) {
    std::vector<std::array<Vec3, 3>> triangles;
    for (std::size_t i = 0; i < n; ++i) {
      triangles.push_back({randomPoint(random), randomPoint(random), randomPoint(random)});
    }
    const TriangleTree tree(triangles);
    for (int trial = 0; trial < 100; ++trial) {
      Vec3 point = randomPoint(random);
      point[0] = 3 * point[0] - 1;
      double least = std::numeric_limits<double>::infinity();
      for (const auto& t : triangles) least = std::min(least, distance(nearestOf(t, point), point));
      EXPECT_EQ(tree.nearest(point).distance, least);
    }
  }
  EXPECT_EQ(TriangleTree({}).nearest({}).distance, std::numeric_limits<double>::infinity());
}

TEST(Surface, AWalkStaysOnItsPatchAndItsCurve) {
  const HexMesh mesh = hexhex::testing::gridMesh(4);
  Context context(1);
  Stage stage(context, "test");
  const VertexPlaces places =
      placesOnMesh(mesh, std::vector<std::uint8_t>(mesh.points.size()), 40, stage);
  EXPECT_EQ(places.surface.corners().size(), 8U);
  EXPECT_EQ(places.surface.segmentCount(), 12U * 4);
  Random random(3);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    // Two coordinates stay on a curve, one on a patch; the others go wherever the point is.
    const Vec3 far = {6 * random.real() - 1, 6 * random.real() - 1, 6 * random.real() - 1};
    const Vec3& from = mesh.points[v];
    if (places.freedom[v] != Freedom::OnPatch && places.freedom[v] != Freedom::OnCurve) continue;
    const bool onPatch = places.freedom[v] == Freedom::OnPatch;
    const SurfacePlace place = onPatch ? places.surface.onPatch(far, places.simplex[v])
                                       : places.surface.onCurve(far, places.simplex[v]);
    for (std::size_t k = 0; k < 3; ++k) {
      const bool fixed = from[k] == 0 || from[k] == 4;
      EXPECT_NEAR(place.point[k], fixed ? from[k] : std::clamp(far[k], 0.0, 4.0), 1e-12);
    }
  }
}

/// A roof over one quad, whose ridge is a quarter of the way across.
TEST(Surface, DistancesSeeARidgeBesideTheCentreOfAQuad) {
  constexpr double kHeight = 0.1;
  SurfaceParts parts;
  for (const double y : {0.0, 1.0}) {
    parts.points.push_back({0, y, 0});
    parts.points.push_back({0.25, y, kHeight});
    parts.points.push_back({1, y, 0});
  }
  parts.triangles = {{{0, 1, 4}, 0}, {{0, 4, 3}, 0}, {{1, 2, 5}, 0}, {{1, 5, 4}, 0}};
  parts.boundaryTriangles = parts.triangles.size();
  Context context(1);
  Stage stage(context, "test");
  const Array<Vec3> points = parts.points;
  const ReferenceSurface surface(std::move(parts), stage);
  const std::vector<Quad> quads = {{0, 2, 5, 3}};
  const SurfaceDistance found =
      distanceBetween(points, quads, surface, treeOf(surface), 1, stage).largest;
  EXPECT_NEAR(found.fromSurface, kHeight, 1e-12);
  EXPECT_NEAR(found.fromMesh, kHeight / std::hypot(1, kHeight / 0.25), 1e-12);  // to the steep side
}

/// A strip of four quads under two long triangles, with a dent beside the middles of their edges.
TEST(Surface, DistancesSeeADentBelowTheEdgeOfALongTriangle) {
  constexpr double kDepth = 0.1;
  constexpr double kWidth = 0.25;
  SurfaceParts parts;
  parts.points = {{0, 0, 0}, {kWidth, 0, 0}, {kWidth, 1, 0}, {0, 1, 0}};
  parts.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
  parts.boundaryTriangles = parts.triangles.size();
  Context context(1);
  Stage stage(context, "test");
  const ReferenceSurface surface(std::move(parts), stage);
  Array<Vec3> points;
  std::vector<Quad> quads;
  for (Index i = 0; i < 5; ++i) {
    const double y = 0.25 * i;
    const double z = i == 1 ? -kDepth : 0;
    points.push_back({0, y, z});
    points.push_back({kWidth, y, z});
    if (i > 0) quads.push_back({2 * i - 2, 2 * i - 1, 2 * i + 1, 2 * i});
  }
  const SurfaceDistance found =
      distanceBetween(points, quads, surface, treeOf(surface), 1, stage).largest;
  EXPECT_NEAR(found.fromSurface, kDepth / std::hypot(1, kDepth / 0.25), 1e-12);
  EXPECT_NEAR(found.fromMesh, kDepth, 1e-12);
}

/// A surface in metres, and a mesh in thousandths of millimetres, or without any size.
TEST(Surface, DistancesToATinyMeshEnd) {
  for (const double size : {1e-6, 0.0}) {
    SurfaceParts parts;
    parts.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    parts.triangles = {{{0, 1, 2}, 0}};
    parts.boundaryTriangles = parts.triangles.size();
    Context context(1);
    Stage stage(context, "test");
    const ReferenceSurface surface(std::move(parts), stage);
    const Array<Vec3> points = {{0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0}};
    const std::vector<Quad> quads = {{0, 1, 2, 3}};
    const SurfaceDistance found =
        distanceBetween(points, quads, surface, treeOf(surface), std::sqrt(2), stage).largest;
    EXPECT_NEAR(found.fromSurface, 1, 1e-5);
  }
}

/// Short chains are what bad cells make, unless they end at vertices with tags.
TEST(Surface, AVertexThatSticksOutIsNoCornerAtABadCell) {
  HexMesh mesh = hexhex::testing::gridMesh(6);
  const auto vertexAt = [&mesh](const Vec3& point) {
    const auto found = std::find(mesh.points.begin(), mesh.points.end(), point);
    return static_cast<Index>(found - mesh.points.begin());
  };
  const Index tip = vertexAt({3, 3, 6});
  const std::array<Index, 4> beside = {vertexAt({2, 3, 6}), vertexAt({4, 3, 6}),
                                       vertexAt({3, 2, 6}), vertexAt({3, 4, 6})};
  mesh.points[tip][2] = 8;
  Context context(1);
  Stage stage(context, "test");
  const auto freedom = [&](std::uint8_t isAtBad) {
    const std::vector<std::uint8_t> all(mesh.points.size(), isAtBad);
    return placesOnMesh(mesh, all, 40, stage).freedom[tip];
  };
  EXPECT_EQ(freedom(0), Freedom::Fixed);
  EXPECT_EQ(freedom(1), Freedom::OnPatch);
  for (const Index v : beside) mesh.features.vertices.push_back({v, 1});
  EXPECT_EQ(freedom(1), Freedom::Fixed);
}

TEST(Surface, TagsOfAMapHoldVertices) {
  TetMap map = hexhex::testing::identityMap(2);
  HexMesh mesh = hexhex::testing::gridMesh(2);
  mesh.generatorTet.resize(mesh.points.size());
  mesh.generatorCorners.resize(mesh.points.size());
  for (Index v = 0; v < mesh.points.size(); ++v) {
    for (auto t = static_cast<Index>(map.tets.size()); t-- > 0;) {
      for (std::size_t i = 0; i < 4; ++i) {
        if (map.points[map.tets[t][i]] != mesh.points[v]) continue;
        mesh.generatorTet[v] = t;
        mesh.generatorCorners[v] = static_cast<CornerSet>(1U << i);
      }
    }
  }
  Context context(1);
  Stage stage(context, "test");
  const auto count = [&](Freedom freedom) {
    const VertexPlaces places = placesOnMap(mesh, map, 40, stage);
    return std::count(places.freedom.begin(), places.freedom.end(), freedom);
  };
  EXPECT_EQ(count(Freedom::Free), 1);
  EXPECT_EQ(count(Freedom::OnPatch), 6);
  EXPECT_EQ(count(Freedom::OnCurve), 12);
  EXPECT_EQ(count(Freedom::Fixed), 8);
  // Regions meet in planes, which the middle of the box is held by; a tagged vertex stays.
  for (const Tet& tet : map.tets) {
    double x = 0;
    for (const Index v : tet) x += map.points[v][0] / 4;
    map.regions.push_back(x < 1 ? 0 : 1);
  }
  EXPECT_EQ(count(Freedom::Free), 0);
  EXPECT_EQ(count(Freedom::OnPatch), 3);  // of x = 0, 1 and 2
  const auto centre = std::find(map.points.begin(), map.points.end(), Vec3{1, 1, 1});
  map.features.vertices.push_back({static_cast<std::uint32_t>(centre - map.points.begin()), 1});
  EXPECT_EQ(count(Freedom::Fixed), 13);  // and where the four edges of that plane end
}

}  // namespace hexhex::test
