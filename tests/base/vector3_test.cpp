// Angles between normals.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <base/vector3.hpp>

namespace hexhex {

namespace {

/// A unit normal of a prism's side, turned about an axis that no side is parallel to.
Vec3 sideOfPrism(double angle, double tilt) {
  const double x = std::cos(angle);
  const double y = std::sin(angle);
  const Vec3 tilted = {x, y * std::cos(tilt), y * std::sin(tilt)};
  return times(1 / length(tilted), tilted);
}

/// However a regular prism is turned, its sides turn by what they turn, and by no more.
TEST(LeastCosine, DoesNotDependOnRounding) {
  for (const int sides : {3, 4, 5, 6, 8, 9, 12, 36}) {
    const double turn = 2 * std::numbers::pi / sides;
    for (int i = 0; i < 1000; ++i) {
      const double begin = 0.017 * i;
      const double cosine =
          dot(sideOfPrism(begin, 0.003 * i), sideOfPrism(begin + turn, 0.003 * i));
      EXPECT_GE(cosine, leastCosine(turn)) << sides << " sides, " << i;
      EXPECT_LT(cosine, leastCosine(turn - 1e-5)) << sides << " sides, " << i;
    }
  }
}

}  // namespace

}  // namespace hexhex
