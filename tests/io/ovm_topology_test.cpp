// Edges, faces and half-faces of cells, found by all threads at the same vertices at once.
#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/samples.hpp>

#include <base/parallel.hpp>
#include <io/formats/ovm_mesh.hpp>
#include <io/io_test_support.hpp>

namespace hexhex::test {

using namespace io;
namespace {

template <class Cells>
OvmTopology topologyOf(std::size_t vertices, const Cells& cells, int threads) {
  Context context(threads);
  Stage stage(context, "test");
  OvmTopology topology;
  withThreads(threads, [&] { topology = buildOvmTopology(vertices, cells, stage); });
  return topology;
}

/// The error with which it fails.
template <class Cells>
std::optional<ErrorCode> faultOf(std::size_t vertices, const Cells& cells) {
  try {
    (void)topologyOf(vertices, cells, 2);
  } catch (const Error& error) {
    return error.code();
  }
  return std::nullopt;
}

template <std::size_t n>
std::array<Index, n> fromSmallest(std::array<Index, n> loop) {
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  return loop;
}

/// Every element once, and every half-face the loop of the side that it is, from its first corner
/// on if it has an even number; a face is listed as a side in the first slot, if it is one.
template <std::size_t n, class Cells, class Table>
void expectTopologyOf(const OvmTopology& topology, const Cells& cells, const Table& table) {
  ASSERT_EQ(topology.cells.length, table.size());
  ASSERT_EQ(topology.cells.size(), cells.size());
  std::set<std::array<Index, n>> faces;
  std::set<std::array<Index, 2>> edges;
  std::vector<int> used(2 * topology.faces.size());
  std::vector<std::size_t> slotOf(topology.faces.size());  // of half-face 2f
  for (std::size_t i = 0; i < topology.cells.handles.size(); ++i) {
    const Index halfFace = topology.cells.handles[i];
    if (halfFace % 2 == 0) slotOf[halfFace / 2] = i % table.size();
  }
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (std::size_t s = 0; s < table.size(); ++s) {
      std::array<Index, n> side{};
      for (std::size_t i = 0; i < n; ++i) side[i] = cells[c][table[s][i]];
      const Index halfFace = topology.cells[c][s];
      ++used[halfFace];
      const auto loop = loopOfHalfFace(loopOfFace<n>(topology, halfFace / 2), halfFace);
      EXPECT_EQ(fromSmallest(side), fromSmallest(loop));
      EXPECT_TRUE(halfFace % 2 == 1 || side == loop);
      EXPECT_TRUE(s > 0 || halfFace % 2 == 0 || slotOf[halfFace / 2] == 0);
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
  }
}

TEST(OvmTopology, OfTets) {
  const TetMap map = generateSample(SampleKind::Sphere, {.cells = 2, .refine = 5}).map;
  const OvmTopology topology = topologyOf(map.points.size(), map.tets, 4);
  expectTopologyOf<3>(topology, map.tets, kOvmTetFaces);
  EXPECT_TRUE(std::is_sorted(topology.edges.begin(), topology.edges.end(),
                             [](const auto& a, const auto& b) { return a[0] < b[0]; }));
  expectSame(topology, topologyOf(map.points.size(), map.tets, 1));
}

TEST(OvmTopology, OfTetsAroundAnEdge) {
  for (const Index n : {3U, 200U, 300U}) {
    std::vector<Tet> tets;
    for (Index i = 0; i < n; ++i) tets.push_back({0, 1, 2 + i, 2 + (i + 1) % n});
    const OvmTopology topology = topologyOf(2 + n, tets, 2);
    expectTopologyOf<3>(topology, tets, kOvmTetFaces);
    expectSame(topology, topologyOf(2 + n, tets, 1));
    const auto faultWith = [&](const Tet& further) {
      std::vector<Tet> more = tets;
      more.push_back(further);
      return faultOf(3 + n, more);
    };
    EXPECT_EQ(faultWith({0, 2, 2 + n, 3}), std::nullopt);
    EXPECT_EQ(faultWith({0, 2 + n, 2, 3}), ErrorCode::Orientation);
    EXPECT_EQ(faultWith({0, 1, 2, 2 + n}), ErrorCode::NonManifoldFace);
    EXPECT_EQ(faultWith({2 + n, 0, 2 + n, 3}), ErrorCode::RepeatedVertex);
  }
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
  }
}

TEST(OvmTopology, FaultsOfHexahedra) {
  const HexMesh grid = gridMesh(2, 1, 1);
  const auto faultAfter = [&](const auto& change) {
    HexMesh mesh = grid;
    change(mesh);
    return faultOf(mesh.points.size() + 8, mesh.cells);
  };
  EXPECT_EQ(faultAfter([](HexMesh&) {}), std::nullopt);
  EXPECT_EQ(faultAfter([](HexMesh& mesh) { mesh.cells[0][6] = mesh.cells[0][0]; }),
            ErrorCode::RepeatedVertex);
  EXPECT_EQ(faultAfter([](HexMesh& mesh) { mesh.cells.push_back(mesh.cells[0]); }),
            ErrorCode::Orientation);
  EXPECT_EQ(faultAfter([](HexMesh& mesh) { mesh.cells[1] = inHexOrder(mesh.cells[1], 4); }),
            ErrorCode::Orientation);
  // A third cell at the face of two that number their corners alike.
  EXPECT_EQ(faultAfter([](HexMesh& mesh) {
              const auto next = static_cast<Index>(mesh.points.size());
              const Hex& cell = mesh.cells[1];
              mesh.cells.push_back(
                  {cell[4], cell[7], cell[3], cell[0], next, next + 1, next + 2, next + 3});
            }),
            ErrorCode::NonManifoldFace);
}

TEST(OvmTopology, FacesMayShareThreeVertices) {
  HexMesh mesh = gridMesh(2, 1, 1);
  const auto largest = *std::max_element(mesh.cells[0].begin(), mesh.cells[0].end());
  const auto further = static_cast<Index>(mesh.points.size());
  std::replace(mesh.cells[1].begin(), mesh.cells[1].end(), largest, further);
  expectTopologyOf<4>(topologyOf(mesh.points.size() + 1, mesh.cells, 2), mesh.cells, kOvmHexFaces);
}

TEST(OvmTopology, SeamsBetweenAlignedCells) {
  constexpr Index kSide = 9;
  HexMesh mesh = gridMesh(kSide, kSide, kSide);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    // Slabs, and a block inside that touches no slab's end but with a corner.
    const bool slab = c / (kSide * kSide) >= 6;
    const bool block = c % kSide < 3 && c / kSide % kSide < 3 && c / (kSide * kSide) < 3;
    mesh.cells[c] = inHexOrder(mesh.cells[c], slab ? 1 : (block ? 2 : 0));
  }
  const OvmTopology topology = topologyOf(mesh.points.size(), mesh.cells, 1);
  expectTopologyOf<4>(topology, mesh.cells, kOvmHexFaces);
  expectSame(topology, topologyOf(mesh.points.size(), mesh.cells, 4));
}

