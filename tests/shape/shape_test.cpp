// From tets alone to certified meshes: of bodies whose polycubes are known, turned and deformed; of
// real parts, where the folder is there; and of what is no part.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <shape/polycube_map.hpp>
#include <shape/positive_tets.hpp>
#include <support/effort.hpp>

#include <hexhex/hexhex.hpp>

#include "extract/support.hpp"
#include "quantize/real_maps.hpp"
#include "support/error_of.hpp"
#include "support/labelled_bodies.hpp"
#include "support/tet_volume.hpp"

namespace hexhex::test {
namespace {

using Cell = CubeBody::Cell;
using Deform = std::function<Vec3(const Vec3&)>;

CubeBody box() {
  return {{2, 2, 1}, [](const Cell&) { return true; }};
}
CubeBody ring() {
  return {{3, 3, 1}, [](const Cell& c) { return c[0] != 1 || c[1] != 1; }};
}
CubeBody angle() {
  return {{2, 2, 1}, [](const Cell& c) { return c[0] == 0 || c[1] == 0; }};
}

ShapedMap shaped(const TetMesh& tets, int threads = 0) {
  Context context(threads);
  return mapFromTets(tets, {.method = ShapeMethod::Polycube}, context);
}

/// A mesh that is verified, once more; whether it is certified is for the caller to say.
MeshedPart meshed(const TetMesh& tets, double cells) {
  Context context;
  MeshOptions options;
  options.shape.method = ShapeMethod::Polycube;
  options.quantize = {.cells = cells, .densify = true};
  MeshedPart part = meshFromTets(tets, options, context);
  ExtractOptions exact;
  exact.tolerance = 0;
  // Layers are added to the cells of the map, at most.
  EXPECT_EQ(verifiedExtraction(part.map, exact).cells.size() + part.improvement.addedCells,
            part.mesh.cells.size());
  return part;
}

/// @param faces, corners  of the polycube
MeshedPart expectMesh(const TetMesh& tets, std::uint64_t faces, std::uint64_t corners,
                      double cells = 600) {
  MeshedPart outcome = meshed(tets, cells);
  EXPECT_TRUE(outcome.shape.labels.isValid());
  EXPECT_EQ(outcome.shape.labels.charts, faces);
  EXPECT_EQ(outcome.shape.labels.corners, corners);
  EXPECT_TRUE(outcome.improvement.after.allPositive());
  EXPECT_GT(outcome.shape.distortion.worst, 0);
  return outcome;
}

TEST(Shapes, AreBoxesHoweverTheyAreTurned) {
  for (const double turn : {0.0, 0.4, 2.0}) {
    SCOPED_TRACE(turn);
    const TetMesh tets = box().labelled(3, [&](const Vec3& p) { return turned(p, turn); }).tets;
    const MeshedPart outcome = expectMesh(tets, 6, 8);
    // Faces are found to be flat, and all twelve edges are edges of the map.
    EXPECT_LT(outcome.shape.labels.deviation, 1e-9);
    EXPECT_EQ(outcome.shape.featureEdges, 12U * 3 + 8 * 3);  // two cubes long, but for four of them
    EXPECT_EQ(outcome.shape.taggedEdges, outcome.shape.featureEdges);
    EXPECT_EQ(outcome.mesh.features.edges.empty(), false);
    EXPECT_GT(outcome.improvement.after.minimum, 0.99);
    EXPECT_EQ(outcome.shape.rotation == ShapeReport{}.rotation, turn == 0);
  }
}

TEST(Shapes, HaveTheFacesThatOneCanCount) {
  const Deform bent = [](const Vec3& p) {
    return turned({p[0] + 0.1 * p[1] * p[1], p[1], p[2] + 0.1 * p[0] * p[0]}, 0.3);
  };
  expectMesh(angle().labelled(3, bent).tets, 8, 12);
  expectMesh(ring().labelled(3, bent).tets, 10, 16);
}

TEST(Shapes, AreBalls) {
  HEXHEX_LARGE_TEST();
  const TetMesh ball = box()
                           .labelled(4,
                                     [](const Vec3& p) {
                                       return rounded<3>({p[0] - 1, p[1] - 1, 2 * p[2] - 1});
                                     })
                           .tets;
  const MeshedPart outcome = expectMesh(ball, 6, 8, 1000);
  EXPECT_EQ(outcome.shape.featureEdges, 0U);
}

/// A coarse ball whose surface points are moved inwards and outwards at random, but folds no tet.
TetMesh bumpyBall(unsigned seed) {
  const CubeBody cube({2, 2, 2}, [](const Cell&) { return true; });
  TetMesh ball = cube.labelled(2,
                               [](const Vec3& p) {
                                 const Vec3 q = {p[0] - 1, p[1] - 1, p[2] - 1};
                                 const Vec3 s = {q[0] * q[0], q[1] * q[1], q[2] * q[2]};
                                 Vec3 round{};
                                 for (std::size_t i = 0; i < 3; ++i) {
                                   const double a = s[(i + 1) % 3];
                                   const double b = s[(i + 2) % 3];
                                   round[i] = q[i] * std::sqrt(1 - a / 2 - b / 2 + a * b / 3);
                                 }
                                 return round;
                               })
                     .tets;
  const std::vector<Vec3> smooth = ball.points;
  std::mt19937 random(seed);
  for (Vec3& p : ball.points) {
    const double size = std::hypot(p[0], p[1], p[2]);
    const double bump = 1e-10 * static_cast<double>(random()) / 4.3 - 0.1;  // -0.1 to 0
    for (double& x : p) x *= size > 0.99 ? 1 + 2 * bump + 0.1 : 1;
  }
  for (bool isFolded = true; isFolded;) {
    isFolded = false;
    for (const Tet& tet : ball.tets) {
      if (sixfoldVolume(ball.points, tet) > 1e-5) continue;
      isFolded = true;
      for (const Index v : tet) {
        for (std::size_t k = 0; k < 3; ++k) {
          ball.points[v][k] = (ball.points[v][k] + smooth[v][k]) / 2;
        }
      }
    }
  }
  return ball;
}

/// Edges between coarse triangles of a smooth surface are sharp here and there, and fade out: they
/// get no tag, and vertices of bad cells may leave them.
TEST(Shapes, LetFadingEdgesGo) {
  HEXHEX_LARGE_TEST();
  for (const unsigned seed : {4U, 5U}) {
    SCOPED_TRACE(seed);
    const MeshedPart outcome = meshed(bumpyBall(seed), 1000);
    EXPECT_LT(outcome.map.features.edges.size(), outcome.shape.taggedEdges);
    EXPECT_GT(outcome.improvement.offCreases, 0U);
    EXPECT_GE(outcome.improvement.after.quality.minimum, 0.24);
  }
}

TEST(Shapes, AreCylinders) {
  HEXHEX_LARGE_TEST();
  const TetMesh cylinder = box()
                               .labelled(4,
                                         [](const Vec3& p) {
                                           const auto [x, y] = rounded<2>({p[0] - 1, p[1] - 1});
                                           return turned({x, y, 2 * p[2]}, 0.5);
                                         })
                               .tets;
  expectMesh(cylinder, 6, 8);
}

TEST(Shapes, AreTori) {
  HEXHEX_LARGE_TEST();
  const TetMesh torus =
      ring()
          .labelled(
              3,
              [](const Vec3& p) {
                const Vec3 inRing = {2 * p[0] - 3, 2 * p[1] - 3, 2 * p[2] - 1};
                const double radius = std::max(std::abs(inRing[0]), std::abs(inRing[1]));
                const double length = std::hypot(inRing[0], inRing[1]);
                const auto [out, up] = rounded<2>({radius - 2, inRing[2]});
                return Vec3{(3 + out) * inRing[0] / length, (3 + out) * inRing[1] / length, up};
              })
          .tets;
  const MeshedPart outcome = meshed(torus, 1000);
  EXPECT_TRUE(outcome.shape.labels.isValid());
  EXPECT_TRUE(outcome.improvement.after.allPositive());
}

TEST(Shapes, AreWedges) {
  const TetMesh wedge = box()
                            .labelled(4,
                                      [](const Vec3& p) {
                                        return Vec3{p[0], p[1] * (1.2 - 0.5 * p[0]), p[2]};
                                      })
                            .tets;
  expectMesh(wedge, 6, 8);
}

TEST(Shapes, MayHaveVoidsAndSeveralComponents) {
  const CubeBody hollow({3, 3, 3}, [](const Cell& c) { return c != Cell{1, 1, 1}; });
  expectMesh(hollow.labelled(2, [](const Vec3& p) { return p; }).tets, 12, 16);
  const CubeBody two({3, 1, 1}, [](const Cell& c) { return c[0] != 1; });
  expectMesh(two.labelled(3, [](const Vec3& p) { return turned(p, 0.2); }).tets, 12, 16);
}

TEST(Shapes, DoNotDependOnThreadsNorOnTheOrderOfCorners) {
  const TetMesh tets =
      angle().labelled(3, [](const Vec3& p) { return turned(rounded(p), 0.3); }).tets;
  const ShapedMap one = shaped(tets, 1);
  const ShapedMap four = shaped(tets, 4);
  EXPECT_EQ(one.map.points, four.map.points);
  EXPECT_EQ(one.map.parameters, four.map.parameters);
  TetMesh swapped = tets;
  for (std::size_t t = 0; t < swapped.tets.size(); t += 3) {
    std::swap(swapped.tets[t][2], swapped.tets[t][3]);
  }
  const ShapedMap other = shaped(swapped);
  EXPECT_EQ(one.map.points, other.map.points);
  EXPECT_EQ(one.map.tets, other.map.tets);
  EXPECT_EQ(one.map.parameters, other.map.parameters);
}

TEST(Shapes, KeepTheGivenPoints) {
  const TetMesh tets = angle().labelled(2, [](const Vec3& p) { return turned(p, 0.3); }).tets;
  const TetMap map = shaped(tets).map;
  ASSERT_GE(map.points.size(), tets.points.size());
  for (std::size_t v = 0; v < tets.points.size(); ++v) EXPECT_EQ(map.points[v], tets.points[v]);
}

TEST(Shapes, RefuseWhatIsOutOfRange) {
  const TetMesh tets = box().labelled(1, [](const Vec3& p) { return p; }).tets;
  for (const double angle : {-1.0, 181.0, std::nan("")}) {
    Context context;
    EXPECT_EQ(
        codeOf([&] { static_cast<void>(mapFromTets(tets, {.featureAngle = angle}, context)); }),
        ErrorCode::InvalidArgument);
  }
}

/// A tet with a spike on each face: only edges that are split have room for labels.
TEST(Shapes, EndTheSearchForLabelsAtItsBound) {
  const TetMesh star = spikedTet();
  Context context(1);
  const shape::PositiveTets positive(star);
  const shape::Surface surface = shape::readSurface(positive, context);
  const auto map = [&](double work) {
    ShapeReport report;
    return shape::polycubeMap(positive, surface, 1, work, report, context);
  };
  const Error error = errorOf([&] { static_cast<void>(map(1)); });
  EXPECT_EQ(error.code(), ErrorCode::NotMeshable);
  for (const char* const words :
       {"the best labels that were found have", "Labels by loops along handles have no map either",
        "ended at the bound of its work"}) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
  EXPECT_FALSE(map(shape::workFor(star.tets.size())).parameters.empty());
}

/// No labels of four to twelve triangles are those of a polycube: edges are split where loops need
/// room. A tet, a bipyramid, an octahedron, a pyramid and a wedge.
TEST(Shapes, GetMoreTrianglesWhereLabelsHaveNoRoom) {
  const std::vector<Vec3> ends = {
      {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}};
  const std::vector<Vec3> axes = {{1, 0, 0},  {-1, 0.1, 0}, {0, 1, 0},
                                  {0, -1, 0}, {0, 0, 1},    {0, 0, -1.1}};
  const std::vector<Vec3> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.6, 1}};
  const std::vector<Vec3> prism = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {0, 1, 1.1}};
  std::vector<TetMesh> bodies = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}},
                                 {ends, {{1, 4, 2, 3}, {0, 2, 4, 3}}},
                                 {axes, {{2, 5, 3, 1}, {2, 3, 5, 0}, {2, 3, 4, 1}, {2, 4, 3, 0}}},
                                 {square, {{3, 2, 4, 1}, {3, 1, 4, 0}}},
                                 {prism, {{4, 3, 5, 2}, {4, 3, 2, 0}, {4, 2, 1, 0}}}};
  bodies.resize(std::min<std::size_t>(bodies.size(), static_cast<std::size_t>(cases(5))));
  for (const TetMesh& tets : bodies) {
    SCOPED_TRACE(tets.tets.size());
    const ShapedMap found = shaped(tets);
    EXPECT_GE(found.report.labels.charts, 6U);
    EXPECT_TRUE(std::equal(tets.points.begin(), tets.points.end(), found.map.points.begin()));
    ExtractOptions exact;
    exact.tolerance = 0;
    const HexMesh mesh = verifiedExtraction(quantize(found.map, {.cells = 50}).map, exact);
    EXPECT_FALSE(mesh.cells.empty());
  }
}

