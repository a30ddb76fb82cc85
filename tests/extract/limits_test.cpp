// Quantities of large maps that must not overflow.
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <mesh/grid_meshes.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

namespace {

/// Unit cubes that do not touch, all at the origin of parameter space.
TetMap separateCubes(std::size_t count) {
  const TetMap cube = testing::identityMap(1);
  TetMap map;
  for (std::size_t i = 0; i < count; ++i) {
    const auto first = static_cast<Index>(map.points.size());
    for (Vec3 point : cube.points) {
      point[0] += 2 * static_cast<double>(i);
      map.points.push_back(point);
    }
    for (Tet tet : cube.tets) {
      for (Index& v : tet) v += first;
      map.tets.push_back(tet);
    }
    map.parameters.insert(map.parameters.end(), cube.parameters.begin(), cube.parameters.end());
  }
  return map;
}

/// Unit cubes around a common edge, each in a chart of its own with the edge along the third axis.
TetMap cubesAroundEdge(Index valence) {
  const TetMap model = testing::identityMap(1);  // numbers its corners as a cell does
  TetMap map;
  const auto ring = [valence](Index level, Index place) {
    return level + 2 * (1 + place % (2 * valence));
  };
  for (Index v = 0; v <= 2 * valence; ++v) {
    const double angle = v * std::numbers::pi / valence;
    const double radius = v == 0 ? 0 : v % 2 == 1 ? 1 : 1.2;
    for (const double z : {0.0, 1.0}) {
      map.points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
  }
  for (Index i = 0; i < valence; ++i) {
    const std::array<Index, 8> cube = {0, ring(0, 2 * i), ring(0, 2 * i + 1), ring(0, 2 * i + 2),
                                       1, ring(1, 2 * i), ring(1, 2 * i + 1), ring(1, 2 * i + 2)};
    for (const Tet& tet : model.tets) {
      map.tets.push_back({cube[tet[0]], cube[tet[1]], cube[tet[2]], cube[tet[3]]});
    }
    map.parameters.insert(map.parameters.end(), model.parameters.begin(), model.parameters.end());
  }
  return map;
}

TEST(Limits, ValencesOfAThousand) {
  for (const Index valence : {3U, 255U, 500U, 1000U}) {
    for (const int scale : {1, 2}) {
      ExtractOptions options;
      options.scale = scale;
      const HexMesh mesh = verifiedExtraction(cubesAroundEdge(valence), options);
      EXPECT_EQ(mesh.cells.size(), valence * static_cast<std::size_t>(scale * scale * scale));
    }
  }
}

/// The lattice has 2^50 points per unit length here: 64 bits hold 8,191 unit lengths.
TEST(Limits, LengthOfSingularEdgesBeyond64Bits) {
  constexpr std::size_t kCubes = 1000;
  const HexMesh mesh = verifiedExtraction(separateCubes(kCubes));
  EXPECT_EQ(mesh.cells.size(), kCubes);
}

}  // namespace

}  // namespace hexhex::test
