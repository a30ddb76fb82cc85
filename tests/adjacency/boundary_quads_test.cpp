// The boundary of meshes, whole and broken, against sorting all faces.
#include <algorithm>
#include <map>

#include <adjacency/hex_topology.hpp>
#include <gtest/gtest.h>

#include <base/parallel.hpp>
#include <mesh/grid_meshes.hpp>

namespace hexhex::adjacency {
namespace {

using testing::gridMesh;
using testing::Random;
using testing::shuffled;

Array<Quad> quadsOf(const HexMesh& mesh, int threads = 0) {
  Context context(threads);
  Stage stage(context, "test");
  Array<Quad> quads;
  withThreads(threads, [&] { quads = quadsAt(mesh, boundaryPlaces(mesh, stage)); });
  return quads;
}

/// The definition, written as plainly as possible.
Array<Quad> plainQuads(const HexMesh& mesh) {
  const auto sorted = [](Quad quad) {
    std::sort(quad.begin(), quad.end());
    return quad;
  };
  std::map<Quad, int> sides;
  for (const Hex& cell : mesh.cells) {
    for (std::size_t f = 0; f < 6; ++f) ++sides[sorted(faceVertices(cell, f))];
  }
  Array<Quad> quads;
  for (const Hex& cell : mesh.cells) {
    for (std::size_t f = 0; f < 6; ++f) {
      const Quad quad = faceVertices(cell, f);
      if (sides[sorted(quad)] == 1) quads.push_back(quad);
    }
  }
  return quads;
}

/// A grid's cells in random order, some of them missing, some doubled or with a vertex changed.
HexMesh brokenGrid(Random& random, bool doubled) {
  HexMesh mesh = shuffled(gridMesh(1 + random.below(22)), random.next());
  mesh.cells.resize(1 + random.below(mesh.cells.size()));
  if (!doubled) return mesh;
  for (std::size_t i = 0; i < 20; ++i) {
    // Again and again the same cell: faces of three and more.
    mesh.cells.push_back(mesh.cells[random.below(i % 2 == 0 ? mesh.cells.size() : 1)]);
    mesh.cells[random.below(mesh.cells.size())][random.below(8)] =
        static_cast<Index>(random.below(mesh.points.size()));
  }
  return mesh;
}

TEST(BoundaryQuads, OfNothing) { EXPECT_TRUE(quadsOf(HexMesh{}).empty()); }

TEST(BoundaryQuads, AreThoseOfThePlainDefinition) {
  Random random(17);
  for (int i = 0; i < 60; ++i) {
    const HexMesh mesh = brokenGrid(random, i % 2 == 1);
    EXPECT_EQ(quadsOf(mesh, 1 + i % 3), plainQuads(mesh)) << i;
  }
}

TEST(BoundaryQuads, OfLargeMeshes) {
  // Several blocks and tasks, so that faces are paired across them.
  const HexMesh mesh = gridMesh(60);
  const Array<Quad> quads = quadsOf(mesh, 2);
  EXPECT_EQ(quads.size(), 6U * 60 * 60);
  EXPECT_EQ(quads, plainQuads(mesh));
  EXPECT_EQ(quadsOf(mesh, 5), quads);
}

TEST(BoundaryQuads, AreSortedByCellAndFaceOutwards) {
  const HexMesh mesh = gridMesh(4);
  const Array<Quad> quads = quadsOf(mesh);
  ASSERT_EQ(quads.size(), 96U);
  std::size_t next = 0;
  for (const Hex& cell : mesh.cells) {
    for (std::size_t f = 0; f < 6; ++f) {
      const Quad quad = faceVertices(cell, f);
      if (next < quads.size() && quad == quads[next]) ++next;
    }
  }
  EXPECT_EQ(next, quads.size());
  for (const Quad& quad : quads) {
    int sides = 0;  // of the box that hold the whole quad
    for (std::size_t k = 0; k < 3; ++k) {
      for (const double side : {0.0, 4.0}) {
        if (std::all_of(quad.begin(), quad.end(),
                        [&](Index v) { return mesh.points[v][k] == side; })) {
          ++sides;
        }
      }
    }
    EXPECT_EQ(sides, 1);
  }
}

}  // namespace
}  // namespace hexhex::adjacency
