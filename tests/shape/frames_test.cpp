// Maps along frame fields of bodies whose singular curves are known.
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <shape/frames_field.hpp>
#include <shape/frames_map.hpp>
#include <shape/frames_matching.hpp>
#include <shape/frames_rematch.hpp>
#include <shape/frames_tensor.hpp>
#include <shape/frames_tets.hpp>
#include <support/effort.hpp>

#include <hexhex/hexhex.hpp>

#include "support/error_of.hpp"
#include "support/labelled_bodies.hpp"

namespace hexhex::test {

using namespace shape;

namespace {

constexpr double kFeatureAngle = 40;

TetMap framesMap(const TetMesh& tets, int threads = 0) {
  Context context(threads);
  Stage stage(context, "frames");
  TetMap map;
  withThreads(threads, [&] { map = mapFromFrames(tets, kFeatureAngle, stage); });
  return map;
}

CubeBody bodyOf(const CubeBody::Cell& size) {
  return {size, [](const CubeBody::Cell&) { return true; }};
}

/// A box of unit cubes, deformed.
TetMesh boxOf(const CubeBody::Cell& size, int fineness,
              const std::function<Vec3(const Vec3&)>& place) {
  return bodyOf(size).labelled(fineness, place).tets;
}

Vec3 turnedBy(const Eigen::Quaterniond& turn, const Vec3& p) {
  const Eigen::Vector3d image = turn * Eigen::Vector3d(p[0], p[1], p[2]);
  return {image[0], image[1], image[2]};
}

/// A disc of a square: each ray is scaled.
std::array<double, 2> onDisc(double x, double y) {
  const double most = std::max(std::abs(x), std::abs(y));
  const double length = std::hypot(x, y);
  return length == 0 ? std::array<double, 2>{}
                     : std::array<double, 2>{x * most / length, y * most / length};
}

/// A prism over a triangle.
Vec3 onWedge(const Vec3& p) {
  // The corners (0,0), (4,0), (4,4), (0,4) go to the triangle's, and one to the middle of a side.
  const double x = p[0] / 4;
  const double y = p[1] / 4;
  const Eigen::Vector2d a(0, 0);
  const Eigen::Vector2d b(4, 0);
  const Eigen::Vector2d c(3, std::sqrt(3.0));
  const Eigen::Vector2d d(2, 2 * std::sqrt(3.0));
  const Eigen::Vector2d q = (1 - x) * (1 - y) * a + x * (1 - y) * b + x * y * c + (1 - x) * y * d;
  return {q[0], q[1], p[2]};
}

HexMesh certifiedMesh(const TetMap& map, double cells) {
  Context context;
  const SeamlessReport report = examineSeamless(map, context);
  EXPECT_EQ(report.kind, SeamlessKind::Seamless) << report.problem;
  // Parameters are on a grid: what is left is what the examination itself rounds.
  double size = 0;
  for (const TetParameters& u : map.parameters) {
    for (const Vec3& corner : u) {
      for (const double x : corner) size = std::max(size, std::abs(x));
    }
  }
  EXPECT_LT(report.displacement, 1e-9 * size);
  const QuantizedMap quantized = quantize(map, {.cells = cells}, context);
  HexMesh mesh = extract(quantized.map, {}, context);
  EXPECT_TRUE(verify(quantized.map, mesh).passed());
  static_cast<void>(improve(mesh, quantized.map, {}, context));
  EXPECT_TRUE(certify(mesh, context).allPositive());
  return mesh;
}

/// Edges of hexahedra by the number of cells around them; regular ones inside are left out.
std::map<std::pair<bool, int>, int> edgeValences(const HexMesh& mesh) {
  constexpr std::array<std::array<int, 2>, 12> kEdges = {{{0, 1},
                                                          {1, 2},
                                                          {2, 3},
                                                          {3, 0},
                                                          {4, 5},
                                                          {5, 6},
                                                          {6, 7},
                                                          {7, 4},
                                                          {0, 4},
                                                          {1, 5},
                                                          {2, 6},
                                                          {3, 7}}};
  constexpr std::array<std::array<int, 4>, 6> kFaces = {
      {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  std::map<std::array<Index, 2>, int> cells;
  std::map<std::array<Index, 4>, int> faces;
  const auto pair = [](Index a, Index b) {
    return std::array<Index, 2>{std::min(a, b), std::max(a, b)};
  };
  for (const Hex& cell : mesh.cells) {
    for (const auto& [a, b] : kEdges)
      ++cells[pair(cell[static_cast<std::size_t>(a)], cell[static_cast<std::size_t>(b)])];
    for (const auto& face : kFaces) {
      std::array<Index, 4> key{};
      for (std::size_t k = 0; k < 4; ++k) key[k] = cell[static_cast<std::size_t>(face[k])];
      std::sort(key.begin(), key.end());
      ++faces[key];
    }
  }
  std::map<std::array<Index, 2>, bool> isOuter;
  for (const Hex& cell : mesh.cells) {
    for (const auto& face : kFaces) {
      std::array<Index, 4> key{};
      for (std::size_t k = 0; k < 4; ++k) key[k] = cell[static_cast<std::size_t>(face[k])];
      std::sort(key.begin(), key.end());
      if (faces[key] != 1) continue;
      for (std::size_t k = 0; k < 4; ++k) {
        isOuter[pair(cell[static_cast<std::size_t>(face[k])],
                     cell[static_cast<std::size_t>(face[(k + 1) % 4])])] = true;
      }
    }
  }
  std::map<std::pair<bool, int>, int> valences;
  for (const auto& [edge, count] : cells) {
    const bool isInside = !isOuter.contains(edge);
    if (count != (isInside ? 4 : 2)) ++valences[{isInside, count}];
  }
  return valences;
}

TEST(FrameTensor, IsThatOfAllFramesWithTheSameAxes) {
  const Frame frame = Eigen::Quaterniond(0.3, 0.1, -0.7, 0.4).normalized().toRotationMatrix();
  Frame other;
  other << -frame.col(2), frame.col(1), frame.col(0);
  EXPECT_LT((tensorOf(frame) - tensorOf(other)).norm(), 1e-12);
  EXPECT_NEAR(tensorOf(frame).norm(), tensorOf(Frame::Identity()).norm(), 1e-12);
}

TEST(FrameTensor, HasItsFrameAsTheNearest) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Quaterniond q(std::cos(i), std::sin(2.0 * i), std::cos(3.0 * i),
                               std::sin(5.0 * i));
    const Frame frame = q.normalized().toRotationMatrix();
    const Frame found = nearestFrame(tensorOf(frame), Frame::Identity());
    EXPECT_NEAR(found.determinant(), 1, 1e-9);
    double best = -3;
    for (int r = 0; r < lattice::Rotation::kCount; ++r) {
      best = std::max(best, likeness(found, frame, lattice::Rotation(r)));
    }
    EXPECT_NEAR(best, 3, 1e-9);
  }
}

TEST(FrameTensor, MovesAroundACircleWithOneAxisFixed) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
  const TensorCircle circle(axis);
  for (const double angle : {-0.7, 0.0, 0.2, 0.6}) {
    const FrameTensor point =
        circle.middle + std::cos(4 * angle) * circle.cosine + std::sin(4 * angle) * circle.sine;
    EXPECT_LT((point - tensorOf(frameAbout(axis, angle))).norm(), 1e-12);
  }
}

/// Around a vertex, hexahedra are triangles on a sphere: those with three, four or five at each
/// corner have deltahedra's names.
TEST(FrameNodes, AreThoseOfTriangulatedSpheres) {
  EXPECT_TRUE(isNode(0, 0));   // octahedron
  EXPECT_TRUE(isNode(4, 0));   // tetrahedron: the corners of the cube in a ball
  EXPECT_TRUE(isNode(2, 0));   // triangular bipyramid: a curve that goes on
  EXPECT_TRUE(isNode(0, 2));   // pentagonal bipyramid, likewise
  EXPECT_TRUE(isNode(2, 2));   // two tetrahedra on faces of a third
  EXPECT_TRUE(isNode(1, 3));   // an octahedron with a tetrahedron on a face
  EXPECT_TRUE(isNode(0, 4));   // snub disphenoid
  EXPECT_TRUE(isNode(0, 6));   // triaugmented triangular prism
  EXPECT_TRUE(isNode(2, 6));   // an octahedron with tetrahedra on opposite faces
  EXPECT_TRUE(isNode(0, 8));   // gyroelongated square bipyramid
  EXPECT_TRUE(isNode(0, 12));  // icosahedron
  EXPECT_FALSE(isNode(1, 0));  // ends
  EXPECT_FALSE(isNode(0, 1));
  EXPECT_FALSE(isNode(1, 1));  // changes its valence
  EXPECT_FALSE(isNode(3, 1));  // Euler's formula holds for these, but there is no such sphere
  EXPECT_FALSE(isNode(3, 3));
  EXPECT_FALSE(isNode(0, 10));  // eleven corners
  EXPECT_FALSE(isNode(5, 0));
}

/// The identity, but for a rotation of the grid and a translation: no tet is distorted.
TEST(FramesMap, KeepsABoxAsItIs) {
  for (const double angle : {0.0, 0.4, 1.1}) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()));
    const TetMesh box = boxOf({3, 2, 1}, 2, [&](const Vec3& p) { return turnedBy(turn, p); });
    const TetMap map = framesMap(box);
    for (std::size_t t = 0; t < map.tets.size(); ++t) {
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          EXPECT_NEAR(length(minus(map.parameters[t][i], map.parameters[t][j])),
                      length(minus(map.points[map.tets[t][i]], map.points[map.tets[t][j]])), 1e-4);
        }
      }
    }
    const auto valences = edgeValences(certifiedMesh(map, 48));
    EXPECT_EQ(valences.size(), 1);  // but for those of the box's twelve edges
    EXPECT_EQ(valences.begin()->first, std::pair(false, 1));
  }
}

