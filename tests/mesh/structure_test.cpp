// The structure of small meshes whose singular edges are known.
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include <hexhex/error.hpp>
#include <hexhex/structure.hpp>

#include <mesh/grid_meshes.hpp>

#include "support/error_of.hpp"

namespace hexhex {
namespace {

using testing::gridMesh;

MeshStructure structureOf(const HexMesh& mesh, int threads = 0) {
  Context context(threads);
  return findStructure(mesh, context);
}

TEST(Structure, OfACube) {
  const MeshStructure cube = structureOf(gridMesh(3));
  EXPECT_EQ(cube.boundaryQuads, 54U);
  EXPECT_EQ(cube.faces, 108U);
  EXPECT_EQ(cube.edges, 144U);
  EXPECT_EQ(cube.components, 1U);
  EXPECT_EQ(cube.boundaryComponents, 1U);
  EXPECT_EQ(cube.eulerCharacteristic, 1);
  ASSERT_EQ(cube.singularEdges.size(), 36U);
  for (const SingularHexEdge& edge : cube.singularEdges) {
    EXPECT_LT(edge.vertex0, edge.vertex1);
    EXPECT_EQ(edge.valence, 1U);
    EXPECT_TRUE(edge.boundary);
  }
}

TEST(Structure, OfANotch) {
  // Without one of its eight cells, a cube has three edges of three cells at the notch.
  const HexMesh mesh =
      gridMesh(2, [](std::size_t x, std::size_t y, std::size_t z) { return x + y + z < 3; });
  std::size_t concave = 0;
  for (const SingularHexEdge& edge : structureOf(mesh).singularEdges) {
    EXPECT_TRUE(edge.boundary);
    if (edge.valence == 3) ++concave;
  }
  EXPECT_EQ(concave, 3U);
}

/// Three cells around a common edge, which is inside.
TEST(Structure, OfAnInnerEdge) {
  HexMesh mesh;
  for (const double z : {0.0, 1.0}) {
    mesh.points.push_back({0, 0, z});
    for (const auto& [x, y] :
         {std::array{2.0, 0.0}, {1.0, 2.0}, {-1.0, 2.0}, {-2.0, 0.0}, {-1.0, -2.0}, {1.0, -2.0}}) {
      mesh.points.push_back({x, y, z});
    }
  }
  for (const auto& [a, b, c] : {std::array<Index, 3>{1, 2, 3}, {3, 4, 5}, {5, 6, 1}}) {
    mesh.cells.push_back({0, a, b, c, 7, a + 7, b + 7, c + 7});
  }
  const MeshStructure structure = structureOf(mesh);
  const SingularHexEdge inner{0, 7, 3, false};
  EXPECT_EQ(std::ranges::count(structure.singularEdges, inner), 1);
  EXPECT_EQ(std::ranges::count(structure.singularEdges, false, &SingularHexEdge::boundary), 1);
}

TEST(Structure, DoesNotDependOnTheNumberOfThreads) {
  const HexMesh mesh = gridMesh(
      30, [](std::size_t x, std::size_t y, std::size_t z) { return (x * y + z) % 7 != 0; });
  EXPECT_EQ(structureOf(mesh, 1).singularEdges, structureOf(mesh, 4).singularEdges);
}

TEST(Structure, RefusesCornersThatDoNotExist) {
  HexMesh mesh = gridMesh(1);
  mesh.cells[0][3] = 100;
  EXPECT_EQ(test::codeOf([&] { static_cast<void>(structureOf(mesh)); }),
            ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace hexhex