TEST(Shapes, CanBeCancelled) {
  const TetMesh tets = ring().labelled(3, [](const Vec3& p) { return turned(p, 0.3); }).tets;
  for (const char* const where : {"surface", "labelling", "planes"}) {
    Context* running = nullptr;
    Context context(2, [&](std::string_view stage, double /*share*/) {
      if (stage == where) running->cancel();
    });
    running = &context;
    EXPECT_EQ(codeOf([&] {
                static_cast<void>(mapFromTets(tets, {.method = ShapeMethod::Polycube}, context));
              }),
              ErrorCode::Cancelled)
        << where;
  }
}

/// Faces of a tetrahedron are oblique in each polycube; along frames they are not.
TEST(Shapes, TakeTheBetterOfBothWays) {
  HEXHEX_LARGE_TEST();
  const TetMap sample = generateSample(SampleKind::Tetrahedron).map;
  const TetMesh tets = {sample.points, sample.tets};
  const MeshedPart polycube = meshed(tets, 500);
  Context context;
  MeshOptions options;
  options.quantize = {.cells = 500, .densify = true};
  const MeshedPart best = meshFromTets(tets, options, context);
  EXPECT_EQ(best.shape.method, ShapeMethod::Frames);
  EXPECT_TRUE(best.verification.passed());
  EXPECT_TRUE(best.improvement.after.allPositive());
  EXPECT_GT(best.improvement.after.minimum, polycube.improvement.after.minimum);
  const ShapedMap map = mapFromTets(tets, {}, context);
  EXPECT_EQ(map.report.method, ShapeMethod::Frames);
  EXPECT_EQ(map.report.taggedEdges, map.report.featureEdges);
}

/// Those of samples are bodies of several kinds, some with many tets in a point.
TEST(Shapes, AreThoseOfSamples) {
  HEXHEX_LARGE_TEST();
  for (const SampleKindName& kind : sampleKinds()) {
    SCOPED_TRACE(kind.name);
    const TetMap sample = generateSample(kind.kind).map;
    const MeshedPart outcome = meshed({sample.points, sample.tets}, 500);
    EXPECT_TRUE(outcome.improvement.after.allPositive());
  }
}

}  // namespace
}  // namespace hexhex::test