TEST(FramesMap, HasFourCurvesInACylinder) {
  HEXHEX_LARGE_TEST();
  const TetMesh cylinder = boxOf({2, 2, 2}, 4, [](const Vec3& p) {
    const auto disc = onDisc(p[0] - 1, p[1] - 1);
    return Vec3{disc[0], disc[1], p[2]};
  });
  const auto valences = edgeValences(certifiedMesh(framesMap(cylinder), 500));
  ASSERT_TRUE(valences.contains({true, 3}));
  EXPECT_EQ(valences.size(), 2);  // and the edges of both discs
  EXPECT_TRUE(valences.contains({false, 1}));
  EXPECT_EQ(valences.at({true, 3}) % 4, 0);
}

TEST(FramesMap, HasOneCurveOfValenceThreeInATriangularPrism) {
  const TetMesh prism = boxOf({4, 4, 3}, 2, onWedge);
  const auto valences = edgeValences(certifiedMesh(framesMap(prism), 500));
  ASSERT_TRUE(valences.contains({true, 3}));
  EXPECT_FALSE(valences.contains({true, 5}));
  EXPECT_FALSE(valences.contains({false, 3}));
}

TEST(FramesMap, OfABallIsACubeInACube) {
  const TetMesh ball = boxOf({2, 2, 2}, 3, [](const Vec3& p) {
    const Vec3 inBox = {p[0] - 1, p[1] - 1, p[2] - 1};
    return rounded(inBox);
  });
  const auto valences = edgeValences(certifiedMesh(framesMap(ball), 500));
  // Twelve curves of valence 3 bound the inner cube, eight end at the boundary: and no edges there.
  EXPECT_EQ(valences.size(), 1);
  EXPECT_TRUE(valences.contains({true, 3}));
}

