// Faces, edges and components of small meshes whose numbers are known.
#include <cmath>
#include <utility>

#include <adjacency/hex_topology.hpp>
#include <gtest/gtest.h>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <mesh/grid_meshes.hpp>

namespace hexhex::adjacency {
namespace {

using testing::gridMesh;
using testing::reversed;
using testing::shuffled;
using Counts = std::map<int, std::uint64_t>;

struct Topology {
  HexFaces faces;
  HexEdges edges;
  std::int64_t euler = 0;
};

Topology topologyOf(const HexMesh& mesh, int threads = 0) {
  Context context(threads);
  Stage stage(context, "test");
  Topology result;
  withThreads(threads, [&] {
    const VertexCells around = cellsAroundVertices(mesh, stage);
    result.faces = findFaces(mesh, around, stage);
    result.edges = findEdges(mesh, around, result.faces, stage);
  });
  result.euler = static_cast<std::int64_t>(result.faces.usedVertices + result.faces.count) -
                 static_cast<std::int64_t>(result.edges.count + mesh.cells.size());
  return result;
}

/// A ring of `n` cells around the z axis.
HexMesh ringMesh(std::size_t n) {
  HexMesh mesh;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(n);
    for (const double z : {0.0, 1.0}) {
      for (const double r : {1.0, 2.0}) {
        mesh.points.push_back({r * std::cos(angle), r * std::sin(angle), z});
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const auto a = static_cast<Index>(4 * i);
    const auto b = static_cast<Index>(4 * ((i + 1) % n));
    mesh.cells.push_back({a, a + 1, b + 1, b, a + 2, a + 3, b + 3, b + 2});
  }
  return mesh;
}

TEST(HexTables, FacesFaceOutwardsAndEdgesAreEdges) {
  const HexMesh cube = gridMesh(1);
  const Hex& cell = cube.cells[0];
  for (std::size_t f = 0; f < 6; ++f) {
    const Quad quad = faceVertices(cell, f);
    const Vec3& a = cube.points[quad[0]];
    const Vec3& b = cube.points[quad[1]];
    const Vec3& c = cube.points[quad[2]];
    const Vec3& d = cube.points[quad[3]];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      const std::size_t m = (k + 2) % 3;
      const double normal = (b[l] - a[l]) * (d[m] - a[m]) - (b[m] - a[m]) * (d[l] - a[l]);
      // The face's middle minus the middle of the cube, doubled, is the unit normal.
      EXPECT_EQ(normal, (a[k] + c[k]) / 2 * 2 - 1) << "face " << f << " axis " << k;
    }
  }
  for (const auto& [a, b] : kHexEdges) {
    int differences = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (cube.points[cell[a]][k] != cube.points[cell[b]][k]) ++differences;
    }
    EXPECT_EQ(differences, 1);
  }
}

TEST(HexTopology, GridHasTheCountsOfTheFormulas) {
  for (const std::size_t n : {1U, 2U, 3U, 7U, 20U}) {
    const Topology found = topologyOf(shuffled(gridMesh(n), n));
    EXPECT_EQ(found.faces.usedVertices, (n + 1) * (n + 1) * (n + 1));
    EXPECT_EQ(found.edges.count, 3 * n * (n + 1) * (n + 1));
    EXPECT_EQ(found.faces.count, 3 * n * n * (n + 1));
    EXPECT_EQ(found.faces.boundaryCount, 6 * n * n);
    EXPECT_EQ(found.edges.boundaryCount, 12 * n * n);
    EXPECT_EQ(found.euler, 1);
    EXPECT_EQ(found.faces.components, 1U);
    EXPECT_EQ(found.edges.boundaryComponents, 1U);
    EXPECT_EQ(found.edges.openCount, 0U);
    EXPECT_EQ(found.edges.innerSingular, Counts());
    EXPECT_EQ(found.edges.boundarySingular, (Counts{{1, 12 * n}}));
    EXPECT_EQ(found.faces.overfull.count, 0U);
    EXPECT_EQ(found.faces.sameDirection.count, 0U);
    EXPECT_EQ(found.faces.firstUnusedVertex, kNone);
  }
}

TEST(HexTopology, EmptyMesh) {
  const Topology found = topologyOf(HexMesh{});
  EXPECT_EQ(found.faces.count, 0U);
  EXPECT_EQ(found.edges.count, 0U);
  EXPECT_EQ(found.faces.components, 0U);
  EXPECT_EQ(found.edges.boundaryComponents, 0U);
}

TEST(HexTopology, RingIsASolidTorus) {
  for (const std::size_t n : {3U, 4U, 50U}) {
    const Topology found = topologyOf(ringMesh(n));
    EXPECT_EQ(found.euler, 0);
    EXPECT_EQ(found.faces.boundaryCount, 4 * n);
    EXPECT_EQ(found.edges.boundarySingular, (Counts{{1, 4 * n}}));
    EXPECT_EQ(found.edges.boundaryComponents, 1U);
    EXPECT_EQ(found.faces.sameDirection.count, 0U);
  }
}

TEST(HexTopology, CavityIsASecondBoundaryComponent) {
  const HexMesh shell = gridMesh(
      3, [](std::size_t x, std::size_t y, std::size_t z) { return x != 1 || y != 1 || z != 1; });
  const Topology found = topologyOf(shell);
  EXPECT_EQ(found.euler, 2);
  EXPECT_EQ(found.faces.boundaryCount, 54U + 6U);
  EXPECT_EQ(found.edges.boundaryComponents, 2U);
  EXPECT_EQ(found.faces.components, 1U);
  // The cavity's edges have three cells around them.
  EXPECT_EQ(found.edges.boundarySingular, (Counts{{1, 36}, {3, 12}}));
}

TEST(HexTopology, ComponentsAreConnectedThroughFaces) {
  // Two cubes that touch in an edge only: one boundary, as it is connected through that edge, but
  // four of its quads meet there.
  const HexMesh mesh =
      gridMesh(2, [](std::size_t x, std::size_t y, std::size_t z) { return x == y && z == 0; });
  const Topology found = topologyOf(mesh);
  EXPECT_EQ(found.faces.components, 2U);
  EXPECT_EQ(found.edges.boundaryComponents, 1U);
  EXPECT_EQ(found.edges.openCount, 1U);
  EXPECT_EQ(mesh.points[found.edges.firstOpen.vertex0], (Vec3{1, 1, 0}));
  EXPECT_EQ(mesh.points[found.edges.firstOpen.vertex1], (Vec3{1, 1, 1}));
}

TEST(HexTopology, SeparateCellsAreSeparateComponents) {
  const HexMesh mesh = gridMesh(
      3, [](std::size_t x, std::size_t y, std::size_t z) { return x != 1 && y != 1 && z != 1; });
  const Topology found = topologyOf(mesh);
  EXPECT_EQ(found.faces.components, 8U);
  EXPECT_EQ(found.edges.boundaryComponents, 8U);
  EXPECT_EQ(found.euler, 8);
}

TEST(HexTopology, FaceOfThreeCellsIsNoted) {
  HexMesh mesh = gridMesh(1);
  mesh.cells.push_back(mesh.cells[0]);
  mesh.cells.push_back(mesh.cells[0]);
  const Topology found = topologyOf(mesh);
  EXPECT_EQ(found.faces.overfull.count, 6U);
  EXPECT_EQ(found.faces.overfull.first.cell, 0U);
  EXPECT_EQ(found.faces.boundaryCount, 0U);
}

TEST(HexTopology, ReversedCellSharesFacesInTheSameDirection) {
  HexMesh mesh = gridMesh(3);
  mesh.cells[13] = reversed(mesh.cells[13]);  // the one in the middle
  const Topology found = topologyOf(mesh);
  EXPECT_EQ(found.faces.sameDirection.count, 6U);
  EXPECT_EQ(found.faces.overfull.count, 0U);
}

TEST(HexTopology, TwistedFaceIsNoFaceOfTheNeighbour) {
  HexMesh mesh = gridMesh(2);
  std::swap(mesh.cells[0][1], mesh.cells[0][5]);  // the face to cell 1 keeps its vertex set
  EXPECT_GE(topologyOf(mesh).faces.sameDirection.count, 1U);
}

TEST(HexTopology, UnusedVerticesAreCounted) {
  HexMesh mesh = gridMesh(2);
  for (int i = 0; i < 3; ++i) mesh.points.push_back({9, 9, 9});
  const Topology found = topologyOf(mesh);
  EXPECT_EQ(found.faces.usedVertices, 27U);
  EXPECT_EQ(found.faces.firstUnusedVertex, 27U);
}

TEST(HexTopology, CellThatMeetsItselfIsCountedOnce) {
  // One cell whose top is glued to its bottom.
  HexMesh mesh = gridMesh(1);
  mesh.cells[0] = {0, 1, 2, 3, 0, 1, 2, 3};
  const Topology found = topologyOf(mesh);
  EXPECT_EQ(found.faces.usedVertices, 4U);
  EXPECT_EQ(found.faces.count, 5U);  // bottom = top, and four sides that are folded flat
  EXPECT_EQ(found.faces.boundaryCount, 4U);
  EXPECT_EQ(found.faces.sameDirection.count, 0U);
  EXPECT_EQ(found.edges.count, 8U);  // four around, and four loops
}

TEST(HexTopology, CornerOutOfRangeIsAnError) {
  HexMesh mesh = gridMesh(2);
  mesh.cells[5][3] = 27;
  mesh.cells[6][0] = kNone;
  try {
    (void)topologyOf(mesh);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_EQ(error.place().kind, PlaceKind::Cell);
    EXPECT_EQ(error.place().index, 5U);
  }
}

TEST(HexTopology, DoesNotDependOnThreads) {
  // Two holes that touch in an edge.
  const auto exists = [](std::size_t x, std::size_t y, std::size_t z) {
    return z != 5 || x != y || (x != 5 && x != 6);
  };
  HexMesh mesh = shuffled(gridMesh(30, exists), 7);
  for (const std::size_t c : {100U, 9000U, 20000U}) mesh.cells[c] = reversed(mesh.cells[c]);
  mesh.cells[555] = mesh.cells[444];
  mesh.cells[777][2] = mesh.cells[778][4];
  const Topology one = topologyOf(mesh, 1);
  EXPECT_GT(one.faces.overfull.count, 0U);
  EXPECT_GT(one.faces.sameDirection.count, 0U);
  EXPECT_GT(one.edges.openCount, 0U);
  for (const int threads : {2, 5}) {
    const Topology many = topologyOf(mesh, threads);
    EXPECT_EQ(many.faces.boundary, one.faces.boundary);
    EXPECT_EQ(many.faces.count, one.faces.count);
    EXPECT_EQ(many.faces.components, one.faces.components);
    EXPECT_EQ(many.faces.overfull.first.cell, one.faces.overfull.first.cell);
    EXPECT_EQ(many.faces.sameDirection.first.cell, one.faces.sameDirection.first.cell);
    EXPECT_EQ(many.edges.count, one.edges.count);
    EXPECT_EQ(many.edges.innerSingular, one.edges.innerSingular);
    EXPECT_EQ(many.edges.boundarySingular, one.edges.boundarySingular);
    EXPECT_EQ(many.edges.firstOpen.vertex0, one.edges.firstOpen.vertex0);
    EXPECT_EQ(many.edges.boundaryComponents, one.edges.boundaryComponents);
  }
}

}  // namespace
}  // namespace hexhex::adjacency
