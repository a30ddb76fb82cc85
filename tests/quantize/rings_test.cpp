// Seamless maps in which ways return to where they began, moved along several axes: a wall alone
// would wind for ever.
#include <algorithm>
#include <array>
#include <cstdint>

#include <gtest/gtest.h>

#include <hexhex/hexhex.hpp>

#include "extract/support.hpp"
#include "lattice/random.hpp"

namespace hexhex::test {
namespace {

using testing::LatticeRandom;

/// How many cubes a grid of six tets each has along an axis.
constexpr int kCubes = 3;

/// A grid of parallelepipeds, whose last layer along some axes is glued to the first one.
/// @param steps  edges of a parallelepiped, as parameters
TetMap gluedGrid(const std::array<bool, 3>& isGlued, const std::array<Vec3, 3>& steps) {
  using Place = std::array<int, 3>;
  const auto at = [&](const Place& place) {
    Vec3 u{};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t k = 0; k < 3; ++k) u[k] += place[a] * steps[a][k];
    }
    return u;
  };
  const auto number = [&](Place place) {
    Index index = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (isGlued[a]) place[a] %= kCubes;
      index = index * (kCubes + 1) + static_cast<Index>(place[a]);
    }
    return index;
  };
  TetMap map;
  std::array<int, 3> size{};
  for (size[0] = 0; size[0] <= kCubes; ++size[0]) {
    for (size[1] = 0; size[1] <= kCubes; ++size[1]) {
      for (size[2] = 0; size[2] <= kCubes; ++size[2]) map.points.push_back(at(size));
    }
  }
  for (int cube = 0; cube < kCubes * kCubes * kCubes; ++cube) {
    std::array<std::size_t, 3> axes = {0, 1, 2};
    do {  // in each order of steps from a corner of the cube to the opposite one
      Place place = {cube / (kCubes * kCubes), cube / kCubes % kCubes, cube % kCubes};
      Tet tet{};
      TetParameters u{};
      for (std::size_t i = 0; i < 4; ++i) {
        if (i > 0) ++place[axes[i - 1]];
        tet[i] = number(place);
        u[i] = at(place);
      }
      const bool isEven = (axes[0] + 1) % 3 == axes[1];
      if (!isEven) {
        std::swap(tet[2], tet[3]);
        std::swap(u[2], u[3]);
      }
      map.tets.push_back(tet);
      map.parameters.push_back(u);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  return map;
}

/// The mesh of an object that is a bundle of circles: everything cancels out.
void expectMesh(const TetMap& map, std::uint64_t boundaryComponents) {
  for (const double cells : {60.0, 2000.0}) {
    SCOPED_TRACE(cells);
    const QuantizedMap result = quantize(map, {.cells = cells});
    EXPECT_EQ(verifiedExtraction(result.map).cells.size(), result.report.cells);
    const Expectation expected = check(result.map, {.tolerance = 0}).expected;
    EXPECT_EQ(expected.eulerCharacteristic, 0);
    EXPECT_EQ(expected.boundaryComponents, boundaryComponents);
    EXPECT_NEAR(static_cast<double>(result.report.cells), cells, 0.6 * cells);
  }
}

TEST(Rings, OfATorusAlongItsAxes) {
  expectMesh(gluedGrid({false, true, true}, {{{0.25, 0, 0}, {0, 0.3, 0}, {0, 0, 0.4}}}), 2);
}

TEST(Rings, OfATorusThatIsSheared) {
  expectMesh(gluedGrid({false, true, true}, {{{0.25, 0, 0}, {0, 0.3, 0.07}, {0, 0.05, 0.4}}}), 2);
}

TEST(Rings, OfATorusThatIsShearedByNoise) {
  expectMesh(gluedGrid({false, true, true}, {{{0.25, 0, 0}, {0, 0.3, 1e-10}, {0, 2e-10, 0.4}}}), 2);
}

TEST(Rings, OfASpaceWithoutABoundary) {
  expectMesh(gluedGrid({true, true, true}, {{{0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 0.4}}}), 0);
}

TEST(Rings, OfASolidRing) {
  expectMesh(gluedGrid({false, false, true}, {{{0.25, 0, 0}, {0, 0.3, 0}, {0, 0, 0.4}}}), 1);
}

/// Walls wind around several times before they meet themselves, but for noise; planes that are to
/// be one are multiples of each other's distances.
TEST(Rings, WithNoise) {
  LatticeRandom random(1);
  for (const bool isClosed : {false, true}) {
    for (int round = 0; round < 12; ++round) {
      SCOPED_TRACE(round);
      const auto step = [&] { return 0.1 * static_cast<double>(random.between(1, 4)); };
      const auto shear = [&] { return 0.1 * static_cast<double>(random.between(-1, 1)); };
      TetMap map = gluedGrid({isClosed, true, true},
                             {{{step(), 0, 0}, {0, step(), shear()}, {0, shear(), 5 * step()}}});
      for (TetParameters& tet : map.parameters) {
        for (Vec3& u : tet) {
          for (double& x : u) x += 1e-9 * static_cast<double>(random.between(-1000, 1000)) / 1000;
        }
      }
      const QuantizedMap result = quantize(map, {.cells = 500});
      EXPECT_EQ(verifiedExtraction(result.map).cells.size(), result.report.cells);
      EXPECT_EQ(check(result.map, {.tolerance = 0}).expected.boundaryComponents,
                isClosed ? 0U : 2U);
    }
  }
}

}  // namespace
}  // namespace hexhex::test
