// Points in tets, found by the tree and by brute force.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <mesh/grid_meshes.hpp>
#include <mesh/tet_locator.hpp>

namespace hexhex {
namespace {

using testing::identityMap;
using testing::Random;

std::set<Index> tetsAround(const TetLocator& locator, const Vec3& p) {
  std::set<Index> tets;
  EXPECT_FALSE(locator.anyAround(p, [&](Index tet) {
    EXPECT_TRUE(tets.insert(tet).second) << "tet " << tet << " is offered twice";
    return false;
  }));
  return tets;
}

std::set<Index> tetsAroundByForce(const TetMap& map, const Vec3& p) {
  std::set<Index> tets;
  for (std::size_t t = 0; t < map.tets.size(); ++t) {
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      double lower = INFINITY;
      double upper = -INFINITY;
      for (const Index v : map.tets[t]) {
        lower = std::min(lower, map.points[v][k]);
        upper = std::max(upper, map.points[v][k]);
      }
      inside = inside && lower <= p[k] && p[k] <= upper;
    }
    if (inside) tets.insert(static_cast<Index>(t));
  }
  return tets;
}

TEST(TetLocator, FindsWhatBruteForceFinds) {
  Context context;
  Stage stage(context, "test");
  Random random(11);
  for (int round = 0; round < 60; ++round) {
    TetMap map;
    const std::size_t points = 4 + random.below(60);
    // Sizes that differ by many orders of magnitude, some boxes flat.
    for (std::size_t i = 0; i < points; ++i) {
      const double size = std::pow(10.0, -8 * random.real());
      map.points.push_back({size * random.real(), size * random.real(),
                            random.below(4) == 0 ? 0 : size * random.real()});
    }
    for (std::size_t i = random.below(300); i > 0; --i) {
      Tet tet;
      for (Index& v : tet) v = static_cast<Index>(random.below(points));
      map.tets.push_back(tet);
    }
    const TetLocator locator(map, {}, stage);
    for (int i = 0; i < 50; ++i) {
      const double size = std::pow(10.0, -8 * random.real());
      const Vec3 p = random.below(3) == 0
                         ? map.points[random.below(points)]
                         : Vec3{size * random.real(), size * random.real(), size * random.real()};
      EXPECT_EQ(tetsAround(locator, p), tetsAroundByForce(map, p));
    }
  }
}

TEST(TetLocator, EnlargesBoxesByTheMargin) {
  Context context;
  Stage stage(context, "test");
  TetMap map;
  map.points = {{10, 0, 0}, {14, 0, 0}, {10, 1, 0}, {10, 0, 1}};
  map.tets = {{0, 1, 2, 3}};
  const TetLocator bySize(map, {0.25, 0}, stage);
  EXPECT_EQ(tetsAround(bySize, {9.1, 0, 0}).size(), 1U);  // 0.25 * 4 = 1
  EXPECT_EQ(tetsAround(bySize, {8.9, 0, 0}).size(), 0U);
  const TetLocator byCoordinate(map, {0, 0.5}, stage);
  EXPECT_EQ(tetsAround(byCoordinate, {3.1, 0, 0}).size(), 1U);  // 0.5 * 14 = 7
  EXPECT_EQ(tetsAround(byCoordinate, {2.9, 0, 0}).size(), 0U);
}

TEST(TetLocator, StopsWhenAccepted) {
  Context context;
  Stage stage(context, "test");
  const TetMap map = identityMap(3);
  const TetLocator locator(map, {}, stage);
  int calls = 0;
  EXPECT_TRUE(locator.anyAround({1, 1, 1}, [&](Index) { return ++calls == 5; }));
  EXPECT_EQ(calls, 5);
}

TEST(TetLocator, NoTetsAndNoNumbers) {
  Context context;
  Stage stage(context, "test");
  const TetMap none;
  EXPECT_TRUE(tetsAround(TetLocator(none, {}, stage), {0, 0, 0}).empty());
  const TetMap map = identityMap(2);
  EXPECT_TRUE(tetsAround(TetLocator(map, {}, stage), {NAN, 1, 1}).empty());
}

}  // namespace
}  // namespace hexhex
