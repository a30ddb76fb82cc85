// The 24 rotations: a group, acting alike on directions and vectors; AlgoHex's numbering.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <lattice/rotation.hpp>

namespace hexhex::lattice {
namespace {

using Vector = std::array<int, 3>;
using Matrix = std::array<std::array<double, 3>, 3>;  // rows

template <class Function>
void forAllRotations(const Function& function) {
  for (int i = 0; i < Rotation::kCount; ++i) function(Rotation(i));
}

Vector vectorOf(Direction d) {
  Vector v{};
  v[static_cast<std::size_t>(axisOf(d))] = signOf(d);
  return v;
}

int determinant(const Vector& a, const Vector& b, const Vector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

TEST(Direction, CrossIsTheCrossProductOfVectors) {
  for (Direction a = 0; a < kDirections; ++a) {
    EXPECT_EQ(direction(axisOf(a), signOf(a)), a);
    EXPECT_EQ(vectorOf(opposite(a))[static_cast<std::size_t>(axisOf(a))], -signOf(a));
    for (Direction b = 0; b < kDirections; ++b) {
      if (axisOf(a) == axisOf(b)) continue;
      EXPECT_EQ(determinant(vectorOf(a), vectorOf(b), vectorOf(cross(a, b))), 1);
    }
  }
}

TEST(Direction, StepMovesByOne) {
  EXPECT_EQ(step({1, 2, 3}, direction(0, 1)), (GridPoint{2, 2, 3}));
  EXPECT_EQ(step({1, 2, 3}, direction(1, -1)), (GridPoint{1, 1, 3}));
  EXPECT_EQ(step({1, 2, 3}, direction(2, -1)), (GridPoint{1, 2, 2}));
}

TEST(Rotation, AllAreDistinctAndPreserveOrientation) {
  std::set<std::array<Direction, 3>> images;
  forAllRotations([&](Rotation r) {
    images.insert({r(Direction{0}), r(Direction{2}), r(Direction{4})});
    EXPECT_EQ(determinant(r(Vector{1, 0, 0}), r(Vector{0, 1, 0}), r(Vector{0, 0, 1})), 1);
  });
  EXPECT_EQ(images.size(), 24U);
}

TEST(Rotation, ActsOnVectorsAsOnDirections) {
  const Vector general = {2, 3, 5};
  forAllRotations([&](Rotation r) {
    Vector sum{};
    for (Direction d = 0; d < kDirections; ++d) {
      EXPECT_EQ(r(vectorOf(d)), vectorOf(r(d)));
      EXPECT_EQ(r(opposite(d)), opposite(r(d)));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Vector image = vectorOf(r(direction(static_cast<int>(axis), 1)));
      for (std::size_t k = 0; k < 3; ++k) sum[k] += general[axis] * image[k];
    }
    EXPECT_EQ(r(general), sum);
  });
}

TEST(Rotation, IdentityIsIndexZero) {
  EXPECT_TRUE(Rotation().isIdentity());
  EXPECT_EQ(Rotation(), Rotation(0));
  for (Direction d = 0; d < kDirections; ++d) EXPECT_EQ(Rotation(0)(d), d);
  forAllRotations([&](Rotation r) {
    EXPECT_EQ(r.isIdentity(), r.index() == 0);
    EXPECT_EQ(r * Rotation(0), r);
    EXPECT_EQ(Rotation(0) * r, r);
  });
}

TEST(Rotation, FromAxesSendsTheAxesThere) {
  for (Direction x = 0; x < kDirections; ++x) {
    for (Direction y = 0; y < kDirections; ++y) {
      if (axisOf(x) == axisOf(y)) continue;
      const Rotation r = Rotation::fromAxes(x, y);
      EXPECT_EQ(r(Direction{0}), x);
      EXPECT_EQ(r(Direction{2}), y);
    }
  }
}

TEST(Rotation, InverseUndoes) {
  forAllRotations([](Rotation r) {
    EXPECT_EQ(r * r.inverse(), Rotation());
    EXPECT_EQ(r.inverse() * r, Rotation());
    EXPECT_EQ(r.inverse().inverse(), r);
  });
}

TEST(Rotation, ProductIsClosedAssociativeAndComposes) {
  forAllRotations([](Rotation a) {
    forAllRotations([a](Rotation b) {
      const Rotation product = a * b;
      EXPECT_GE(product.index(), 0);
      EXPECT_LT(product.index(), Rotation::kCount);
      EXPECT_EQ(product(Vector{2, 3, 5}), a(b(Vector{2, 3, 5})));
      for (Direction d = 0; d < kDirections; ++d) EXPECT_EQ(product(d), a(b(d)));
      forAllRotations([&](Rotation c) { EXPECT_EQ((a * b) * c, a * (b * c)); });
    });
  });
}

const double kRoot = std::sqrt(0.5);
const double kHalf = 0.5;
/// AlgoHex's unit quaternions (w, x, y, z), in its order.
const std::array<std::array<double, 4>, 24> kQuaternions = {{
    {1, 0, 0, 0},
    {0, 1, 0, 0},
    {0, 0, 1, 0},
    {0, 0, 0, 1},
    {kRoot, kRoot, 0, 0},
    {kRoot, -kRoot, 0, 0},
    {kRoot, 0, kRoot, 0},
    {kRoot, 0, -kRoot, 0},
    {kRoot, 0, 0, kRoot},
    {kRoot, 0, 0, -kRoot},
    {0, kRoot, kRoot, 0},
    {0, 0, kRoot, kRoot},
    {0, kRoot, 0, kRoot},
    {0, -kRoot, kRoot, 0},
    {0, 0, -kRoot, kRoot},
    {0, kRoot, 0, -kRoot},
    {kHalf, kHalf, kHalf, kHalf},
    {kHalf, kHalf, kHalf, -kHalf},
    {kHalf, kHalf, -kHalf, kHalf},
    {kHalf, kHalf, -kHalf, -kHalf},
    {kHalf, -kHalf, kHalf, kHalf},
    {kHalf, -kHalf, kHalf, -kHalf},
    {kHalf, -kHalf, -kHalf, kHalf},
    {kHalf, -kHalf, -kHalf, -kHalf},
}};

Matrix matrixOf(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

TEST(RotationFromAlgoHex, IsTheInverseOfTheQuaternionsRotation) {
  std::set<int> indices;
  int involutions = 0;
  for (int i = 0; i < Rotation::kCount; ++i) {
    const Rotation r = rotationFromAlgoHex(i);
    indices.insert(r.index());
    if (r * r == Rotation()) ++involutions;
    const Matrix m = matrixOf(kQuaternions[static_cast<std::size_t>(i)]);
    const std::array<double, 3> u = {2, 3, 5};
    const std::array<double, 3> image = r(u);
    for (std::size_t row = 0; row < 3; ++row) {
      const double back = m[row][0] * image[0] + m[row][1] * image[1] + m[row][2] * image[2];
      EXPECT_NEAR(back, u[row], 1e-14) << "quaternion " << i;
    }
  }
  EXPECT_EQ(indices.size(), 24U);
  EXPECT_EQ(involutions, 10);  // identity, 3 + 6 half turns
}

}  // namespace
}  // namespace hexhex::lattice
