// Motions of the grid: a group, acting on points of all kinds and on directions alike.
#include <rapidcheck.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <lattice/gauge.hpp>
#include <lattice/tet_geometry.hpp>

namespace hexhex::lattice {
namespace {

// Far from the ends of int32, so that a few compositions stay in range.
constexpr std::int32_t kFar = 100'000'000;

GridPoint anyGridPoint() {
  const auto coordinate = rc::gen::inRange<std::int32_t>(-kFar, kFar);
  return {*coordinate, *coordinate, *coordinate};
}

Transition anyTransition() {
  return {Rotation(*rc::gen::inRange(0, Rotation::kCount)), anyGridPoint()};
}

Direction anyDirection() { return static_cast<Direction>(*rc::gen::inRange(0, kDirections)); }

TEST(Transition, AppliesTheRotationFirst) {
  // +x to +y, +y to -x: a quarter turn around z.
  const Transition t = {Rotation::fromAxes(2, 1), {10, 20, 30}};
  EXPECT_EQ(t(GridPoint{1, 2, 3}), (GridPoint{8, 21, 33}));
  EXPECT_EQ(t(LatticePoint{1, 2, 3}, std::int64_t{4}), (LatticePoint{38, 81, 123}));
  EXPECT_EQ(t(std::array<double, 3>{0.5, 0.25, 0}, 1.0), (std::array<double, 3>{9.75, 20.5, 30}));
  EXPECT_EQ(t(Direction{0}), 2);
}

TEST(Transition, OnlyTheNeutralElementIsIdentity) {
  EXPECT_TRUE(Transition{}.isIdentity());
  EXPECT_FALSE((Transition{Rotation(), {0, 0, 1}}).isIdentity());
  EXPECT_FALSE((Transition{Rotation(7), {0, 0, 0}}).isIdentity());
}

RC_GTEST_PROP(Transition, ProductComposes, ()) {
  const Transition a = anyTransition();
  const Transition b = anyTransition();
  const GridPoint z = anyGridPoint();
  RC_ASSERT((a * b)(z) == a(b(z)));
  const Direction d = anyDirection();
  RC_ASSERT((a * b)(d) == a(b(d)));
}

RC_GTEST_PROP(Transition, ProductIsAssociative, ()) {
  const Transition a = anyTransition();
  const Transition b = anyTransition();
  const Transition c = anyTransition();
  RC_ASSERT((a * b) * c == a * (b * c));
}

RC_GTEST_PROP(Transition, InverseUndoes, ()) {
  const Transition a = anyTransition();
  RC_ASSERT((a * a.inverse()).isIdentity());
  RC_ASSERT((a.inverse() * a).isIdentity());
  const GridPoint z = anyGridPoint();
  RC_ASSERT(a.inverse()(a(z)) == z);
}

RC_GTEST_PROP(Transition, InverseOfAProductIsTheReversedProduct, ()) {
  const Transition a = anyTransition();
  const Transition b = anyTransition();
  RC_ASSERT((a * b).inverse() == b.inverse() * a.inverse());
}

RC_GTEST_PROP(Transition, MovesGridPointsAsLatticePoints, ()) {
  const Transition a = anyTransition();
  const GridPoint z = anyGridPoint();
  const std::int64_t unit = std::int64_t{1} << *rc::gen::inRange(0, 30);
  const GridPoint image = a(z);
  const LatticePoint scaled = {z[0] * unit, z[1] * unit, z[2] * unit};
  RC_ASSERT(a(scaled, unit) == (LatticePoint{image[0] * unit, image[1] * unit, image[2] * unit}));
}

RC_GTEST_PROP(Transition, CommutesWithSteps, ()) {
  const Transition a = anyTransition();
  const GridPoint z = anyGridPoint();
  const Direction d = anyDirection();
  RC_ASSERT(a(step(z, d)) == step(a(z), a(d)));
}

RC_GTEST_PROP(Transition, IsTakingAPointToItsImage, ()) {
  const Transition a = anyTransition();
  const GridPoint z = anyGridPoint();
  RC_ASSERT(Transition::taking(z, a(z), a.rotation) == a);
}

Gauge anyGauge() {
  Gauge gauge{Rotation(*rc::gen::inRange(0, Rotation::kCount)), {}};
  for (std::uint32_t& t : gauge.translation) t = *rc::gen::arbitrary<std::uint32_t>();
  return gauge;
}

RC_GTEST_PROP(Gauge, QuotientTakesTheOneChartToTheOther, ()) {
  const Gauge a = anyGauge();
  const Gauge b = anyGauge();
  const ChartPoint u = anyGauge().translation;
  RC_ASSERT((a * b.inverse())(b(u)) == a(u));
}

RC_GTEST_PROP(Gauge, FollowsTransitions, ()) {
  const Gauge a = anyGauge();
  const Transition b = anyTransition();
  const GridPoint z = anyGridPoint();
  RC_ASSERT((a * b)(z) == a(b(z)));
}

TEST(Gauge, WrapsAround) {
  const Gauge gauge = {Rotation::fromAxes(1, 2), {0, 5, 7}};  // +x to -x, +z to -z
  EXPECT_EQ(gauge(GridPoint{1, 2, -3}), (ChartPoint{0xFFFFFFFF, 7, 10}));
  EXPECT_EQ(gauge.cell(GridPoint{1, 2, -3}), (ChartPoint{0xFFFFFFFE, 7, 9}));
}

TEST(GridMotion, AppliesToRealNumbers) {
  const GridMotion<double> motion = {Rotation::fromAxes(2, 1), {0.5, 0.25, 4}};
  EXPECT_EQ(motion(std::array{1.0, 2.0, 3.0}), (std::array{-1.5, 1.25, 7.0}));
  EXPECT_TRUE((motion * motion.inverse()).isIdentity());
}

}  // namespace
}  // namespace hexhex::lattice
