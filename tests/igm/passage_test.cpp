#include <adjacency/tet_topology.hpp>
#include <gtest/gtest.h>

#include <igm/passage.hpp>

namespace hexhex {
namespace {

TEST(Passage, TurnsChartsAsItsRotationDoes) {
  for (int r = 0; r < Rotation::kCount; ++r) {
    for (const bool isExact : {false, true}) {
      const Passage passage = Passage::across(Rotation(r), isExact);
      EXPECT_EQ(passage.isRough(), !isExact);
      EXPECT_EQ(passage.isPlain(), isExact && r == 0);
      for (int here = 0; here < Rotation::kCount; ++here) {
        EXPECT_EQ(passage.after(Rotation(here)), Rotation(r) * Rotation(here));
        EXPECT_EQ(passage.planeBefore(Rotation(here)), 0U);
      }
    }
  }
}

TEST(Passage, AtTheBoundaryTellsThePlaneOfTheFirstChart) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int here = 0; here < Rotation::kCount; ++here) {
      const Rotation rotation(here);
      const int image = axisOf(rotation(direction(axis, 1)));
      const Passage passage = Passage::boundary(static_cast<std::size_t>(image), true);
      EXPECT_FALSE(passage.isPlain());
      EXPECT_FALSE(passage.isRough());
      EXPECT_EQ(passage.planeBefore(rotation), 1U << axis);
      EXPECT_EQ(passage.after(rotation), rotation);
    }
  }
}

TEST(Passage, StaysWhatItIsWhenRoughened) {
  Passage passage = Passage::boundary(2, true);
  passage.roughen();
  passage.roughen();
  EXPECT_TRUE(passage.isRough());
  EXPECT_EQ(passage.planeBefore({}), 4U);
  Passage inner;
  EXPECT_TRUE(inner.isPlain());
  inner.roughen();
  EXPECT_TRUE(inner.isRough());
  EXPECT_EQ(inner.after(Rotation(7)), Rotation(7));
}

TEST(Passage, LeadsToCornersThatAreFoundByTheirVertex) {
  const Tet tet = {7, 3, 0, 9};
  for (Index i = 0; i < 4; ++i) EXPECT_EQ(localCorner(tet, tet[i]), i);
}

}  // namespace
}  // namespace hexhex
