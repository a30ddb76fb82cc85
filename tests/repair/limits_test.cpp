// Repair and partial extraction of what is very large, small, or far away.
#include <cmath>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include <mesh/grid_meshes.hpp>

#include "extract/support.hpp"
#include "repair/same_connectivity.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

namespace {

TetMap damagedSphere(DefectKind kind, std::uint64_t seed) {
  SampleOptions options;
  options.charts = ChartStyle::Random;
  options.defects = 2;
  options.defectKind = kind;
  options.seed = seed;
  return generateSample(SampleKind::Sphere, options).map;
}

class RepairLimits : public ::testing::TestWithParam<DefectKind> {
 protected:
  void SetUp() override {
    if (!canRepair()) GTEST_SKIP() << "skipped: built without Eigen";
  }
};

/// Shapes in space are what repaired tets aim at; their size says nothing.
TEST_P(RepairLimits, ObjectsOfAnySize) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const TetMap damaged = damagedSphere(GetParam(), seed);
    const HexMesh wanted = extract(repair(damaged));
    for (const double size : {1e90, 1e-80, 1e-105, 1e-150, 1e-316}) {
      SCOPED_TRACE(size);
      TetMap map = damaged;
      for (Vec3& p : map.points) {
        for (double& x : p) x *= size;
      }
      EXPECT_TRUE(sameConnectivity(verifiedExtraction(repair(map)), wanted));
    }
  }
}

/// Maps of 2^n times as many cells along each axis, whose transitions contradict each other by as
/// much. Tets longer than 2^18 cells are too long for the solver, and refused.
TEST_P(RepairLimits, TetsOfAnyLength) {
  for (std::uint64_t seed = 1; seed <= 1; ++seed) {
    for (const int bits : {10, 16, 24}) {
      SCOPED_TRACE(bits);
      TetMap map = damagedSphere(GetParam(), seed);
      for (TetParameters& corners : map.parameters) {
        for (Vec3& u : corners) {
          for (double& x : u) x = std::ldexp(x, bits);
        }
      }
      try {
        EXPECT_TRUE(check(repair(map)).valid());
      } catch (const Error& error) {
        EXPECT_GT(bits, 16) << error.what();
        EXPECT_TRUE(error.code() == ErrorCode::FlippedTet || error.code() == ErrorCode::TooLarge)
            << error.what();
      }
    }
  }
}

/// What is moved needs fractions, which coordinates far away do not have: refused, or repaired.
TEST_P(RepairLimits, ChartsFarAway) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    for (const int bits : {20, 30, 32, 34, 36, 40, 45, 50}) {
      SCOPED_TRACE(bits);
      TetMap map = damagedSphere(GetParam(), seed);
      for (TetParameters& corners : map.parameters) {
        for (Vec3& u : corners) {
          for (double& x : u) x = std::nearbyint(x * 4) / 4 + std::ldexp(1.0, bits);
        }
      }
      try {
        EXPECT_TRUE(check(repair(map)).valid());
      } catch (const Error& error) {
        EXPECT_GT(bits, 36) << error.what();
        EXPECT_EQ(error.code(), ErrorCode::FlippedTet) << error.what();
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, RepairLimits,
                         ::testing::Values(DefectKind::Interior, DefectKind::Boundary,
                                           DefectKind::Singular, DefectKind::Sliver));

/// Cells are in memory, with names for their corners: as many as there are indices for.
TEST(PartialLimits, CellsThatCannotBeNumbered) {
  for (const double size : {1626.0, 1e4, 0x1p19}) {
    TetMap map = testing::identityMap(1);
    for (TetParameters& corners : map.parameters) {
      for (Vec3& u : corners) {
        for (double& x : u) x *= size;
      }
    }
    Context context;
    EXPECT_EQ(codeOf([&] { static_cast<void>(extractPartial(map, {}, context)); }),
              ErrorCode::TooLarge);
  }
}

}  // namespace

}  // namespace hexhex::test
