// A layer under the boundary changes nothing but what is beneath it.
#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include <adjacency/hex_topology.hpp>
#include <gtest/gtest.h>

#include <hexhex/quality.hpp>
#include <hexhex/structure.hpp>

#include <mesh/pillow.hpp>

#include "mesh/grid_meshes.hpp"

namespace hexhex::test {
namespace {

using hexhex::testing::CellFilter;
using hexhex::testing::gridMesh;

mesh::Pillow pillowOf(const HexMesh& grid, const std::vector<Quad>& walls = {}) {
  Context context(2);
  Stage stage(context, "test");
  return mesh::addPillow(grid, walls, stage);
}

MeshStructure structureOf(const HexMesh& mesh) {
  Context context(2);
  return findStructure(mesh, context);
}

Quad sorted(Quad quad) {
  std::sort(quad.begin(), quad.end());
  return quad;
}

std::set<Quad> boundaryOf(const HexMesh& mesh) {
  Context context(1);
  Stage stage(context, "test");
  std::set<Quad> quads;
  for (const Quad& quad : adjacency::quadsAt(mesh, adjacency::boundaryPlaces(mesh, stage))) {
    quads.insert(sorted(quad));
  }
  return quads;
}

/// The cells that have a face, by its vertices.
std::vector<std::size_t> cellsOf(const HexMesh& mesh, const Quad& quad) {
  std::vector<std::size_t> cells;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    for (std::size_t face = 0; face < 6; ++face) {
      if (sorted(adjacency::faceVertices(mesh.cells[c], face)) == sorted(quad)) cells.push_back(c);
    }
  }
  return cells;
}

/// The quads of a grid across an axis.
std::vector<Quad> wallAcross(const HexMesh& grid, std::size_t axis, double at) {
  std::set<Quad> seen;
  std::vector<Quad> walls;
  for (const Hex& cell : grid.cells) {
    for (std::size_t face = 0; face < 6; ++face) {
      const Quad quad = adjacency::faceVertices(cell, face);
      const bool isAcross = std::all_of(quad.begin(), quad.end(),
                                        [&](Index v) { return grid.points[v][axis] == at; });
      if (isAcross && seen.insert(sorted(quad)).second) walls.push_back(quad);
    }
  }
  return walls;
}

}  // namespace

TEST(Pillow, KeepsTheTopologyOfSolidsOfAllKinds) {
  const std::vector<CellFilter> solids = {
      {},                                                                          // a cube
      [](auto x, auto y, auto) { return x != 1 || y != 1; },                       // a ring
      [](auto x, auto y, auto z) { return x != 1 || y != 1 || z != 1; },           // a void
      [](auto x, auto y, auto z) { return (x != 1) + (y != 1) + (z != 1) < 3; },   // no corners
      [](auto x, auto y, auto z) { return (x == 0) + (y == 0) + (z == 0) >= 2; },  // three bars
      [](auto, auto, auto z) { return z == 0; },                                   // a plate
      [](auto x, auto, auto) { return x != 1; }};                                  // two parts
  for (std::size_t s = 0; s < solids.size(); ++s) {
    SCOPED_TRACE(s);
    const HexMesh grid = gridMesh(3, solids[s]);
    const MeshStructure before = structureOf(grid);
    const mesh::Pillow pillow = pillowOf(grid);
    ASSERT_FALSE(pillow.obstacle);
    const MeshStructure after = structureOf(pillow.mesh);
    EXPECT_EQ(pillow.mesh.cells.size(), grid.cells.size() + before.boundaryQuads);
    EXPECT_EQ(boundaryOf(pillow.mesh), boundaryOf(grid));
    EXPECT_EQ(after.eulerCharacteristic, before.eulerCharacteristic);
    EXPECT_EQ(after.components, before.components);
    EXPECT_EQ(after.boundaryComponents, before.boundaryComponents);
    // A quad of a layer lies along each edge of the boundary, so it has two cells.
    EXPECT_TRUE(std::none_of(after.singularEdges.begin(), after.singularEdges.end(),
                             [](const SingularHexEdge& edge) { return edge.boundary; }));
    Context context(2);
    EXPECT_FALSE(findCellFaults(pillow.mesh, context).any());
    EXPECT_TRUE(certify(pillow.mesh, context).allPositive());
    EXPECT_TRUE(std::equal(grid.points.begin(), grid.points.end(), pillow.mesh.points.begin()));
  }
}

