// Sheets, chords, blocks and singular curves of meshes whose structure is known.
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>
#include <gtest/gtest.h>

#include <hexhex/base_complex.hpp>
#include <hexhex/error.hpp>

#include <mesh/grid_meshes.hpp>

#include "support/error_of.hpp"

namespace hexhex {
namespace {

using testing::gridMesh;

BaseComplex complexOf(const HexMesh& mesh) {
  Context context;
  return findBaseComplex(mesh, context);
}

/// Blocks by their corners, four cells along each edge; what is in one place is one vertex.
HexMesh blockMesh(const std::vector<std::array<Vec3, 8>>& blocks) {
  constexpr Index kCells = 4;
  HexMesh mesh;
  std::map<std::array<std::int64_t, 3>, Index> known;
  const auto vertex = [&](const std::array<Vec3, 8>& corners, Index i, Index j, Index k) {
    const std::array<std::array<Index, 2>, 3> weights = {
        {{kCells - i, i}, {kCells - j, j}, {kCells - k, k}}};
    std::array<std::int64_t, 3> place{};  // in 64ths: corners are integers
    for (std::size_t c = 0; c < 8; ++c) {
      const bool isFar = c % 4 == 1 || c % 4 == 2;
      const Index weight = weights[0][isFar] * weights[1][c % 4 / 2] * weights[2][c / 4];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] += std::int64_t{weight} * static_cast<std::int64_t>(corners[c][axis]);
      }
    }
    const auto [found, isNew] = known.emplace(place, static_cast<Index>(known.size()));
    if (isNew) {
      mesh.points.push_back({static_cast<double>(place[0]), static_cast<double>(place[1]),
                             static_cast<double>(place[2])});
    }
    return found->second;
  };
  for (const auto& b : blocks) {
    for (Index n = 0; n < kCells * kCells * kCells; ++n) {
      const Index i = n % kCells;
      const Index j = n / kCells % kCells;
      const Index k = n / kCells / kCells;
      mesh.cells.push_back({vertex(b, i, j, k), vertex(b, i + 1, j, k), vertex(b, i + 1, j + 1, k),
                            vertex(b, i, j + 1, k), vertex(b, i, j, k + 1),
                            vertex(b, i + 1, j, k + 1), vertex(b, i + 1, j + 1, k + 1),
                            vertex(b, i, j + 1, k + 1)});
    }
  }
  return mesh;
}

/// A cube in shells around the given axes: all three make a ball, two of them a cylinder.
HexMesh shellMesh(std::size_t axes) {
  constexpr std::array<Vec3, 8> kCube = {{{-1, -1, -1},
                                          {1, -1, -1},
                                          {1, 1, -1},
                                          {-1, 1, -1},
                                          {-1, -1, 1},
                                          {1, -1, 1},
                                          {1, 1, 1},
                                          {-1, 1, 1}}};
  std::vector<std::array<Vec3, 8>> blocks = {kCube};
  for (std::size_t face = 0; face < 2 * axes; ++face) {
    std::array<Vec3, 8>& shell = blocks.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) {
      shell[i] = shell[i + 4] = kCube[adjacency::kHexFaces[face][i]];
      for (std::size_t axis = 0; axis < axes; ++axis) shell[i + 4][axis] *= 2;
    }
  }
  return blockMesh(blocks);
}

/// Sizes of all blocks, each ascending.
std::multiset<std::array<std::uint64_t, 3>> sizesOf(const BaseComplex& complex) {
  std::multiset<std::array<std::uint64_t, 3>> sizes;
  for (const MeshBlock& block : complex.blocks) {
    auto size = block.size;
    std::sort(size.begin(), size.end());
    sizes.insert(size);
  }
  return sizes;
}

