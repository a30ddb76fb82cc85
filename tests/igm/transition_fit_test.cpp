// The rotation between charts, found fast and found by comparing all of them.
#include <array>
#include <cmath>
#include <rapidcheck.h>

#include <gtest/gtest.h>

#include <base/vector3.hpp>
#include <igm/transition_fit.hpp>

namespace hexhex::igm {
namespace {

/// Small multiples of 1/8, so that ties, zeros and parallel vectors are frequent.
Vec3 coarseVector() {
  Vec3 v{};
  for (double& x : v) x = *rc::gen::inRange(-8, 9) * 0.125;
  return v;
}

lattice::Rotation anyRotation() {
  return lattice::Rotation(*rc::gen::inRange(0, lattice::Rotation::kCount));
}

VectorPair rotated(lattice::Rotation rotation, const VectorPair& vectors) {
  return {rotation(vectors[0]), rotation(vectors[1])};
}

TEST(BestRotation, IsTheOneThatWasApplied) {
  const bool passed = rc::check([] {
    const VectorPair vectors = {coarseVector(), coarseVector()};
    const lattice::Rotation rotation = anyRotation();
    const VectorPair images = rotated(rotation, vectors);
    const bool isParallel = cross(vectors[0], vectors[1]) == Vec3{};
    // If vectors are parallel, several rotations fit.
    RC_ASSERT(bestRotation(vectors, images) == bestRotationOfAll(vectors, images));
    if (!isParallel) RC_ASSERT(bestRotation(vectors, images) == rotation);
  });
  EXPECT_TRUE(passed);
}

TEST(BestRotation, IsTheBestOfAll) {
  const bool passed = rc::check([] {
    const VectorPair vectors = {coarseVector(), coarseVector()};
    VectorPair images = rotated(anyRotation(), vectors);
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
    RC_ASSERT(bestRotation(scaled(vectors), scaled(images)) ==
              bestRotationOfAll(scaled(vectors), scaled(images)));
  });
  EXPECT_TRUE(passed);
}

TEST(BestRotation, OfVectorsThatVanishIsTheIdentity) {
  EXPECT_EQ(bestRotation({Vec3{}, Vec3{}}, {Vec3{}, Vec3{}}), lattice::Rotation());
}

}  // namespace
}  // namespace hexhex::igm
