// Layers around sets of cells, which end at the boundary.
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/quality.hpp>
#include <hexhex/structure.hpp>

#include <mesh/set_layers.hpp>

#include "mesh/grid_meshes.hpp"

namespace hexhex::test {
namespace {

using hexhex::testing::gridMesh;

mesh::SetLayers layersAround(const HexMesh& grid, const std::vector<Index>& sets) {
  Context context(2);
  Stage stage(context, "test");
  return mesh::addSetLayers(grid, sets, stage);
}

void expectBall(const HexMesh& mesh, std::size_t boundaryQuads) {
  Context context(2);
  const MeshStructure structure = findStructure(mesh, context);
  EXPECT_EQ(structure.eulerCharacteristic, 1);
  EXPECT_EQ(structure.boundaryQuads, boundaryQuads);
  EXPECT_TRUE(certify(mesh, context).allPositive());
}

}  // namespace

/// A cell in the middle of a face of the grid: five faces touch others, four of them reach the
/// boundary.
TEST(SetLayers, EndAtTheBoundary) {
  const HexMesh grid = gridMesh(3);
  std::vector<Index> sets(27, kNone);
  sets[4] = 7;
  const mesh::SetLayers layers = layersAround(grid, sets);
  EXPECT_EQ(layers.mesh.cells.size(), 27U + 5);
  EXPECT_EQ(layers.originals.size(), 8U);
  for (const Index set : layers.sets) EXPECT_EQ(set, 7U);
  expectBall(layers.mesh, 54 + 4);
  for (std::size_t c = 0; c < 27; ++c) {
    if (c == 4) continue;
    EXPECT_EQ(layers.mesh.cells[c], grid.cells[c]);
  }
}

/// Two sets side by side have a layer each, back to back.
TEST(SetLayers, LieBackToBackBetweenSets) {
  const HexMesh grid = gridMesh(4);
  std::vector<Index> sets(64, kNone);
  for (std::size_t c = 0; c < 16; ++c) sets[c] = c % 4 < 2 ? 1 : 2;
  const mesh::SetLayers layers = layersAround(grid, sets);
  EXPECT_EQ(layers.mesh.cells.size(), 64U + 16 + 2 * 4);
  EXPECT_EQ(layers.originals.size(), 2U * (15 + 5));
  expectBall(layers.mesh, 96 + 2 * (8 + 6));
}

TEST(SetLayers, OfNoCellsAreNone) {
  const HexMesh grid = gridMesh(2);
  const mesh::SetLayers layers = layersAround(grid, std::vector<Index>(8, kNone));
  EXPECT_EQ(layers.mesh.cells, grid.cells);
  EXPECT_TRUE(layers.originals.empty());
}

}  // namespace hexhex::test