/// By how many edges and of which valence; closed ones with their length as negative number.
std::multiset<std::pair<std::uint32_t, int>> curvesOf(const BaseComplex& complex, bool boundary) {
  std::multiset<std::pair<std::uint32_t, int>> curves;
  for (const SingularCurve& curve : complex.curves) {
    if (curve.boundary != boundary) continue;
    const int edges = static_cast<int>(curve.vertices.size()) - 1;
    const bool isClosed = curve.vertices.front() == curve.vertices.back();
    curves.emplace(curve.valence, isClosed ? -edges : edges);
  }
  return curves;
}

TEST(BaseComplex, OfACube) {
  const BaseComplex cube = complexOf(gridMesh(3));
  EXPECT_EQ(cube.sheets, 9U);
  EXPECT_EQ(cube.chords, 27U);
  EXPECT_EQ(sizesOf(cube), (std::multiset<std::array<std::uint64_t, 3>>{{3, 3, 3}}));
  EXPECT_EQ(curvesOf(cube, true).count({1, 3}), 12U);
  EXPECT_EQ(cube.curves.size(), 12U);
  ASSERT_EQ(cube.irregular.size(), 2U);  // on edges of the cube, and its corners
  EXPECT_EQ(cube.irregular[0].vertices.size(), 24U);
  EXPECT_EQ(cube.irregular[1].vertices.size(), 8U);
  EXPECT_EQ(cube.irregular[1].boundaryValences, (std::vector<std::uint32_t>{1, 1, 1}));
}

TEST(BaseComplex, WallsGoOnFromANotch) {
  // Without one of its 27 cells, at a corner, a cube is cut in seven by planes of the notch.
  const BaseComplex notch = complexOf(
      gridMesh(3, [](std::size_t x, std::size_t y, std::size_t z) { return x + y + z < 6; }));
  EXPECT_EQ(sizesOf(notch),
            (std::multiset<std::array<std::uint64_t, 3>>{
                {1, 1, 2}, {1, 1, 2}, {1, 1, 2}, {1, 2, 2}, {1, 2, 2}, {1, 2, 2}, {2, 2, 2}}));
  EXPECT_EQ(curvesOf(notch, true).count({3, 1}), 3U);
}

TEST(BaseComplex, OfABall) {
  const BaseComplex ball = complexOf(shellMesh(3));
  EXPECT_EQ(sizesOf(ball).count({4, 4, 4}), 7U);
  EXPECT_EQ(ball.blocks.size(), 7U);
  EXPECT_EQ(ball.sheets, 12U + 4U);        // across the cube, and around it
  EXPECT_EQ(ball.chords, 48U + 4U * 12U);  // likewise
  EXPECT_EQ(curvesOf(ball, false).count({3, 4}), 12U + 8U);
  EXPECT_EQ(ball.curves.size(), 20U);
  ASSERT_EQ(ball.irregular.size(), 3U);
  EXPECT_EQ(ball.irregular[0].innerValences, (std::vector<std::uint32_t>{3, 3}));
  EXPECT_EQ(ball.irregular[0].vertices.size(), 20U * 3U);
  EXPECT_EQ(ball.irregular[1].innerValences, (std::vector<std::uint32_t>{3, 3, 3, 3}));
  EXPECT_EQ(ball.irregular[1].vertices.size(), 8U);
  EXPECT_TRUE(ball.irregular[2].boundary);
  EXPECT_EQ(ball.irregular[2].vertices.size(), 8U);
}

TEST(BaseComplex, OfACylinder) {
  const BaseComplex cylinder = complexOf(shellMesh(2));  // an o-grid
  EXPECT_EQ(cylinder.blocks.size(), 5U);
  EXPECT_EQ(sizesOf(cylinder).count({4, 4, 4}), 5U);
  EXPECT_EQ(curvesOf(cylinder, false).count({3, 4}), 4U);
  // Four edges around each end; blocks meet them in regular vertices.
  EXPECT_EQ(curvesOf(cylinder, true),
            (std::multiset<std::pair<std::uint32_t, int>>{{1, -16}, {1, -16}}));
}

