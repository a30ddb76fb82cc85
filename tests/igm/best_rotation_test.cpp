// The rotation between charts, found fast and found by comparing all of them.
#include <array>
#include <cmath>
#include <rapidcheck.h>

#include <gtest/gtest.h>

#include <base/vector3.hpp>
#include <igm/best_rotation.hpp>
#include <igm/turn.hpp>

namespace hexhex {
namespace {

/// Small multiples of 1/8, so that ties, zeros and parallel vectors are frequent.
Vec3 coarseVector() {
  Vec3 v{};
  for (double& x : v) x = *rc::gen::inRange(-8, 9) * 0.125;
  return v;
}

Rotation anyRotation() { return Rotation(*rc::gen::inRange(0, Rotation::kCount)); }

VectorPair turned(Rotation rotation, const VectorPair& vectors) {
  return {turned(rotation, vectors[0]), turned(rotation, vectors[1])};
}

TEST(BestRotation, IsTheOneThatWasApplied) {
  const bool passed = rc::check([] {
    const VectorPair vectors = {coarseVector(), coarseVector()};
    const Rotation rotation = anyRotation();
    const VectorPair images = turned(rotation, vectors);
    const bool isParallel = cross(vectors[0], vectors[1]) == Vec3{};
    // Which of several rotations fits is then as before; otherwise there is only one.
    RC_ASSERT(certainRotation(vectors, images).has_value() == !isParallel);
    RC_ASSERT(bestRotation(vectors, images) == bestRotationOfAll(vectors, images));
    if (!isParallel) RC_ASSERT(bestRotation(vectors, images) == rotation);
  });
  EXPECT_TRUE(passed);
}

TEST(BestRotation, CertaintyIsNotMistaken) {
  const bool passed = rc::check([] {
    const VectorPair vectors = {coarseVector(), coarseVector()};
    VectorPair images = turned(anyRotation(), vectors);
    // From hardly disturbed to anything.
    const double noise = std::ldexp(1.0, *rc::gen::inRange(-60, 2));
    for (Vec3& image : images) image = plus(image, {noise * coarseVector()[0], noise, -noise});
    const double size = std::ldexp(1.0, *rc::gen::inRange(-110, 28));
    const auto scaled = [size](const VectorPair& pair) {
      VectorPair result = pair;
      for (Vec3& v : result) {
        for (double& x : v) x *= size;
      }
      return result;
    };
    const auto certain = certainRotation(scaled(vectors), scaled(images));
    RC_CLASSIFY(certain.has_value());
    if (certain) RC_ASSERT(*certain == bestRotationOfAll(scaled(vectors), scaled(images)));
  });
  EXPECT_TRUE(passed);
}

TEST(BestRotation, NothingIsCertainOfWhatNoRotationDoes) {
  const VectorPair vectors = {Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  EXPECT_FALSE(certainRotation(vectors, {Vec3{3, 0, 0}, Vec3{0, 3, 0}}));
  EXPECT_FALSE(certainRotation(vectors, {Vec3{0.7, 0.7, 0}, Vec3{-0.7, 0.7, 0}}));
  EXPECT_FALSE(certainRotation({Vec3{}, Vec3{}}, {Vec3{}, Vec3{}}));
  EXPECT_EQ(bestRotation({Vec3{}, Vec3{}}, {Vec3{}, Vec3{}}), Rotation());
}

TEST(Turn, IsWhatTheRotationDoes) {
  for (int r = 0; r < Rotation::kCount; ++r) {
    const Rotation rotation(r);
    EXPECT_EQ(turned(rotation, Vec3{1, 2, 3}), rotation(Vec3{1, 2, 3}));
    EXPECT_EQ(turned(rotation, GridPoint{1, 2, 3}), rotation(GridPoint{1, 2, 3}));
    EXPECT_EQ(inverseOf(rotation), rotation.inverse());
  }
}

}  // namespace
}  // namespace hexhex