/// A grid of n^3 cells whose ends are glued to each other.
Array<Hex> periodicGrid(Index n) {
  const auto vertex = [n](Index x, Index y, Index z) {
    return x % n + n * (y % n) + n * n * (z % n);
  };
  Array<Hex> cells;
  for (Index i = 0; i < n * n * n; ++i) {
    const Index x = i % n;
    const Index y = i / n % n;
    const Index z = i / n / n;
    cells.push_back({vertex(x, y, z), vertex(x + 1, y, z), vertex(x + 1, y + 1, z),
                     vertex(x, y + 1, z), vertex(x, y, z + 1), vertex(x + 1, y, z + 1),
                     vertex(x + 1, y + 1, z + 1), vertex(x, y + 1, z + 1)});
  }
  return cells;
}

TEST(OvmTopology, WithoutAnySeam) {
  for (const Index n : {3U, 4U}) {
    const Array<Hex> cells = periodicGrid(n);
    const OvmTopology topology = topologyOf(cells.size(), cells, 2);
    EXPECT_EQ(topology.edges.size(), 3 * cells.size());
    EXPECT_EQ(topology.faces.size(), 3 * cells.size());
    expectTopologyOf<4>(topology, cells, kOvmHexFaces);
  }
  // Two edges between the same vertices, and four cells at a face.
  EXPECT_EQ(faultOf(8, periodicGrid(2)), ErrorCode::NonManifoldFace);
}

TEST(OvmTopology, EdgesWithTheSameVerticesAreOne) {
  // A ring of two cells: their faces outside have the same vertices, too.
  const Array<Hex> cells = {{0, 1, 3, 2, 4, 5, 7, 6}, {1, 0, 2, 3, 5, 4, 6, 7}};
  const OvmTopology topology = topologyOf(8, cells, 2);
  EXPECT_EQ(topology.edges.size(), 12U);
  EXPECT_EQ(topology.faces.size(), 6U);
  expectTopologyOf<4>(topology, cells, kOvmHexFaces);
}

}  // namespace
}  // namespace hexhex::test
