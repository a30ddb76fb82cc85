// Meshes on surfaces that they did not come from.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>
#include <gtest/gtest.h>

#include <hexhex/improve.hpp>
#include <hexhex/samples.hpp>

#include <base/stage.hpp>
#include <base/vector3.hpp>

#include "improve/improved.hpp"
#include "mesh/grid_meshes.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

using testing::gridMesh;

namespace {

ImproveReport improvedOnSurface(HexMesh& mesh, const TriangleMesh& surface, int threads = 2) {
  Context context(threads);
  return improve(mesh, surface, {}, context);
}

TriangleMesh boundaryOfTets(const TetMap& map) {
  Context context(1);
  return boundaryOf({map.points, map.tets}, context);
}

/// The triangles of a ball divided four times over, on the sphere that its vertices are on.
TriangleMesh fineSphere(TriangleMesh surface) {
  const double radius = length(surface.points[surface.triangles[0][0]]);
  for (int round = 0; round < 3; ++round) {
    std::map<std::array<Index, 2>, Index> middles;
    const auto middle = [&](Index i, Index j) {
      const auto [entry, isNew] =
          middles.try_emplace(std::array<Index, 2>{std::min(i, j), std::max(i, j)},
                              static_cast<Index>(surface.points.size()));
      if (isNew) {
        const Vec3 sum = plus(surface.points[i], surface.points[j]);
        surface.points.push_back(times(radius / length(sum), sum));
      }
      return entry->second;
    };
    std::vector<std::array<Index, 3>> finer;
    for (const auto& [a, b, c] : surface.triangles) {
      const std::array<Index, 3> m = {middle(a, b), middle(b, c), middle(c, a)};
      finer.insert(finer.end(), {{a, m[0], m[2]}, {b, m[1], m[0]}, {c, m[2], m[1]}, m});
    }
    surface.triangles = std::move(finer);
  }
  return surface;
}

Array<Quad> outerQuads(const HexMesh& mesh) {
  Context context(1);
  Stage stage(context, "test");
  return adjacency::quadsAt(mesh, adjacency::boundaryPlaces(mesh, stage));
}

/// A cube of twelve triangles.
TriangleMesh cubeSurface(double side) {
  TriangleMesh surface;
  for (int c = 0; c < 8; ++c) {
    surface.points.push_back({side * (c & 1), side * (c >> 1 & 1), side * (c >> 2 & 1)});
  }
  for (const Quad& q : {Quad{0, 2, 3, 1}, Quad{4, 5, 7, 6}, Quad{0, 1, 5, 4}, Quad{2, 6, 7, 3},
                        Quad{0, 4, 6, 2}, Quad{1, 3, 7, 5}}) {
    surface.triangles.push_back({q[0], q[1], q[2]});
    surface.triangles.push_back({q[0], q[2], q[3]});
  }
  return surface;
}

}  // namespace

/// A mesh on the facets of a coarse ball: between its vertices, these are off the sphere.
TEST(GivenSurface, TakesAFacettedBallOntoItsSphere) {
  const TetMap coarse = generateSample(SampleKind::Sphere, {.cells = 2}).map;
  HexMesh mesh = extracted(coarse, 3);
  HexMesh other = mesh;
  HexMesh alone = mesh;
  const TriangleMesh sphere = fineSphere(boundaryOfTets(coarse));
  const ImproveReport report = improvedOnSurface(mesh, sphere);
  EXPECT_TRUE(report.after.allPositive());
  EXPECT_GE(report.after.quality.minimum, report.before.quality.minimum);
  EXPECT_LT(report.distanceAfter.hausdorff(), 0.5 * report.distanceBefore.hausdorff());
  // By the sphere itself: the chord of the facets, which vertices of the mesh are in the middle of.
  const double radius = length(sphere.points[sphere.triangles[0][0]]);
  double chord = 0;
  double off = 0;
  for (const Quad& quad : outerQuads(mesh)) {
    for (const Index v : quad) {
      chord = std::max(chord, radius - length(alone.points[v]));
      off = std::max(off, std::abs(radius - length(mesh.points[v])));
    }
  }
  EXPECT_GT(chord, 0.02 * radius);
  EXPECT_LT(off, 0.1 * chord);
  improvedOnSurface(other, sphere, 1);
  EXPECT_EQ(mesh.points, other.points);
}

/// Edges and corners of the mesh go onto those of the surface, which are 0.1 away.
TEST(GivenSurface, KeepsTheEdgesOfACube) {
  HexMesh mesh = gridMesh(5);
  for (Vec3& point : mesh.points) {
    for (double& x : point) x = 0.1 + x * 4.85 / 5;
  }
  const ImproveReport report = improvedOnSurface(mesh, cubeSurface(5));
  EXPECT_EQ(report.vertices[3], 8U);
  EXPECT_EQ(report.vertices[2], 12U * 4);
  EXPECT_GT(report.distanceBefore.hausdorff(), 0.01);
  EXPECT_LT(report.distanceAfter.hausdorff(), 1e-9);
  EXPECT_DOUBLE_EQ(report.curvesFollowed, 1);
  EXPECT_GT(report.after.quality.minimum, 0.8);
}

/// Bad cells at the boundary: mended, and on the surface.
TEST(GivenSurface, MendsWhatIsBad) {
  HexMesh mesh = gridMesh(5);
  for (Vec3& point : mesh.points) {
    const bool isInside =
        std::all_of(point.begin(), point.end(), [](double x) { return x > 0 && x < 5; });
    if (isInside) point = {2.5 + 0.3 * (point[1] - 2.5), point[0], point[2]};
    for (double& x : point) x = 0.1 + x * 4.85 / 5;
  }
  const ImproveReport report = improvedOnSurface(mesh, cubeSurface(5));
  EXPECT_FALSE(report.before.allPositive());
  EXPECT_TRUE(report.after.allPositive());
  EXPECT_LT(report.distanceAfter.hausdorff(), 1e-6);
}

TEST(GivenSurface, SaysWhatIsWrongWithIt) {
  HexMesh mesh = gridMesh(3);
  const auto codeOf = [&](const TriangleMesh& surface) {
    return errorOf([&] { improvedOnSurface(mesh, surface); }).code();
  };
  EXPECT_EQ(codeOf({}), ErrorCode::EmptyMesh);
  EXPECT_EQ(codeOf(cubeSurface(3000)), ErrorCode::InvalidArgument);  // in other units
  TriangleMesh broken = cubeSurface(3);
  broken.triangles[3][1] = 99;
  EXPECT_EQ(codeOf(broken), ErrorCode::InvalidArgument);
  broken = cubeSurface(3);
  broken.points[2][0] = std::nan("");
  EXPECT_EQ(codeOf(broken), ErrorCode::NotFinite);
}

TEST(GivenSurface, BoundariesOfTetsAreClosedAndFaceOutwards) {
  const TetMap map = generateSample(SampleKind::Box, {.cells = 2}).map;
  const TriangleMesh surface = boundaryOfTets(map);
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    volume += tripleProduct(surface.points[a], surface.points[b], surface.points[c]) / 6;
  }
  double ofTets = 0;
  for (const Tet& tet : map.tets) {
    const Vec3& p = map.points[tet[0]];
    ofTets += tripleProduct(minus(map.points[tet[1]], p), minus(map.points[tet[2]], p),
                            minus(map.points[tet[3]], p)) /
              6;
  }
  EXPECT_NEAR(volume, ofTets, 1e-9 * ofTets);
}

}  // namespace hexhex::test
