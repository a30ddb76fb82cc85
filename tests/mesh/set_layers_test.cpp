// Layers around sets of cells, which end at the boundary.
#include <array>
#include <map>
#include <set>
#include <vector>

#include <adjacency/cell_faces.hpp>
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

/// Quads of the boundary and edges keep their tags wherever layers end: no tag is that of nothing.
TEST(SetLayers, CarryTags) {
  HexMesh grid = gridMesh(3);
  const auto boundaryOf = [](const HexMesh& mesh) {
    std::map<Quad, Quad> quads;
    std::set<Quad> inner;
    for (const Hex& cell : mesh.cells) {
      for (std::size_t face = 0; face < 6; ++face) {
        const Quad quad = adjacency::faceVertices(cell, face);
        if (!quads.emplace(adjacency::ascending(quad), quad).second) {
          inner.insert(adjacency::ascending(quad));
        }
      }
    }
    for (const Quad& quad : inner) quads.erase(quad);
    return quads;
  };
  const auto edgesOf = [](const HexMesh& mesh) {
    std::set<std::array<Index, 2>> edges;
    for (const Hex& cell : mesh.cells) {
      for (const auto& [a, b] : adjacency::kHexEdges) {
        edges.insert(adjacency::ascending(cell[a], cell[b]));
      }
    }
    return edges;
  };
  for (const auto& [sorted, quad] : boundaryOf(grid)) {
    grid.features.quads.push_back(
        {quad, grid.points[quad[0]][2] + grid.points[quad[2]][2] == 0 ? 5 : 6});
  }
  for (const auto& edge : edgesOf(grid)) grid.features.edges.push_back({edge, 9});
  std::vector<Index> sets(27, kNone);
  sets[4] = 7;
  sets[0] = 8;
  sets[1] = 8;
  const mesh::SetLayers layers = layersAround(grid, sets);
  const HexMesh& mesh = layers.mesh;
  const auto boundary = boundaryOf(mesh);
  std::map<Quad, std::int32_t> tags;
  for (const FeatureQuad& quad : mesh.features.quads) {
    const Quad sorted = adjacency::ascending(quad.vertices);
    EXPECT_TRUE(tags.emplace(sorted, quad.tag).second);
    EXPECT_EQ(boundary.count(sorted), 1U);
  }
  EXPECT_EQ(tags.size(), boundary.size());
  // The plane in which layers end keeps its tag.
  for (const auto& [sorted, tag] : tags) {
    double height = 0;
    for (const Index v : sorted) {
      const std::size_t n = grid.points.size();
      height += grid.points[v < n ? v : layers.originals[v - n]][2];
    }
    EXPECT_EQ(tag, height == 0 ? 5 : 6);
  }
  const auto edges = edgesOf(mesh);
  for (const FeatureEdge& edge : mesh.features.edges) {
    EXPECT_EQ(edges.count(adjacency::ascending(edge.vertices[0], edge.vertices[1])), 1U);
  }
  // All edges of the grid had a tag; none of the layers' own but those at what they were copied
  // from.
  EXPECT_GE(mesh.features.edges.size(), grid.features.edges.size());
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
