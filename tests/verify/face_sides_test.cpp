// Planes in floating point against the exact predicate.
#include <gtest/gtest.h>
#include <verify/lattice_places.hpp>

#include <mesh/grid_meshes.hpp>

namespace hexhex::verification {
namespace {

TEST(FaceSides, AreThoseOfTheExactPredicate) {
  testing::Random random(3);
  std::array<int, 16> found{};
  for (int i = 0; i < 4000; ++i) {
    // Coarse coordinates, so that faces lie along the grid and points in faces, edges and corners;
    // in some tets far from the origin or in large units.
    const std::int64_t unit = std::int64_t{1} << (i % 3 * 15);
    const std::int64_t origin = i % 2 == 0 ? 0 : std::int64_t{1} << 45;
    const auto draw = [&] {
      lattice::LatticePoint point;
      for (std::size_t k = 0; k < 3; ++k) {
        point[k] = origin + unit * static_cast<std::int64_t>(random.below(4));
      }
      return point;
    };
    lattice::LatticeTet tet = {draw(), draw(), draw(), draw()};
    const int sign = lattice::orientation(tet[0], tet[1], tet[2], tet[3]);
    if (sign == 0) continue;
    if (lattice::sideOfFace(tet, 0, tet[0]) < 0) std::swap(tet[0], tet[1]);
    const FaceSides sides(tet, unit);
    for (int p = 0; p < 20; ++p) {
      const lattice::LatticePoint point = draw();
      const lattice::CornerMask simplex = sides.simplexOf(point);
      ASSERT_EQ(simplex, lattice::simplexOf(tet, point)) << "tet " << i;
      if (simplex != lattice::kNoSimplex) ++found[simplex];
    }
  }
  for (std::size_t simplex = 1; simplex < 16; ++simplex) EXPECT_GT(found[simplex], 0) << simplex;
}

}  // namespace
}  // namespace hexhex::verification
