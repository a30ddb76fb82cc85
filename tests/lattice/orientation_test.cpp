// Orientation, normal signs, holder and casing against the oracle, mostly where rounding would
// decide wrongly: (nearly) coplanar points and directions along edges and faces.
#include <utility>

#include <gtest/gtest.h>

#include <lattice/tet_geometry.hpp>

#include "oracle.hpp"
#include "random.hpp"

namespace hexhex::testing {

using namespace lattice;
namespace {

constexpr std::int64_t kFullRange = (std::int64_t{1} << 60) - 1;

int oracleOrientation(const LatticeTet& t) {
  return signum(determinant<Integer256>(widened<Integer256>(t)));
}

void expectOrientation(const LatticeTet& t) {
  const Integer256 expected = determinant<Integer256>(widened<Integer256>(t));
  ASSERT_EQ(orientation(t[0], t[1], t[2], t[3]), signum(expected));
  const Int192 exact = orientationDeterminant(t[0], t[1], t[2], t[3]);
  ASSERT_EQ(exact.sign(), signum(expected));
  const double relative = expected == 0 ? 0 : exact.toDouble() / expected.convert_to<double>() - 1;
  ASSERT_LT(std::abs(relative), 0x1p-51);
  ASSERT_EQ(orientation(t[1], t[0], t[2], t[3]), -signum(expected));
  ASSERT_EQ(orientation(t[1], t[2], t[3], t[0]), -signum(expected));  // an odd permutation of four
  ASSERT_EQ(orientation(t[1], t[2], t[0], t[3]), signum(expected));
}

/// Four points of which the last lies in the plane of the others: a lattice combination of them.
LatticeTet coplanar(LatticeRandom& random, std::int64_t range) {
  LatticeTet t;
  const std::int64_t small = range / 16;  // the combination stays in range
  for (std::size_t i = 0; i < 3; ++i) t[i] = random.point(-small, small);
  const std::int64_t alpha = random.between(-3, 3);
  const std::int64_t beta = random.between(-3, 3);
  for (std::size_t k = 0; k < 3; ++k) {
    t[3][k] = t[0][k] + alpha * (t[1][k] - t[0][k]) + beta * (t[2][k] - t[0][k]);
  }
  std::swap(t[3], t[random.below(4)]);
  return t;
}

TEST(Orientation, IsPositiveForTheStandardTet) {
  const LatticeTet t = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  EXPECT_EQ(orientation(t[0], t[1], t[2], t[3]), 1);
  EXPECT_EQ(orientation(t[0], t[2], t[1], t[3]), -1);
}

TEST(Orientation, HoldsAtTheEndsOfTheRange) {
  constexpr std::int64_t m = kFullRange;
  for (int bits = 0; bits < 4096; ++bits) {
    LatticeTet t;
    for (std::size_t i = 0; i < 12; ++i) t[i / 3][i % 3] = ((bits >> i) & 1) != 0 ? m : -m;
    ASSERT_NO_FATAL_FAILURE(expectOrientation(t));
  }
}

/// Where all coordinates but one have few bits, that one may still decide.
TEST(Orientation, OneCoordinateHasManyBits) {
  LatticeRandom random(12);
  for (int i = cases(30'000); i > 0; --i) {
    LatticeTet t = coplanar(random, std::int64_t{1} << 12);
    for (LatticePoint& p : t) {
      for (std::int64_t& x : p) x <<= 44;
    }
    t[random.below(4)][random.below(3)] += random.between(-2, 2);
    ASSERT_NO_FATAL_FAILURE(expectOrientation(t));
  }
}

TEST(Orientation, RandomFullRange) {
  LatticeRandom random(11);
  for (int i = cases(300'000); i > 0; --i) {
    LatticeTet t;
    const std::int64_t range = kFullRange >> random.below(60);
    for (LatticePoint& p : t) p = random.point(-range, range);
    ASSERT_NO_FATAL_FAILURE(expectOrientation(t));
  }
}

TEST(Orientation, RandomSmall) {
  LatticeRandom random(12);
  int degenerate = 0;
  const int count = cases(200'000);
  for (int i = 0; i < count; ++i) {
    LatticeTet t;
    for (LatticePoint& p : t) p = random.point(-2, 2);
    if (oracleOrientation(t) == 0) ++degenerate;
    ASSERT_NO_FATAL_FAILURE(expectOrientation(t));
  }
  EXPECT_GT(degenerate, count / 50);
}

TEST(Orientation, ExactlyCoplanar) {
  LatticeRandom random(13);
  for (int i = cases(250'000); i > 0; --i) {
    const LatticeTet t = coplanar(random, kFullRange >> random.below(50));
    ASSERT_EQ(oracleOrientation(t), 0);
    ASSERT_NO_FATAL_FAILURE(expectOrientation(t));
  }
}

TEST(Orientation, OneLatticeUnitOffThePlane) {
  LatticeRandom random(14);
  for (int i = cases(300'000); i > 0; --i) {
    LatticeTet t = coplanar(random, kFullRange >> random.below(50));
    t[random.below(4)][random.below(3)] += random.oneIn(2) ? 1 : -1;
    ASSERT_NO_FATAL_FAILURE(expectOrientation(t));
  }
}

/// Floating point is exact of coordinates with few bits, wherever these are, and only of those.
TEST(Orientation, MultiplesOfPowersOfTwo) {
  LatticeRandom random(15);
  for (int i = cases(300'000); i > 0; --i) {
    const int bits = static_cast<int>(random.between(5, 30));
    LatticeTet t = coplanar(random, std::int64_t{1} << bits);
    if (random.oneIn(2)) t[random.below(4)][random.below(3)] += random.oneIn(2) ? 1 : -1;
    const auto shift = random.between(0, 59 - bits);
    for (LatticePoint& p : t) {
      for (std::int64_t& x : p) x *= std::int64_t{1} << shift;
    }
    ASSERT_NO_FATAL_FAILURE(expectOrientation(t));
  }
}

/// A positive tet whose faces and edges often contain coordinate directions.
LatticeTet anyPositiveTet(LatticeRandom& random, std::int64_t largest = kFullRange) {
  for (;;) {
    LatticeTet t;
    const std::int64_t range = random.oneIn(2) ? random.between(1, 3) : largest >> random.below(58);
    for (LatticePoint& p : t) p = random.point(-range, range);
    for (int i = 0; i < 3; ++i) {
      const std::size_t axis = random.below(3);
      if (random.oneIn(2)) t[random.below(4)][axis] = t[random.below(4)][axis];
    }
    const int s = oracleOrientation(t);
    if (s < 0) std::swap(t[0], t[1]);
    if (s != 0) return t;
  }
}

TEST(NormalSigns, AreTheSignsOfTheInwardNormals) {
  LatticeRandom random(21);
  for (int i = cases(50'000); i > 0; --i) {
    const LatticeTet t = anyPositiveTet(random);
    const NormalSigns signs(t);
    for (Direction d = 0; d < kDirections; ++d) {
      const auto slopes = barycentricSlopes<Integer256>(widened<Integer256>(t), d);
      for (int f = 0; f < 4; ++f) {
        ASSERT_EQ(signs.dot(f, d), signum(slopes[static_cast<std::size_t>(f)]));
      }
    }
  }
}

/// A tet and a lattice point in the interior of one of its simplices.
struct TetAround {
  LatticeTet tet;
  LatticePoint point;
};

/// The barycentre of the simplex is a lattice point once all corners are multiplied by the number
/// of its corners.
TetAround anyTetAround(LatticeRandom& random, CornerMask simplex) {
  TetAround result{anyPositiveTet(random, kFullRange / 4), {}};
  const int corners = dimension(simplex) + 1;
  for (std::size_t k = 0; k < 3; ++k) {
    for (int i = 0; i < 4; ++i) {
      std::int64_t& coordinate = result.tet[static_cast<std::size_t>(i)][k];
      if (contains(simplex, i)) result.point[k] += coordinate;
      coordinate *= corners;
    }
  }
  return result;
}

TEST(Casing, AgreesWithThePointAnInfinitesimalStepAway) {
  LatticeRandom random(22);
  int insideFaces = 0;
  for (int i = cases(30'000); i > 0; --i) {
    const auto simplex = static_cast<CornerMask>(random.between(1, 15));
    const TetAround around = anyTetAround(random, simplex);
    ASSERT_EQ(locate(widened<BigInteger>(around.tet), widened<BigInteger>(around.point)), simplex);
    const NormalSigns signs(around.tet);
    const Direction d1 = random.anyDirection();
    const Direction d2 = random.perpendicularTo(d1);
    const CornerMask near = locateNear(around.tet, around.point, d1, d2);
    ASSERT_EQ(holder(signs, simplex, d1), locateNear(around.tet, around.point, d1));
    ASSERT_EQ(casing(signs, simplex, d1, d2), near);
    if (near != kNoSimplex && near != kWholeTet) ++insideFaces;
  }
  EXPECT_GT(insideFaces, cases(30'000) / 100);
}

}  // namespace
}  // namespace hexhex::testing
