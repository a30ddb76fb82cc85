// Patches: the polygons of every face form one disk, bounded by the face's four arcs.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <hexhex/curved.hpp>

#include <base/disjoint_sets.hpp>

#include "curved/curved_maps.hpp"
#include "curved/tet_points.hpp"

namespace hexhex::test::patches {

namespace {

using Rational = boost::multiprecision::cpp_rational;

PiecewiseLinearMesh withPatches(const TetMap& map, int scale = 1, int threads = 0,
                                Engine engine = Engine::Atlas) {
  ExtractOptions options;
  options.scale = scale;
  options.engine = engine;
  Context context(threads);
  return extractPiecewiseLinear(map, PiecewiseLinearParts::ArcsAndPatches, options, context);
}

Quad sorted(Quad quad) {
  std::sort(quad.begin(), quad.end());
  return quad;
}

std::set<Quad> facesOf(const HexMesh& mesh) {
  constexpr std::size_t kFaces[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                        {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
  std::set<Quad> faces;
  for (const Hex& cell : mesh.cells) {
    for (const auto& f : kFaces)
      faces.insert(sorted({cell[f[0]], cell[f[1]], cell[f[2]], cell[f[3]]}));
  }
  return faces;
}

using Side = std::array<Index, 2>;

/// The border of a face, counter-clockwise, as its arcs say.
std::vector<Index> borderOf(const PiecewiseLinearMesh& result, std::size_t face) {
  std::vector<Index> border;
  const auto vertices = static_cast<Index>(result.mesh.points.size());
  for (std::size_t i = 0; i < 4; ++i) {
    const Index arc = result.patches.arcs[face][i];
    const bool reversed = ((result.patches.reversedArcs[face] >> i) & 1U) != 0;
    std::vector<Index> points = {result.arcs.ends[arc][0]};
    for (std::uint64_t p = result.arcs.pointBegin[arc]; p < result.arcs.pointBegin[arc + 1]; ++p) {
      points.push_back(vertices + static_cast<Index>(p));
    }
    points.push_back(result.arcs.ends[arc][1]);
    if (reversed) std::reverse(points.begin(), points.end());
    EXPECT_EQ(points.front(), result.patches.vertices[face][i]);
    EXPECT_EQ(points.back(), result.patches.vertices[face][(i + 1) % 4]);
    border.insert(border.end(), points.begin(), points.end() - 1);
  }
  return border;
}

/// Whether the polygons form one disk with that border.
::testing::AssertionResult isDisk(const PiecewiseLinearMesh& result, std::size_t face) {
  const Patches& patches = result.patches;
  const std::uint64_t first = patches.polygonBegin[face];
  const std::uint64_t end = patches.polygonBegin[face + 1];
  std::map<Side, Index> sides;
  std::set<Index> points;
  for (std::uint64_t p = first; p < end; ++p) {
    const std::uint64_t begin = patches.cornerBegin[p];
    const std::uint64_t size = patches.cornerBegin[p + 1] - begin;
    if (size < 3 || size > 8) return ::testing::AssertionFailure() << size << " corners";
    for (std::uint64_t i = 0; i < size; ++i) {
      const Side side = {patches.corners[begin + i], patches.corners[begin + (i + 1) % size]};
      points.insert(side[0]);
      if (!sides.emplace(side, static_cast<Index>(p - first)).second) {
        return ::testing::AssertionFailure() << "a side twice in the same direction";
      }
    }
  }
  DisjointSets components(end - first);
  std::set<Side> open;
  for (const auto& [side, polygon] : sides) {
    const auto opposite = sides.find({side[1], side[0]});
    if (opposite == sides.end()) {
      open.insert(side);
    } else {
      components.unite(polygon, opposite->second);
    }
  }
  if (components.count() != 1) return ::testing::AssertionFailure() << "several components";
  const std::vector<Index> border = borderOf(result, face);
  std::set<Side> expected;
  for (std::size_t i = 0; i < border.size(); ++i) {
    expected.insert({border[i], border[(i + 1) % border.size()]});
  }
  if (open != expected) return ::testing::AssertionFailure() << "the border is not the four arcs";
  const std::size_t edges = (sides.size() + open.size()) / 2;
  if (points.size() + (end - first) != edges + 1) {
    return ::testing::AssertionFailure() << "Euler characteristic";
  }
  return ::testing::AssertionSuccess();
}

/// Twice the sum of the areas in (u, v), exactly.
Rational twiceArea(const Patches& patches, std::size_t face) {
  Rational sum = 0;
  for (std::uint64_t p = patches.polygonBegin[face]; p < patches.polygonBegin[face + 1]; ++p) {
    const std::uint64_t begin = patches.cornerBegin[p];
    const std::uint64_t size = patches.cornerBegin[p + 1] - begin;
    for (std::uint64_t i = 0; i < size; ++i) {
      const auto& a = patches.parameters[begin + i];
      const auto& b = patches.parameters[begin + (i + 1) % size];
      sum += Rational(a[0]) * Rational(b[1]) - Rational(a[1]) * Rational(b[0]);
    }
  }
  return sum;
}

double areaInSpace(const PiecewiseLinearMesh& result, std::uint64_t polygon) {
  const Patches& patches = result.patches;
  const std::uint64_t begin = patches.cornerBegin[polygon];
  const Vec3& origin = result.point(patches.corners[begin]);
  Vec3 sum{};
  for (std::uint64_t i = begin + 1; i + 1 < patches.cornerBegin[polygon + 1]; ++i) {
    sum = plus(sum, hexhex::cross(minus(result.point(patches.corners[i]), origin),
                                  minus(result.point(patches.corners[i + 1]), origin)));
  }
  return length(sum) / 2;
}

/// Triangles that belong to one tet only, with their areas.
std::map<TetPoints::Simplex, double> boundaryTriangles(const TetMap& map, const TetPoints& tets) {
  std::map<TetPoints::Simplex, std::pair<int, double>> all;
  for (Index t = 0; t < map.tets.size(); ++t) {
    for (unsigned i = 0; i < 4; ++i) {
      const TetPoints::Simplex triangle = tets.simplex(t, static_cast<CornerSet>(15U ^ (1U << i)));
      const Vec3& a = map.points[triangle[0]];
      const Vec3 normal =
          hexhex::cross(minus(map.points[triangle[1]], a), minus(map.points[triangle[2]], a));
      ++all[triangle].first;
      all[triangle].second = length(normal) / 2;
    }
  }
  std::map<TetPoints::Simplex, double> boundary;
  for (const auto& [triangle, entry] : all) {
    if (entry.first == 1) boundary[triangle] = entry.second;
  }
  return boundary;
}

/// The simplex that a point of the common numbering lies in.
TetPoints::Simplex generatorOf(const PiecewiseLinearMesh& r, const TetPoints& tets, Index point) {
  std::size_t i = point;
  if (i < r.mesh.points.size()) {
    return tets.simplex(r.mesh.generatorTet[i], r.mesh.generatorCorners[i]);
  }
  i -= r.mesh.points.size();
  if (i < r.arcs.points.size()) {
    return tets.simplex(r.arcs.generatorTet[i], r.arcs.generatorCorners[i]);
  }
  i -= r.arcs.points.size();
  return tets.simplex(r.patches.generatorTet[i], r.patches.generatorCorners[i]);
}

/// Polygons lie where they say: in their tet or triangle, in a plane of the grid, undistorted.
void examinePolygon(const PiecewiseLinearMesh& result, const TetPoints& tets, std::uint64_t p) {
  const Patches& patches = result.patches;
  const Index tet = patches.polygonTet[p];
  const TetPoints::Simplex carrier = tets.simplex(tet, patches.polygonCorners[p]);
  const std::uint64_t begin = patches.cornerBegin[p];
  const std::uint64_t size = patches.cornerBegin[p + 1] - begin;
  double twiceArea = 0;  // positive, so that polygons of a disk do not overlap; up to rounding
  for (std::uint64_t i = 0; i < size; ++i) {
    const TetPoints::Simplex generator = generatorOf(result, tets, patches.corners[begin + i]);
    ASSERT_TRUE(std::includes(carrier.begin(), carrier.end(), generator.begin(), generator.end()));
    const Vec3& here = result.point(patches.corners[begin + i]);
    const Vec3& next = result.point(patches.corners[begin + (i + 1) % size]);
    ASSERT_LE(tets.distanceFromPlane(tet, here), 1e-7);
    const auto& a = patches.parameters[begin + i];
    const auto& b = patches.parameters[begin + (i + 1) % size];
    ASSERT_NEAR(tets.parametricDistance(tet, here, next), std::hypot(a[0] - b[0], a[1] - b[1]),
                1e-7);
    twiceArea += a[0] * b[1] - a[1] * b[0];
  }
  ASSERT_GE(twiceArea, -1e-14);
}

/// @param shared  how many faces have the vertices of another one before them
void examine(const TetMap& map, int scale, std::size_t shared = 0) {
  const PiecewiseLinearMesh result = withPatches(map, scale);
  const Patches& patches = result.patches;
  std::set<Quad> faces;
  for (const Quad& quad : patches.vertices) faces.insert(sorted(quad));
  EXPECT_EQ(faces, facesOf(result.mesh));
  EXPECT_EQ(faces.size() + shared, patches.count());
  ASSERT_EQ(patches.polygonBegin.size(), patches.count() + 1);
  ASSERT_EQ(patches.polygonTet.size(), patches.polygonBegin.back());
  ASSERT_EQ(patches.corners.size(), patches.cornerBegin.back());
  ASSERT_EQ(patches.parameters.size(), patches.corners.size());

  const TetPoints tets(map, scale);
  const auto boundary = boundaryTriangles(map, tets);
  double boundaryArea = 0;
  std::map<Index, std::size_t> faceOfPoint;  // inner points of faces belong to one alone
  const std::size_t onArcs = result.mesh.points.size() + result.arcs.points.size();
  for (std::size_t f = 0; f < patches.count(); ++f) {
    SCOPED_TRACE("face " + std::to_string(f));
    ASSERT_TRUE(isDisk(result, f));
    if (f % 4 == 0) {  // exact sums take their time
      ASSERT_EQ(twiceArea(patches, f), 2);
    }
    for (std::uint64_t p = patches.polygonBegin[f]; p < patches.polygonBegin[f + 1]; ++p) {
      ASSERT_NO_FATAL_FAILURE(examinePolygon(result, tets, p));
      for (std::uint64_t i = patches.cornerBegin[p]; i < patches.cornerBegin[p + 1]; ++i) {
        const Index point = patches.corners[i];
        if (point < onArcs) continue;
        ASSERT_EQ(faceOfPoint.emplace(point, f).first->second, f);
      }
      const auto simplex = tets.simplex(patches.polygonTet[p], patches.polygonCorners[p]);
      if (boundary.contains(simplex)) boundaryArea += areaInSpace(result, p);
    }
  }
  EXPECT_EQ(faceOfPoint.size(), patches.points.size());
  double expectedArea = 0;
  for (const auto& [triangle, area] : boundary) expectedArea += area;
  EXPECT_NEAR(boundaryArea, expectedArea, 1e-9 * expectedArea);
}

TEST(Patches, GeneratedMaps) {
  int number = 0;
  for (const CurvedMap& map : generatedMaps()) {
    SCOPED_TRACE(map.name);
    examine(map.map, ++number % 5 == 0 ? 2 : 1);
  }
}

TEST(Patches, FacesWithTheSameVertices) {
  // Above each of the twelve edges of a section, two faces along the torus.
  examine(tightTorus(2), 1, 12);
}

TEST(Patches, FacesThatMeetThemselves) {
  const PiecewiseLinearMesh result = withPatches(tightTorus(1));
  const Patches& patches = result.patches;
  ASSERT_EQ(patches.count(), 5U + 12U);
  std::size_t rings = 0;
  for (std::size_t f = 0; f < patches.count(); ++f) {
    EXPECT_EQ(twiceArea(patches, f), 2);
    const auto& arcs = patches.arcs[f];
    if (arcs[0] == arcs[2] || arcs[1] == arcs[3]) {
      ++rings;
    } else {
      EXPECT_TRUE(isDisk(result, f));
    }
  }
  EXPECT_EQ(rings, 12U);
}

TEST(Patches, RealMaps) {
  const std::vector<CurvedMap> maps = realMaps();
  if (maps.empty()) GTEST_SKIP() << "skipped: no real maps here";
  for (const CurvedMap& map : maps) {
    SCOPED_TRACE(map.name);
    const std::size_t cells = withPatches(map.map).mesh.cells.size();
    if (cells < 2000) examine(map.map, 1);
    if (cells < 300) examine(map.map, 2);
  }
}

TetMap mapWithRandomCharts() {
  SampleOptions options;
  options.cells = 4;
  options.refine = 3;
  options.jitter = 0.5;
  options.charts = ChartStyle::Random;
  return generateSample(SampleKind::Sphere, options).map;
}

void expectSamePatches(const Patches& a, const Patches& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.arcs, b.arcs);
  EXPECT_EQ(a.reversedArcs, b.reversedArcs);
  EXPECT_EQ(a.polygonBegin, b.polygonBegin);
  EXPECT_EQ(a.cornerBegin, b.cornerBegin);
  EXPECT_EQ(a.polygonTet, b.polygonTet);
  EXPECT_EQ(a.polygonCorners, b.polygonCorners);
  EXPECT_EQ(a.corners, b.corners);
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.generatorTet, b.generatorTet);
  EXPECT_EQ(a.generatorCorners, b.generatorCorners);
}

TEST(Patches, SameForAnyNumberOfThreads) {
  const TetMap map = mapWithRandomCharts();
  for (const Engine engine : {Engine::Atlas, Engine::Propeller}) {
    const Patches one = withPatches(map, 1, 1, engine).patches;
    for (const int threads : {2, 3}) {
      expectSamePatches(one, withPatches(map, 1, threads, engine).patches);
    }
  }
}

TEST(Patches, SameOfBothEngines) {
  const TetMap map = mapWithRandomCharts();
  expectSamePatches(withPatches(map, 1, 1).patches,
                    withPatches(map, 1, 1, Engine::Propeller).patches);
}

}  // namespace
}  // namespace hexhex::test::patches