TEST(Pillow, TakesTagsAndRegionsInsideToTheBoundary) {
  HexMesh grid = gridMesh(4);
  const std::vector<Quad> walls = wallAcross(grid, 0, 2);
  for (const Quad& wall : walls) grid.features.quads.push_back({wall, 7});
  const std::vector<Quad> bottom = wallAcross(grid, 2, 0);
  for (const Quad& quad : bottom) grid.features.quads.push_back({quad, 8});
  for (const Hex& cell : grid.cells) grid.regions.push_back(grid.points[cell[0]][0] < 2 ? 1 : 2);
  // A curve in the wall, from boundary to boundary, and one on the boundary.
  const auto numberOf = [&](const Vec3& at) {
    return static_cast<Index>(std::find(grid.points.begin(), grid.points.end(), at) -
                              grid.points.begin());
  };
  for (double x = 0; x < 4; ++x) {
    grid.features.edges.push_back({{numberOf({2, 2, x}), numberOf({2, 2, x + 1})}, 3});
    grid.features.edges.push_back({{numberOf({x, 0, 0}), numberOf({x + 1, 0, 0})}, 4});
  }
  const mesh::Pillow pillow = pillowOf(grid, walls);
  ASSERT_FALSE(pillow.obstacle);
  const HexMesh& made = pillow.mesh;
  EXPECT_EQ(pillow.walls.size(), 16U + 16U);
  std::array<std::size_t, 9> quads{};
  for (const FeatureQuad& quad : made.features.quads) {
    ++quads[static_cast<std::size_t>(quad.tag)];
    const std::vector<std::size_t> cells = cellsOf(made, quad.vertices);
    ASSERT_EQ(cells.size(), quad.tag == 7 ? 2U : 1U);
    if (quad.tag == 7) {
      EXPECT_EQ(made.regions[cells[0]] + made.regions[cells[1]], 3);
    }
    for (const Index v : quad.vertices) {
      EXPECT_EQ(made.points[v][quad.tag == 7 ? 0 : 2], quad.tag == 7 ? 2 : 0);
    }
  }
  EXPECT_EQ(quads[7], 32U);
  EXPECT_EQ(quads[8], 16U);
  std::array<std::size_t, 5> edges{};
  for (const FeatureEdge& edge : made.features.edges) {
    ++edges[static_cast<std::size_t>(edge.tag)];
    for (const Index v : edge.vertices) EXPECT_EQ(made.points[v][1], edge.tag == 3 ? 2 : 0);
  }
  EXPECT_EQ(edges[3], 4U + 2U);
  EXPECT_EQ(edges[4], 4U);
  // New vertices in the wall follow others there, those at the ends of the curve the curve's.
  for (std::size_t i = 0; i < pillow.leaders.size(); ++i) {
    const Vec3& at = made.points[grid.points.size() + i];
    const Index leader = pillow.leaders[i];
    EXPECT_EQ(leader != kNone, at[0] == 2);
    if (leader != kNone && at[1] == 2) {
      EXPECT_EQ(grid.points[leader][1], 2);
    }
  }
}

TEST(Pillow, SaysWhereItCannotBe) {
  const auto codeOf = [](const HexMesh& grid, const std::vector<Quad>& walls = {}) {
    const mesh::Pillow pillow = pillowOf(grid, walls);
    return pillow.obstacle ? pillow.obstacle->code() : ErrorCode::Internal;
  };
  // Two cubes that share an edge only.
  EXPECT_EQ(codeOf(gridMesh(2, [](auto x, auto y, auto z) { return z == 0 && x == y; })),
            ErrorCode::NonManifoldEdge);
  // A wall that is one cell wide.
  const HexMesh plate = gridMesh(2, [](auto, auto, auto z) { return z == 0; });
  EXPECT_EQ(codeOf(plate, wallAcross(plate, 0, 1)), ErrorCode::InvalidArgument);
  // Two walls that meet the boundary in one edge, where it has three cells.
  const HexMesh notch = gridMesh(4, [](auto x, auto y, auto) { return x < 2 || y < 2; });
  std::vector<Quad> walls = wallAcross(notch, 0, 2);
  std::erase_if(walls, [&](const Quad& quad) { return cellsOf(notch, quad).size() < 2; });
  EXPECT_EQ(codeOf(notch, walls), ErrorCode::Internal);  // one of them is no obstacle
  for (const Quad& quad : wallAcross(notch, 1, 2)) {
    if (cellsOf(notch, quad).size() == 2) walls.push_back(quad);
  }
  EXPECT_EQ(codeOf(notch, walls), ErrorCode::InvalidArgument);
  // A curve that is one cell long.
  HexMesh pierced = plate;
  const auto low = std::find(plate.points.begin(), plate.points.end(), Vec3{1, 1, 0});
  const auto high = std::find(plate.points.begin(), plate.points.end(), Vec3{1, 1, 1});
  pierced.features.edges = {{{static_cast<Index>(low - plate.points.begin()),
                              static_cast<Index>(high - plate.points.begin())},
                             1}};
  EXPECT_EQ(codeOf(pierced), ErrorCode::InvalidArgument);
}

}  // namespace hexhex::test
