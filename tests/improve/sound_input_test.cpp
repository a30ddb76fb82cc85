// What is refused before anything moves: cells that overlap wherever their vertices are, and maps
// of other objects.
#include <algorithm>
#include <array>
#include <string>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>
#include <hexhex/extract.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/samples.hpp>

#include "mesh/grid_meshes.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {
namespace {

using hexhex::testing::gridMesh;
using hexhex::testing::Random;
using hexhex::testing::reversed;

/// The error of an improvement, which must leave the mesh as it was.
template <class Mesh>
Error refusalOf(Mesh mesh) {
  const Mesh before = mesh;
  Context context(2);
  const Error error = errorOf([&] { improve(mesh, ImproveOptions{}, context); });
  EXPECT_EQ(mesh.points, before.points);
  return error;
}

void expectWords(const Error& error, const std::string& words) {
  EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
}

void moveRandomly(HexMesh& mesh, double amount, std::uint64_t seed) {
  Random random(seed);
  for (Vec3& point : mesh.points) {
    for (double& x : point) x += amount * (2 * random.real() - 1);
  }
}

/// Such a mesh was certified: moving the vertices of a mirrored cell makes it positive, and overlap
/// its neighbours.
TEST(SoundInput, AMirroredCellIsNamedWithItsFace) {
  for (const std::size_t bad : {0U, 13U, 26U}) {
    HexMesh mesh = gridMesh(3);
    mesh.cells[bad] = reversed(mesh.cells[bad]);
    moveRandomly(mesh, 0.3, bad + 1);
    const Error error = refusalOf(mesh);
    EXPECT_EQ(error.code(), ErrorCode::Orientation);
    EXPECT_EQ(toString(error.place()), "cell " + std::to_string(bad));
    expectWords(error, "common face (");
    expectWords(error,
                "cell " + std::to_string(bad) + " lists its corners the other way round (1 of 27");
    expectWords(error, "convert --reorient");
  }
}

TEST(SoundInput, ManyMirroredCellsAreCounted) {
  HexMesh mesh = gridMesh(4);
  for (std::size_t c = 0; c < 16; ++c) mesh.cells[c] = reversed(mesh.cells[c]);  // a whole layer
  const Error error = refusalOf(mesh);
  EXPECT_EQ(error.code(), ErrorCode::Orientation);
  expectWords(error, "16 of 64 cells in all");
}

TEST(SoundInput, AMirroredMeshIsCalledSo) {
  HexMesh mesh = gridMesh(3);
  for (Hex& cell : mesh.cells) cell = reversed(cell);
  const Error error = refusalOf(mesh);
  EXPECT_EQ(error.code(), ErrorCode::Orientation);
  expectWords(error, "The mesh is mirrored");
  expectWords(error, "convert --reorient");
}

TEST(SoundInput, APartThatTouchesNoOtherMayBeMirrored) {
  HexMesh mesh = gridMesh(3, [](std::size_t x, std::size_t, std::size_t) { return x != 1; });
  for (Hex& cell : mesh.cells) {
    if (mesh.points[cell[0]][0] == 2) cell = reversed(cell);
  }
  const Error error = refusalOf(mesh);
  EXPECT_EQ(error.code(), ErrorCode::Orientation);
  expectWords(error, "part of the mesh that is mirrored");
}

TEST(SoundInput, AMoebiusBandHasNoOrientation) {
  HexMesh mesh = gridMesh(4, [](std::size_t x, std::size_t y, std::size_t) { return x + y == 0; });
  // The last cell ends at the first one's near face, mirrored.
  const Hex first = mesh.cells.front();
  Hex& last = mesh.cells.back();
  for (std::size_t k = 0; k < 4; ++k) last[4 + k] = first[k ^ 1U];
  const Error error = refusalOf(mesh);
  EXPECT_EQ(error.code(), ErrorCode::Orientation);
  expectWords(error, "Moebius");
}

TEST(SoundInput, CellsThatAreThereTwiceAreRefused) {
  HexMesh mesh = gridMesh(3);
  mesh.cells.push_back(mesh.cells[0]);
  const Error inside = refusalOf(mesh);
  EXPECT_EQ(inside.code(), ErrorCode::NonManifoldFace);
  expectWords(inside, "belongs to 3 cells, cells 0 and");
  mesh = gridMesh(1);
  mesh.cells.push_back(mesh.cells[0]);
  const Error alone = refusalOf(mesh);
  EXPECT_EQ(alone.code(), ErrorCode::Orientation);
  expectWords(alone, "same corners");
}

TEST(SoundInput, PrismsWrittenAsHexahedraAreRefused) {
  HexMesh mesh = gridMesh(3);
  for (const std::size_t c : {7U, 9U}) {
    mesh.cells[c][1] = mesh.cells[c][0];
    mesh.cells[c][5] = mesh.cells[c][4];
  }
  const Error error = refusalOf(mesh);
  EXPECT_EQ(error.code(), ErrorCode::RepeatedVertex);
  EXPECT_EQ(toString(error.place()), "cell 7");
  expectWords(error, "2 cells in all");
}

TEST(SoundInput, CellsOfHigherOrderAreNumberedAsTheMeshDoes) {
  Context context(2);
  const TetMap map = generateSample(SampleKind::Box, {.cells = 2}).map;
  LagrangeMesh mesh = extractLagrange(map, 2, {}, context);
  const std::ptrdiff_t nodes = 27;
  std::fill_n(mesh.nodes.begin() + 5 * nodes, nodes, mesh.nodes[5 * nodes]);
  const Error error = refusalOf(mesh);
  EXPECT_EQ(error.code(), ErrorCode::RepeatedVertex);
  EXPECT_EQ(toString(error.place()), "cell 5");
}

TEST(SoundInput, VerticesThatStayAreCountedByReason) {
  HexMesh mesh = gridMesh(3);
  const auto middle = static_cast<Index>(
      std::find(mesh.points.begin(), mesh.points.end(), Vec3{1, 1, 1}) - mesh.points.begin());
  mesh.features.vertices = {{middle, 3}, {0, 4}};  // an inner vertex, and a corner of the cube
  Context context(2);
  const ImproveReport report = improve(mesh, ImproveOptions{}, context);
  EXPECT_EQ(report.vertices[3], 9U);
  EXPECT_EQ(report.taggedVertices, 2U);
  EXPECT_EQ(report.boundaryVertices, 0U);
  ImproveOptions fixing;
  fixing.fixBoundary = true;
  const ImproveReport fixed = improve(mesh, fixing, context);
  EXPECT_EQ(fixed.vertices[3], 57U);
  EXPECT_EQ(fixed.taggedVertices, 2U);
  EXPECT_EQ(fixed.boundaryVertices, 48U);
}

TetMap mapOf(SampleKind kind, double jitter, std::uint64_t seed = 1) {
  SampleOptions options;
  options.cells = 2;
  options.jitter = jitter;
  options.seed = seed;
  return generateSample(kind, options).map;
}

HexMesh meshOf(const TetMap& map, int scale) {
  Context context(2);
  ExtractOptions options;
  options.scale = scale;
  return extract(map, options, context);
}

void improveOn(HexMesh& mesh, const TetMap& map) {
  Context context(2);
  improve(mesh, map, ImproveOptions{}, context);
}

TEST(SoundInput, MapsOfOtherObjectsAreRefusedWithPositions) {
  const TetMap torus = mapOf(SampleKind::Torus, 0.3);
  for (const int scale : {1, 3}) {
    for (const SampleKind kind : {SampleKind::Sphere, SampleKind::Cylinder, SampleKind::Box}) {
      HexMesh mesh = meshOf(mapOf(kind, 0.3), scale);
      const Error error = errorOf([&] { improveOn(mesh, torus); });
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      expectWords(error, "is not where the map is");
      expectWords(error, "but comes from (");
    }
  }
}

TEST(SoundInput, MapsInOtherUnitsOrElsewhereAreRefused) {
  const TetMap map = mapOf(SampleKind::Sphere, 0.3);
  const HexMesh mesh = meshOf(map, 2);
  TetMap scaled = map;
  TetMap shifted = map;
  for (std::size_t v = 0; v < map.points.size(); ++v) {
    for (double& x : scaled.points[v]) x *= 1000;
    shifted.points[v][1] += 2;
  }
  for (const TetMap* const other : {&scaled, &shifted}) {
    HexMesh copy = mesh;
    EXPECT_EQ(codeOf([&] { improveOn(copy, *other); }), ErrorCode::InvalidArgument);
  }
}

TEST(SoundInput, MeshesThatWereImprovedBeforeAreNotElsewhere) {
  HEXHEX_LARGE_TEST();
  for (const SampleKindName& kind : sampleKinds()) {
    const TetMap map = mapOf(kind.kind, 0.9, 3);
    HexMesh mesh = meshOf(map, 2);
    for (int times = 0; times < 3; ++times) EXPECT_NO_THROW(improveOn(mesh, map)) << kind.name;
  }
}

}  // namespace
}  // namespace hexhex::test