TEST(FramesMap, IsTheSameWithAnyNumberOfThreads) {
  const TetMesh cylinder = boxOf({2, 2, 1}, 3, [](const Vec3& p) {
    const auto disc = onDisc(p[0] - 1, p[1] - 1);
    return Vec3{disc[0], disc[1], p[2]};
  });
  const TetMap one = framesMap(cylinder, 1);
  const TetMap three = framesMap(cylinder, 3);
  EXPECT_EQ(one.points, three.points);
  EXPECT_EQ(one.tets, three.tets);
  EXPECT_EQ(one.parameters, three.parameters);
}

TEST(FramesMap, BeginsWithThePointsGiven) {
  const TetMesh box = boxOf({1, 1, 1}, 2, [](const Vec3& p) { return p; });
  const TetMap map = framesMap(box);
  ASSERT_GE(map.points.size(), box.points.size());
  EXPECT_TRUE(std::equal(box.points.begin(), box.points.end(), map.points.begin()));
}

TEST(FramesMap, RefusesTetsThatAreInsideOut) {
  TetMesh box = boxOf({1, 1, 1}, 2, [](const Vec3& p) { return p; });
  std::swap(box.tets[5][0], box.tets[5][1]);
  const Error error = errorOf([&] { static_cast<void>(framesMap(box)); });
  EXPECT_EQ(error.code(), ErrorCode::FlippedTet);
  EXPECT_EQ(toString(error.place()), "tet 5");
}

TEST(FramesMap, CanBeCancelled) {
  const TetMesh box = boxOf({2, 2, 2}, 3, [](const Vec3& p) { return p; });
  Context context;
  Stage stage(context, "frames");
  context.cancel();
  const Error error = errorOf([&] { static_cast<void>(mapFromFrames(box, kFeatureAngle, stage)); });
  EXPECT_EQ(error.code(), ErrorCode::Cancelled);
}

}  // namespace

}  // namespace hexhex::test
