// Cells that name a vertex twice, or list their corners the other way round: what is known of them
// because the test made them.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <hexhex/quality.hpp>
#include <hexhex/structure.hpp>

#include <mesh/grid_meshes.hpp>

#include "support/error_of.hpp"

namespace hexhex {
namespace {

using testing::gridMesh;
using testing::Random;
using testing::reversed;
using testing::shuffled;

CellFaults faultsOf(const HexMesh& mesh, int threads = 2) {
  Context context(threads);
  return findCellFaults(mesh, context);
}

std::vector<std::uint64_t> asVector(const Array<std::uint64_t>& cells) {
  return {cells.begin(), cells.end()};
}

using Cells = std::vector<std::uint64_t>;

/// Unit cells around a ring: the last one's far face is the first one's near face, joined corner
/// by corner as `seam` says.
HexMesh ringMesh(Index cells, const std::array<Index, 4>& seam) {
  HexMesh mesh;
  for (Index i = 0; i < cells; ++i) {
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}) {
      mesh.points.push_back({p[0], p[1], static_cast<double>(i)});
    }
    Hex cell{};
    for (Index k = 0; k < 4; ++k) {
      cell[k] = 4 * i + k;
      cell[4 + k] = i + 1 < cells ? 4 * (i + 1) + k : seam[k];
    }
    mesh.cells.push_back(cell);
  }
  return mesh;
}

TEST(CellFaults, SoundMeshesHaveNone) {
  EXPECT_FALSE(faultsOf({}).any());
  EXPECT_FALSE(faultsOf(gridMesh(1)).any());
  EXPECT_FALSE(faultsOf(shuffled(gridMesh(5), 1)).any());
  // Cells that meet in edges only.
  EXPECT_FALSE(faultsOf(gridMesh(2, [](std::size_t x, std::size_t y, std::size_t) {
                 return x == y;
               })).any());
}

TEST(CellFaults, AMirroredCellIsFoundWithItsFaces) {
  HexMesh mesh = gridMesh(3);
  mesh.cells[13] = reversed(mesh.cells[13]);
  const CellFaults faults = faultsOf(mesh);
  EXPECT_EQ(asVector(faults.mirrored), Cells{13});
  EXPECT_EQ(faults.sameDirectionFaces, 6U);
  EXPECT_EQ(faults.notOrientable, kNone);
  EXPECT_TRUE(faults.firstSameDirection.cell == 13 || faults.firstSameDirection.other == 13);
  EXPECT_EQ(faults.firstSameDirection.cells, 2U);
}

TEST(CellFaults, AnySetOfMirroredCellsIsFound) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    HexMesh mesh = shuffled(gridMesh(4), seed);
    Random random(seed);
    Cells turned;
    std::uint64_t faces = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      if (random.below(4) != 0) continue;
      mesh.cells[c] = reversed(mesh.cells[c]);
      turned.push_back(c);
    }
    // Pairs of cells with four common vertices of which one is turned.
    for (std::size_t a = 0; a < mesh.cells.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const auto isIn = [&](Index v) {
          return std::find(mesh.cells[b].begin(), mesh.cells[b].end(), v) != mesh.cells[b].end();
        };
        if (std::count_if(mesh.cells[a].begin(), mesh.cells[a].end(), isIn) != 4) continue;
        faces += std::binary_search(turned.begin(), turned.end(), a) !=
                         std::binary_search(turned.begin(), turned.end(), b)
                     ? 1
                     : 0;
      }
    }
    const CellFaults faults = faultsOf(mesh);
    EXPECT_EQ(asVector(faults.mirrored), turned);
    EXPECT_EQ(faults.sameDirectionFaces, faces);
    EXPECT_EQ(asVector(faultsOf(mesh, 1).mirrored), turned);
  }
}

