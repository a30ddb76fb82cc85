#include <adjacency/tet_topology.hpp>
#include <gtest/gtest.h>

#include <igm/half_face_transition.hpp>

namespace hexhex::igm {
namespace {

TEST(HalfFaceTransition, KeepsItsRotation) {
  for (int r = 0; r < lattice::Rotation::kCount; ++r) {
    for (const bool isExact : {false, true}) {
      const HalfFaceTransition across = HalfFaceTransition::inner(lattice::Rotation(r), isExact);
      EXPECT_EQ(across.isInexact(), !isExact);
      EXPECT_EQ(across.isTrivial(), isExact && r == 0);
      EXPECT_FALSE(across.isBoundary());
      EXPECT_EQ(across.rotation(), lattice::Rotation(r));
      EXPECT_EQ(across.plane(), 0U);
    }
  }
}

TEST(HalfFaceTransition, AtTheBoundaryKeepsItsAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool isConstant : {false, true}) {
      const auto across = HalfFaceTransition::boundary(static_cast<std::size_t>(axis), isConstant);
      EXPECT_TRUE(across.isBoundary());
      EXPECT_FALSE(across.isTrivial());
      EXPECT_EQ(across.isInexact(), !isConstant);
      EXPECT_EQ(across.plane(), 1U << axis);
      EXPECT_EQ(across.rotation(), lattice::Rotation());
    }
  }
}

TEST(HalfFaceTransition, IsTrivialByDefault) {
  const HalfFaceTransition across;
  EXPECT_TRUE(across.isTrivial());
  EXPECT_FALSE(across.isInexact());
  EXPECT_EQ(across.rotation(), lattice::Rotation());
}

TEST(HalfFaceTransition, LeadsToCornersThatAreFoundByTheirVertex) {
  const Tet tet = {7, 3, 0, 9};
  for (Index i = 0; i < 4; ++i) EXPECT_EQ(adjacency::localCorner(tet, tet[i]), i);
}

}  // namespace
}  // namespace hexhex::igm
