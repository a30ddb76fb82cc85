// What is too bad to be repaired, and what is only nearly so.
#include "repair/diagnosis.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <mesh/grid_meshes.hpp>

#include "igm/igm.hpp"
#include "repair/valid_tets.hpp"
#include "support/error_of.hpp"

namespace hexhex::test {

using namespace repairs;

namespace {

/// Each of its corners may move by the noise, along all axes at once, and towards each other.
TEST(ThinTets, AreNoThickerThanSevenTimesTheNoise) {
  const auto tetOfHeight = [](double height) {
    return TetParameters{Vec3{5, 0, 0}, {9, 0, 0}, {5, 4, 0}, {6, 1, height}};
  };
  for (const double noise : {1e-6, 1e-3, 0.01}) {
    EXPECT_TRUE(isThin(tetOfHeight(6.9 * noise), noise));
    EXPECT_FALSE(isThin(tetOfHeight(7.1 * noise), noise));
    EXPECT_TRUE(isThin(tetOfHeight(-1), noise));
    EXPECT_TRUE(isThin(tetOfHeight(0), noise));
  }
  EXPECT_FALSE(isThin(tetOfHeight(1e-9), 0));
}

/// Far away from the origin, coordinates have few digits left for heights.
TEST(FlatTets, AreBadIfRoundingMayHaveFlippedThem) {
  const auto tetAt = [](double place, double height) {
    return TetParameters{Vec3{place, 0, 0}, {place + 1, 0, 0}, {place, 1, 0}, {place, 0, height}};
  };
  EXPECT_TRUE(isBad(tetAt(0, 0)));
  EXPECT_TRUE(isBad(tetAt(0, -1)));
  EXPECT_FALSE(isBad(tetAt(0, 0x1p-40)));
  EXPECT_TRUE(isBad(tetAt(0x1p20, 0x1p-40)));
  EXPECT_FALSE(isBad(tetAt(0x1p20, 0x1p-20)));
}

/// Of a grid of 6 x 6 x 6 cubes, the tets of some.
std::vector<Index> tetsOfCubes(const testing::CellFilter& isIn) {
  std::vector<Index> tets;
  Index cube = 0;
  for (std::size_t z = 0; z < 6; ++z) {
    for (std::size_t y = 0; y < 6; ++y) {
      for (std::size_t x = 0; x < 6; ++x, ++cube) {
        for (Index t = 0; t < 6 && isIn(x, y, z); ++t) tets.push_back(6 * cube + t);
      }
    }
  }
  return tets;
}

TEST(InvertedRegions, AreManyTetsAroundOneWithoutAnyGoodTetNear) {
  const TetMap map = testing::identityMap(6);
  Context context;
  igm::DefectCollector defects;
  const igm::PreparedMap prepared = igm::prepareMap(map, 1e-2, 1, context, defects);
  ASSERT_TRUE(defects.empty());
  const auto ball = [](std::size_t last) {
    return tetsOfCubes([last](std::size_t x, std::size_t y, std::size_t z) {
      return std::min({x, y, z}) >= 1 && std::max({x, y, z}) <= last;
    });
  };
  const std::vector<Index> large = ball(4);
  EXPECT_EQ(large.size(), 384U);
  EXPECT_EQ(codeOf([&] { refuseInvertedRegions(prepared.topology, large); }),
            ErrorCode::FlippedTet);
  // 200 connected tets around a cube, and one far away: none too many. One more is.
  std::vector<Index> some = ball(3);
  const auto addNeighbour = [&] {
    const auto isIn = [&](Index t) { return std::binary_search(some.begin(), some.end(), t); };
    for (adjacency::HalfFace face = 0; face < prepared.topology.mate.size(); ++face) {
      const adjacency::HalfFace mate = prepared.topology.mate[face];
      if (mate == kNone || !isIn(adjacency::tetOf(face)) || isIn(adjacency::tetOf(mate))) continue;
      some.insert(std::upper_bound(some.begin(), some.end(), adjacency::tetOf(mate)),
                  adjacency::tetOf(mate));
      return;
    }
  };
  while (some.size() < 200) addNeighbour();
  some.push_back(static_cast<Index>(map.tets.size()) - 1);
  EXPECT_NO_THROW(refuseInvertedRegions(prepared.topology, some));
  addNeighbour();
  EXPECT_EQ(codeOf([&] { refuseInvertedRegions(prepared.topology, some); }), ErrorCode::FlippedTet);
  // Few tets, and many in one layer: each of these has good ones at its corners.
  const std::vector<Index> small = ball(3);
  EXPECT_EQ(small.size(), 162U);
  EXPECT_NO_THROW(refuseInvertedRegions(prepared.topology, small));
  const std::vector<Index> layer =
      tetsOfCubes([](std::size_t /*x*/, std::size_t /*y*/, std::size_t z) { return z == 2; });
  EXPECT_EQ(layer.size(), 216U);
  EXPECT_NO_THROW(refuseInvertedRegions(prepared.topology, layer));
  // A small ball and a layer that do not touch are two regions.
  std::vector<Index> both = tetsOfCubes([](std::size_t x, std::size_t y, std::size_t z) {
    return z == 5 || (std::min({x, y, z}) >= 1 && std::max({x, y, z}) <= 3);
  });
  EXPECT_EQ(both.size(), 378U);
  EXPECT_NO_THROW(refuseInvertedRegions(prepared.topology, both));
}

}  // namespace

}  // namespace hexhex::test
