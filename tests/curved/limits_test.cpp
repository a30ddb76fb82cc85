// Arcs, patches and nodes of very long tets and of large scales.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <hexhex/curved.hpp>

#include <curved/element_numbers.hpp>
#include <mesh/grid_meshes.hpp>

#include "curved/same_arcs.hpp"
#include "extract/support.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace hexhex::test::limits {

using namespace curved;

namespace {

/// Along which axes a bar lies; for sanitizers, one is as another.
std::size_t axes() { return test::effort() < test::kEffortOfLargeTests ? 1 : 3; }

/// A unit cube in space that is a bar in the map, along some axis.
TetMap bar(double length, std::size_t axis) {
  TetMap map = testing::identityMap(1);
  for (TetParameters& u : map.parameters) {
    for (Vec3& corner : u) corner[axis] *= length;
  }
  return map;
}

TEST(CurvedLimits, ElementsBeyond32Bits) {
  EXPECT_NO_THROW(requireNumbers(kNone - 1));
  for (const std::uint64_t elements : {std::uint64_t{kNone}, std::uint64_t{1} << 40}) {
    EXPECT_EQ(codeOf([&] { requireNumbers(elements); }), ErrorCode::TooLarge);
  }
}

/// The area of a polygon in the coordinates of its hex face.
double areaOf(const Patches& patches, std::uint64_t polygon) {
  const std::uint64_t begin = patches.cornerBegin[polygon];
  const std::uint64_t end = patches.cornerBegin[polygon + 1];
  double area = 0;
  for (std::uint64_t i = begin; i < end; ++i) {
    const auto& [ax, ay] = patches.parameters[i];
    const auto& [bx, by] = patches.parameters[i + 1 < end ? i + 1 : begin];
    area += (ax * by - bx * ay) / 2;
  }
  return area;
}

/// Edges and faces cross tets that are 2^16 times as long as they: places along them are rounded
/// once, not relative to the tet.
TEST(CurvedLimits, TetsOf2To16Cells) {
  constexpr std::uint64_t kLength = 1 << 16;
  for (std::size_t axis = 0; axis < axes(); ++axis) {
    const TetMap map = bar(kLength, axis);
    Context context(2);
    ExtractOptions options;
    const PiecewiseLinearMesh mesh =
        extractPiecewiseLinear(map, PiecewiseLinearParts::ArcsAndPatches, options, context);
    EXPECT_EQ(mesh.mesh.cells.size(), kLength);
    EXPECT_EQ(mesh.arcs.count(), 8 * kLength + 4);
    ASSERT_EQ(mesh.patches.polygonBegin.size(), 5 * kLength + 1 + 1);
    for (std::size_t face = 0; face < 5 * kLength + 1; ++face) {
      double area = 0;
      for (std::uint64_t polygon = mesh.patches.polygonBegin[face];
           polygon < mesh.patches.polygonBegin[face + 1]; ++polygon) {
        area += areaOf(mesh.patches, polygon);
      }
      ASSERT_NEAR(area, 1, 1e-10) << "face " << face;
    }
    // Straight in space, too.
    for (std::size_t arc = 0; arc < mesh.arcs.count(); ++arc) {
      const Vec3& from = mesh.mesh.points[mesh.arcs.ends[arc][0]];
      const Vec3& to = mesh.mesh.points[mesh.arcs.ends[arc][1]];
      for (std::uint64_t i = mesh.arcs.pointBegin[arc]; i < mesh.arcs.pointBegin[arc + 1]; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const double share = mesh.arcs.parameters[i];
          ASSERT_NEAR(mesh.arcs.points[i][k], from[k] + share * (to[k] - from[k]), 1e-15);
        }
      }
    }
    options.engine = Engine::Propeller;
    Context one(1);
    expectSameBits(extractPiecewiseLinear(map, PiecewiseLinearParts::Arcs, options, one).arcs,
                   mesh.arcs);
  }
}

/// Nodes are vertices at a scale that is `order` times as large.
TEST(CurvedLimits, ScaleTimesOrder) {
  const TetMap cube = testing::identityMap(1);
  ExtractOptions options;
  for (const int scale : {1 << 28, 1 << 29, 0x7fffffff}) {
    options.scale = scale;
    Context context(1);
    EXPECT_EQ(codeOf([&] { static_cast<void>(extractLagrange(cube, 9, options, context)); }),
              ErrorCode::TooLarge);
    EXPECT_EQ(codeOf([&] {
                static_cast<void>(extractPiecewiseLinear(cube, PiecewiseLinearParts::ArcsAndPatches,
                                                         options, context));
              }),
              ErrorCode::TooLarge);
  }
}

TEST(CurvedLimits, NodesOfLongTets) {
  constexpr int kLength = 4096;
  for (std::size_t axis = 0; axis < axes(); ++axis) {
    Context context(2);
    const LagrangeMesh mesh = extractLagrange(bar(kLength, axis), 3, {}, context);
    EXPECT_EQ(mesh.cellCount(), std::size_t{kLength});
    EXPECT_EQ(mesh.points.size(), std::size_t{(3 * kLength + 1) * 16});
    for (const double quality : scaledJacobians(mesh, context)) ASSERT_NEAR(quality, 1, 1e-6);
  }
}

}  // namespace

}  // namespace hexhex::test::limits