/// Also where most cells are, and those that touch no others.
TEST(CellFaults, MirroredPartsHaveNegativeVolume) {
  HexMesh mesh = gridMesh(5, [](std::size_t x, std::size_t, std::size_t) { return x != 2; });
  Cells turned;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (mesh.points[mesh.cells[c][0]][0] < 2) continue;
    mesh.cells[c] = reversed(mesh.cells[c]);
    turned.push_back(c);
  }
  const CellFaults part = faultsOf(mesh);
  EXPECT_EQ(asVector(part.mirrored), turned);
  EXPECT_EQ(part.sameDirectionFaces, 0U);
  HexMesh whole = gridMesh(3);
  for (Hex& cell : whole.cells) cell = reversed(cell);
  EXPECT_EQ(faultsOf(whole).mirrored.size(), 27U);
  HexMesh one = gridMesh(1);
  one.cells[0] = reversed(one.cells[0]);
  EXPECT_EQ(asVector(faultsOf(one).mirrored), Cells{0});
}

TEST(CellFaults, RingsAreOrientableUnlessTheyAreGluedMirrored) {
  EXPECT_EQ(faultsOf(ringMesh(5, {0, 1, 2, 3})).notOrientable, kNone);
  EXPECT_EQ(faultsOf(ringMesh(5, {2, 3, 0, 1})).notOrientable, kNone);  // with half a turn
  HexMesh mirrored = ringMesh(5, {0, 1, 2, 3});
  mirrored.cells[2] = reversed(mirrored.cells[2]);
  EXPECT_EQ(faultsOf(mirrored).sameDirectionFaces, 2U);
  EXPECT_EQ(faultsOf(mirrored).notOrientable, kNone);
  const CellFaults moebius = faultsOf(ringMesh(5, {1, 0, 3, 2}));
  EXPECT_EQ(moebius.notOrientable, 0U);
  EXPECT_EQ(moebius.sameDirectionFaces, 1U);
  EXPECT_TRUE(moebius.mirrored.empty());
}

TEST(CellFaults, RepeatedCornersAreCountedAndLeftOutOfTheRest) {
  HexMesh mesh = gridMesh(3);
  mesh.cells[4][1] = mesh.cells[4][0];  // a wedge
  mesh.cells[4][5] = mesh.cells[4][4];
  mesh.cells[20][7] = mesh.cells[20][3];
  const CellFaults faults = faultsOf(mesh);
  EXPECT_EQ(asVector(faults.repeated), (Cells{4, 20}));
  EXPECT_TRUE(faults.mirrored.empty());
  EXPECT_EQ(faults.sameDirectionFaces + faults.overfullFaces, 0U);
}

TEST(CellFaults, FacesOfThreeCellsAreCounted) {
  HexMesh mesh = gridMesh(3);
  mesh.cells.push_back(mesh.cells[0]);
  const CellFaults twice = faultsOf(mesh);  // three of its faces are inside
  EXPECT_EQ(twice.overfullFaces, 3U);
  EXPECT_EQ(twice.sameDirectionFaces, 3U);
  EXPECT_EQ(twice.firstOverfull.cells, 3U);
}

TEST(CellFaults, ReorientMakesAllCellsPositiveAgain) {
  const HexMesh grid = gridMesh(4, [](std::size_t x, std::size_t, std::size_t) { return x != 1; });
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    HexMesh mesh = shuffled(grid, seed);
    const HexMesh before = mesh;
    Random random(seed);
    std::uint64_t turned = 0;
    for (Hex& cell : mesh.cells) {
      if (random.below(3) == 0) continue;
      cell = reversed(cell);
      ++turned;
    }
    Context context(2);
    EXPECT_EQ(reorient(mesh, context), turned);
    EXPECT_EQ(mesh.cells, before.cells);
    EXPECT_TRUE(certify(mesh, context).allPositive());
    EXPECT_EQ(reorient(mesh, context), 0U);
  }
}

TEST(CellFaults, VerticesMustExist) {
  HexMesh mesh = gridMesh(1);
  mesh.cells[0][3] = 8;
  EXPECT_EQ(test::codeOf([&] { static_cast<void>(faultsOf(mesh)); }), ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace hexhex
