// Quantities of large maps that must not overflow.
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

/// The lattice has 2^50 points per unit length here: 64 bits hold 8,191 unit lengths.
TEST(Limits, LengthOfSingularEdgesBeyond64Bits) {
  constexpr std::size_t kCubes = 1000;
  const HexMesh mesh = verifiedExtraction(separateCubes(kCubes));
  EXPECT_EQ(mesh.cells.size(), kCubes);
}

}  // namespace

}  // namespace hexhex::test
