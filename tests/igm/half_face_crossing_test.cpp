#include <adjacency/tet_topology.hpp>
#include <gtest/gtest.h>

#include <igm/half_face_crossing.hpp>

namespace hexhex::igm {
namespace {

TEST(HalfFaceCrossing, KeepsItsRotation) {
  for (int r = 0; r < lattice::Rotation::kCount; ++r) {
    for (const bool isExact : {false, true}) {
      const HalfFaceCrossing crossing = HalfFaceCrossing::inner(lattice::Rotation(r), isExact);
      EXPECT_EQ(crossing.isInexact(), !isExact);
      EXPECT_EQ(crossing.isTrivial(), isExact && r == 0);
      EXPECT_FALSE(crossing.isBoundary());
      EXPECT_EQ(crossing.rotation(), lattice::Rotation(r));
      EXPECT_EQ(crossing.plane(), 0U);
    }
  }
}

TEST(HalfFaceCrossing, AtTheBoundaryKeepsItsAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool isConstant : {false, true}) {
      const auto crossing = HalfFaceCrossing::boundary(static_cast<std::size_t>(axis), isConstant);
      EXPECT_TRUE(crossing.isBoundary());
      EXPECT_FALSE(crossing.isTrivial());
      EXPECT_EQ(crossing.isInexact(), !isConstant);
      EXPECT_EQ(crossing.plane(), 1U << axis);
      EXPECT_EQ(crossing.rotation(), lattice::Rotation());
    }
  }
}

TEST(HalfFaceCrossing, IsTrivialByDefault) {
  const HalfFaceCrossing crossing;
  EXPECT_TRUE(crossing.isTrivial());
  EXPECT_FALSE(crossing.isInexact());
  EXPECT_EQ(crossing.rotation(), lattice::Rotation());
}

TEST(HalfFaceCrossing, LeadsToCornersThatAreFoundByTheirVertex) {
  const Tet tet = {7, 3, 0, 9};
  for (Index i = 0; i < 4; ++i) EXPECT_EQ(adjacency::localCorner(tet, tet[i]), i);
}

}  // namespace
}  // namespace hexhex::igm