/// Five times n x n cells in a ring, turned by a quarter where it closes, or not.
HexMesh ringMesh(Index n, bool isTwisted) {
  constexpr Index kAround = 5;
  HexMesh mesh;
  mesh.points.resize(std::size_t{kAround} * (n + 1) * (n + 1));
  const auto vertex = [&](Index i, Index y, Index z) {
    if (i == kAround && isTwisted) std::tie(y, z) = std::pair(n - z, y);
    return (i % kAround * (n + 1) + y) * (n + 1) + z;
  };
  for (Index i = 0; i < kAround; ++i) {
    for (Index y = 0; y < n; ++y) {
      for (Index z = 0; z < n; ++z) {
        mesh.cells.push_back({vertex(i, y, z), vertex(i + 1, y, z), vertex(i + 1, y + 1, z),
                              vertex(i, y + 1, z), vertex(i, y, z + 1), vertex(i + 1, y, z + 1),
                              vertex(i + 1, y + 1, z + 1), vertex(i, y + 1, z + 1)});
      }
    }
  }
  return mesh;
}

TEST(BaseComplex, OfRings) {
  const BaseComplex ring = complexOf(ringMesh(2, false));
  EXPECT_EQ(sizesOf(ring), (std::multiset<std::array<std::uint64_t, 3>>{{2, 2, 5}}));
  EXPECT_EQ(curvesOf(ring, true),
            (std::multiset<std::pair<std::uint32_t, int>>{{1, -5}, {1, -5}, {1, -5}, {1, -5}}));
  EXPECT_EQ(ring.sheets, 5U + 4U);
  EXPECT_EQ(ring.chords, 4U + 2U * 10U);
  // One edge goes around four times, and so does a row of cells: no box.
  const BaseComplex twisted = complexOf(ringMesh(2, true));
  ASSERT_EQ(twisted.blocks.size(), 1U);
  EXPECT_EQ(twisted.blocks[0].cells, 20U);
  EXPECT_EQ(twisted.blocks[0].size, (std::array<std::uint64_t, 3>{}));
  EXPECT_EQ(curvesOf(twisted, true), (std::multiset<std::pair<std::uint32_t, int>>{{1, -20}}));
  EXPECT_EQ(twisted.sheets, 5U + 1U);
  EXPECT_EQ(twisted.chords, 1U + 2U * 10U);
}

TEST(BaseComplex, DoesNotDependOnNumbers) {
  const HexMesh mesh = shellMesh(3);
  const BaseComplex expected = complexOf(mesh);
  HexMesh other = testing::shuffled(mesh, 7);
  for (std::size_t c = 0; c < other.cells.size(); ++c) {
    const Hex v = other.cells[c];
    if (c % 3 == 1) other.cells[c] = {v[1], v[2], v[3], v[0], v[5], v[6], v[7], v[4]};
    if (c % 3 == 2) other.cells[c] = {v[0], v[3], v[7], v[4], v[1], v[2], v[6], v[5]};
  }
  const BaseComplex found = complexOf(other);
  EXPECT_EQ(found.sheets, expected.sheets);
  EXPECT_EQ(found.chords, expected.chords);
  EXPECT_EQ(sizesOf(found), sizesOf(expected));
  for (const bool boundary : {false, true}) {
    EXPECT_EQ(curvesOf(found, boundary), curvesOf(expected, boundary));
  }
}

TEST(BaseComplex, RefusesCellsThatDoNotFit) {
  const auto codeOf = [](const HexMesh& mesh) {
    return test::codeOf([&] { static_cast<void>(complexOf(mesh)); });
  };
  HexMesh mesh = gridMesh(2);
  mesh.cells[3] = testing::reversed(mesh.cells[3]);
  EXPECT_EQ(codeOf(mesh), ErrorCode::InvalidArgument);
  mesh = gridMesh(2);
  mesh.cells[3][1] = mesh.cells[3][0];
  EXPECT_EQ(codeOf(mesh), ErrorCode::InvalidArgument);
  mesh.cells[3][1] = 1000;
  EXPECT_EQ(codeOf(mesh), ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace hexhex
