// Tets of shapes that no solver should make, and that are extracted nevertheless.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "extract/support.hpp"
#include "igm/map_samples.hpp"

namespace hexhex::test {

namespace {

/// The identity on these tets, whose corners are put in positive order.
TetMap positiveMap(std::vector<Vec3> points, std::vector<Tet> tets) {
  TetMap map = identityMap(std::move(points), std::move(tets));
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    if (determinant(map.parameters[t]) > 0) continue;
    std::swap(map.tets[t][0], map.tets[t][1]);
    std::swap(map.parameters[t][0], map.parameters[t][1]);
  }
  return map;
}

/// Charts of the atlas engine repeat after 2^19 units, so that a longer tet overlaps itself.
TEST(ExtremeTets, LongerThanAChart) {
  constexpr double kLength = (1 << 19) + 100;
  std::vector<Vec3> points;
  for (int corner = 0; corner < 8; ++corner) {
    points.push_back({1.0 * (corner & 1), 1.0 * (corner >> 1 & 1), kLength * (corner >> 2)});
  }
  // Around the diagonal from corner 0 to corner 7.
  const TetMap map = positiveMap(
      points, {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}});
  const HexMesh mesh = verifiedExtraction(map);
  EXPECT_EQ(static_cast<double>(mesh.cells.size()), kLength);
}

/// A cube of two units: an octahedron between the middles of its faces, a tet at each corner and
/// one at each edge. Four of the middles are out of their common plane by `height`, so that a tet
/// of that height in the octahedron has the cube's centre inside.
TetMap cubeAroundSliver(double height) {
  std::vector<Vec3> points;
  for (int corner = 0; corner < 8; ++corner) {
    points.push_back({2.0 * (corner & 1), 2.0 * (corner >> 1 & 1), 2.0 * (corner >> 2)});
  }
  // Per axis and side.
  points.insert(points.end(), {{0, 1, 1 - height},
                               {2, 1, 1 - height},
                               {1, 0, 1 + height},
                               {1, 2, 1 + height},
                               {1, 1, 0},
                               {1, 1, 2}});
  const auto middle = [](std::size_t axis, std::size_t side) {
    return static_cast<Index>(8 + 2 * axis + side);
  };
  std::vector<Tet> tets = {
      {8, 9, 10, 11}, {8, 10, 11, 13}, {9, 10, 11, 13}, {8, 9, 10, 12}, {8, 9, 11, 12}};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    tets.push_back({static_cast<Index>(corner), middle(0, corner & 1), middle(1, corner >> 1 & 1),
                    middle(2, corner >> 2)});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t end = corner | (std::size_t{1} << axis);
      if (end == corner) continue;
      const std::size_t other = (axis + 1) % 3;
      const std::size_t third = (axis + 2) % 3;
      tets.push_back({static_cast<Index>(corner), static_cast<Index>(end),
                      middle(other, corner >> other & 1), middle(third, corner >> third & 1)});
    }
  }
  return positiveMap(std::move(points), std::move(tets));
}

/// The vertex in the middle comes from a tet of this height, flatter than affine forms are exact
/// in.
TEST(ExtremeTets, LatticePointInASliver) {
  for (const double height : {0.25, 0x1p-16, 0x1p-24, 0x1p-32}) {
    SCOPED_TRACE(height);
    for (const int scale : {1, 2, 3}) {
      ExtractOptions options;
      options.scale = scale;
      const HexMesh mesh = verifiedExtraction(cubeAroundSliver(height), options);
      EXPECT_EQ(mesh.cells.size(), static_cast<std::size_t>(8 * scale * scale * scale));
      for (const Vec3& p : mesh.points) {
        for (const double coordinate : p) {
          EXPECT_NEAR(coordinate * scale, std::nearbyint(coordinate * scale), 1e-12);
        }
      }
    }
  }
}

}  // namespace

}  // namespace hexhex::test
