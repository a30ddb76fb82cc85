// Edges, faces and half-faces of cells, found by all threads at the same vertices at once.
#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/samples.hpp>

#include <base/parallel.hpp>
#include <io/io_test_support.hpp>
#include <io/ovm_cells.hpp>
#include <io/ovm_hex_topology.hpp>
#include <io/ovm_topology.hpp>

namespace hexhex::test {
namespace {

template <class Cells>
OvmTopology topologyOf(std::size_t vertices, const Cells& cells, int threads) {
  Context context(threads);
  Stage stage(context, "test");
  OvmTopology topology;
  withThreads(threads, [&] { topology = buildOvmTopology(vertices, cells, stage); });
  return topology;
}

std::optional<OvmTopology> quickTopologyOf(std::size_t vertices, const Array<Hex>& cells,
                                           int threads = 2) {
  Context context(threads);
  Stage stage(context, "test");
  std::optional<OvmTopology> topology;
  withThreads(threads, [&] { topology = buildOvmHexTopology(vertices, cells, stage); });
  return topology;
}

template <std::size_t n>
std::array<Index, n> fromSmallest(std::array<Index, n> loop) {
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  return loop;
}

/// Every element once, and every half-face the loop of the side that it is.
template <std::size_t n, class Cells, class Table>
void expectTopologyOf(const OvmTopology& topology, const Cells& cells, const Table& table) {
  EXPECT_TRUE(std::is_sorted(topology.edges.begin(), topology.edges.end()));
  EXPECT_EQ(std::adjacent_find(topology.edges.begin(), topology.edges.end()), topology.edges.end());
  ASSERT_EQ(topology.cells.length, table.size());
  ASSERT_EQ(topology.cells.size(), cells.size());
  std::set<std::array<Index, n>> faces;
  std::set<std::array<Index, 2>> edges;
  std::vector<int> used(2 * topology.faces.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (std::size_t s = 0; s < table.size(); ++s) {
      std::array<Index, n> side{};
      for (std::size_t i = 0; i < n; ++i) side[i] = cells[c][table[s][i]];
      const Index halfFace = topology.cells[c][s];
      ++used[halfFace];
      EXPECT_EQ(fromSmallest(side),
                fromSmallest(loopOfHalfFace(loopOfFace<n>(topology, halfFace / 2), halfFace)));
      for (std::size_t i = 0; i < n; ++i) {
        edges.insert({std::min(side[i], side[(i + 1) % n]), std::max(side[i], side[(i + 1) % n])});
      }
      std::sort(side.begin(), side.end());
      faces.insert(side);
    }
  }
  EXPECT_EQ(topology.faces.size(), faces.size());
  EXPECT_EQ(topology.edges.size(), edges.size());
  EXPECT_LE(*std::max_element(used.begin(), used.end()), 1);
}

void expectSame(const OvmTopology& a, const OvmTopology& b) {
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.faces.handles, b.faces.handles);
  EXPECT_EQ(a.cells.handles, b.cells.handles);
}

/// A grid whose vertices have other numbers, and whose cells come in another order and turned.
HexMesh shuffledGrid(Index n, Random& random) {
  HexMesh mesh = gridMesh(n, n, n);
  std::vector<Index> numbers(mesh.points.size());
  std::iota(numbers.begin(), numbers.end(), Index{0});
  for (std::size_t i = numbers.size(); i > 1; --i) {
    std::swap(numbers[i - 1], numbers[random.below(i)]);
  }
  for (Hex& cell : mesh.cells) {
    for (Index& corner : cell) corner = numbers[corner];
    cell = inHexOrder(cell, random.below(4));
  }
  for (std::size_t i = mesh.cells.size(); i > 1; --i) {
    std::swap(mesh.cells[i - 1], mesh.cells[random.below(i)]);
  }
  return mesh;
}

TEST(OvmTopology, OfHexahedra) {
  Random random(7);
  for (Index n = 1; n <= 18; n += n < 4 ? 1 : 14) {
    const HexMesh mesh = shuffledGrid(n, random);
    const OvmTopology topology = topologyOf(mesh.points.size(), mesh.cells, 4);
    expectTopologyOf<4>(topology, mesh.cells, kOvmHexFaces);
    expectSame(topology, topologyOf(mesh.points.size(), mesh.cells, 1));
    const std::optional<OvmTopology> quick = quickTopologyOf(mesh.points.size(), mesh.cells);
    ASSERT_TRUE(quick.has_value());
    expectSame(topology, *quick);
  }
}

TEST(OvmTopology, OfTets) {
  const TetMap map = generateSample(SampleKind::Sphere, {.cells = 2, .refine = 5}).map;
  const OvmTopology topology = topologyOf(map.points.size(), map.tets, 4);
  expectTopologyOf<3>(topology, map.tets, kOvmTetFaces);
  expectSame(topology, topologyOf(map.points.size(), map.tets, 1));
}

TEST(OvmTopology, LoopsBeginWhereTheCellBeginsThatHasTheFaceFirst) {
  const HexMesh mesh = gridMesh(4, 3, 5);
  const OvmTopology topology = topologyOf(mesh.points.size(), mesh.cells, 2);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    EXPECT_EQ(topology.from(topology.faces[topology.cells[c][0] / 2][0]), mesh.cells[c][0]);
  }
}

/// n hexahedra around an edge, whose smaller vertex has the number 0.
Array<Hex> fan(Index n) {
  Array<Hex> cells;
  const auto ring = [n](Index i, Index level) { return 2 + 2 * (i % (2 * n)) + level; };
  for (Index i = 0; i < n; ++i) {
    cells.push_back({0, ring(2 * i, 0), ring(2 * i + 1, 0), ring(2 * i + 2, 0), 1, ring(2 * i, 1),
                     ring(2 * i + 1, 1), ring(2 * i + 2, 1)});
  }
  return cells;
}

TEST(OvmTopology, VerticesOfAnyValence) {
  for (const Index n : {3U, 7U, 8U, 30U}) {
    const Array<Hex> cells = fan(n);
    const std::size_t vertices = 2 + 4 * n;
    expectTopologyOf<4>(topologyOf(vertices, cells, 2), cells, kOvmHexFaces);
    // The axis' smaller vertex has n edges to the ring, and one to the other vertex of the axis.
    EXPECT_EQ(quickTopologyOf(vertices, cells).has_value(), n < 8) << n;
  }
}

TEST(OvmTopology, WhatIsNotAsUsualIsLeftToTheOther) {
  const HexMesh grid = gridMesh(2, 1, 1);
  const auto isQuick = [&](const auto& change) {
    HexMesh mesh = grid;
    change(mesh);
    return quickTopologyOf(mesh.points.size() + 8, mesh.cells).has_value();
  };
  EXPECT_TRUE(isQuick([](HexMesh&) {}));
  EXPECT_FALSE(isQuick([](HexMesh& mesh) { mesh.cells[0][6] = mesh.cells[0][0]; }));
  EXPECT_FALSE(isQuick([](HexMesh& mesh) { mesh.cells.push_back(mesh.cells[0]); }));
  EXPECT_FALSE(isQuick([](HexMesh& mesh) { mesh.cells[1] = inHexOrder(mesh.cells[1], 4); }));
  // One side has three vertices of the other cell's.
  EXPECT_FALSE(isQuick([](HexMesh& mesh) {
    for (std::size_t i = 0; i < 8; ++i) {
      const auto& first = mesh.cells[0];
      const bool shared = std::find(first.begin(), first.end(), mesh.cells[1][i]) != first.end();
      if (!shared) continue;
      Index& corner = mesh.cells[1][i];
      const Index largest = *std::max_element(first.begin(), first.end());
      if (corner == largest) corner = static_cast<Index>(mesh.points.size());
    }
  }));
}

}  // namespace
}  // namespace hexhex::test
