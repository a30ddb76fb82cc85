// exitOfTurn and exitOfLine: every answer against the oracle, and walks from tet to tet that must
// reach their target, through edges, vertices and along faces too.
#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

#include "oracle.hpp"
#include "random.hpp"
#include "tet_patch.hpp"

namespace hexhex::testing {

using namespace lattice;
namespace {

template <class Function>
void forAllDirectionPairs(const Function& function) {
  for (Direction d1 = 0; d1 < kDirections; ++d1) {
    for (Direction d2 = 0; d2 < kDirections; ++d2) {
      if (axisOf(d1) != axisOf(d2)) function(d1, d2);
    }
  }
}

CornerMask locateIn(const LatticeTet& tet, const LatticePoint& p) {
  return locate(widened<Integer256>(tet), widened<Integer256>(p));
}

/// Turns from d1 to d2 around the centre of a star, starting in tet `start`.
void turn(const Star& star, int start, Direction d1, Direction d2) {
  int tet = start;
  for (int steps = 0; steps < star.patch.size(); ++steps) {
    const LatticeTet corners = star.patch.corners(tet);
    const CornerMask simplex = locateIn(corners, star.center);
    const int face = exitOfTurn(corners, NormalSigns(corners), simplex, d1, d2);
    if (face == kStaysInside) {
      ASSERT_NE(locateNear(corners, star.center, d2), kNoSimplex) << "stopped before d2";
      return;
    }
    ASSERT_GE(face, 0);
    ASSERT_TRUE(contains(exitsOfTurn(corners, simplex, d1, d2), face)) << "not crossed";
    tet = star.patch.neighbor(tet, face);
    ASSERT_GE(tet, 0) << "left the star";
  }
  FAIL() << "walked in circles";
}

/// All turns of a star from all tets in which they may begin. Returns how many begin in more than
/// one tet, i.e. run inside a face.
int turnEverywhere(const Star& star) {
  int ambiguous = 0;
  forAllDirectionPairs([&](Direction d1, Direction d2) {
    int starts = 0;
    for (int t = 0; t < star.patch.size(); ++t) {
      const LatticeTet corners = star.patch.corners(t);
      const CornerMask simplex = locateIn(corners, star.center);
      if (casing(NormalSigns(corners), simplex, d1, d2) == kNoSimplex) continue;
      ++starts;
      turn(star, t, d1, d2);
      if (::testing::Test::HasFailure()) return;
    }
    EXPECT_GE(starts, 1);
    if (starts > 1) ++ambiguous;
  });
  return ambiguous;
}

TEST(ExitOfTurn, AroundVertices) {
  LatticeRandom random(91);
  for (int i = cases(60); i > 0; --i) {
    const Star star = vertexStar(random, static_cast<int>(random.between(1, 4)),
                                 random.oneIn(2) ? 0 : random.between(1, 5));
    ASSERT_TRUE(star.patch.allPositive());
    turnEverywhere(star);
    ASSERT_FALSE(HasFailure());
  }
}

TEST(ExitOfTurn, AroundVerticesWithDirectionsOnEdgesAndFaces) {
  LatticeRandom random(92);
  int ambiguous = 0;
  for (int i = cases(60); i > 0; --i) {
    ambiguous += turnEverywhere(vertexStar(random, 2, 0));
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(ambiguous, 0);
}

TEST(ExitOfTurn, AroundEdges) {
  LatticeRandom random(93);
  int ambiguous = 0;
  for (int i = cases(600); i > 0; --i) {
    const Star star = edgeStar(random, random.oneIn(2) ? random.between(1, 2) : 1000);
    ASSERT_TRUE(star.patch.allPositive());
    ambiguous += turnEverywhere(star);
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(ambiguous, 0);
}

TEST(ExitOfTurn, AroundFaces) {
  LatticeRandom random(94);
  int ambiguous = 0;
  for (int i = std::max(50, cases(1000)); i > 0; --i) {  // few are ambiguous
    ambiguous += turnEverywhere(faceStar(random, random.oneIn(2) ? random.between(1, 2) : 1000));
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(ambiguous, 0);
}

/// A positive tet; with a small range, degenerate in many ways against coordinate directions.
LatticeTet positiveTet(LatticeRandom& random, std::int64_t range) {
  for (;;) {
    LatticeTet t;
    for (LatticePoint& p : t) p = random.point(-range, range);
    const auto volume = determinant<Integer256>(widened<Integer256>(t));
    if (volume < 0) std::swap(t[0], t[1]);
    if (volume != 0) return t;
  }
}

TEST(ExitOfTurn, AnswersOfSingleTets) {
  LatticeRandom random(95);
  int exits = 0;
  for (int i = cases(100'000); i > 0; --i) {
    const LatticeTet corners = positiveTet(random, random.between(1, 4));
    const auto simplex = static_cast<CornerMask>(random.between(1, 15));
    const Direction d1 = random.anyDirection();
    const Direction d2 = random.perpendicularTo(d1);
    const NormalSigns signs(corners);
    if (casing(signs, simplex, d1, d2) == kNoSimplex) continue;
    const int face = exitOfTurn(corners, signs, simplex, d1, d2);
    const CornerMask expected = exitsOfTurn(corners, simplex, d1, d2);
    ASSERT_TRUE(expected == 0 ? face == kStaysInside : face >= 0 && contains(expected, face));
    if (face >= 0) ++exits;
  }
  EXPECT_GT(exits, cases(100'000) / 50);
}

/// One random question, in a tet with coordinates up to `range`. Counts the exits found.
void askForExitOfLine(LatticeRandom& random, std::int64_t range, std::int64_t unit, int& exits) {
  const LatticeTet corners = positiveTet(random, range);
  const LatticePoint p = random.point(-2, 2);
  const GridPoint z = {static_cast<std::int32_t>(p[0]), static_cast<std::int32_t>(p[1]),
                       static_cast<std::int32_t>(p[2])};
  const Direction d1 = random.anyDirection();
  const Direction d2 = random.perpendicularTo(d1);
  const int face = exitOfLine(corners, NormalSigns(corners), z, unit, d1, d2, -1);
  const CornerMask expected = exitsOfLine(corners, latticePoint(z, unit), d1, d2);
  ASSERT_TRUE(expected == 0 ? face == kNoExit : face >= 0 && contains(expected, face));
  if (face >= 0) ++exits;
}

TEST(ExitOfLine, AnswersOfSingleTets) {
  LatticeRandom random(96);
  int exits = 0;
  for (int i = cases(100'000); i > 0; --i) {
    const std::int64_t unit = std::int64_t{1} << random.between(0, 2);
    ASSERT_NO_FATAL_FAILURE(askForExitOfLine(random, random.between(1, 4) * unit, unit, exits));
  }
  EXPECT_GT(exits, cases(100'000) / 50);
}

TEST(ExitOfLine, AnswersOfTetsOfFullRange) {
  LatticeRandom random(97);
  int exits = 0;
  constexpr std::int64_t kUnit = std::int64_t{1} << 58;
  for (int i = cases(20'000); i > 0; --i) {
    ASSERT_NO_FATAL_FAILURE(askForExitOfLine(random, 3 * kUnit, kUnit, exits));
  }
  EXPECT_GT(exits, cases(20'000) / 50);
}

TEST(ExitOfLine, DoesNotGoBack) {
  const LatticeTet corners = {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}};
  // Along the x axis, shifted to the inside: out through the slanted face, unless it came in there.
  EXPECT_EQ(exitOfLine(corners, NormalSigns(corners), {0, 0, 0}, 1, 0, 2, -1), 0);
  EXPECT_EQ(exitOfLine(corners, NormalSigns(corners), {0, 0, 0}, 1, 0, 2, 0), kNoExit);
  // Shifted to the outside, the line misses the tet.
  EXPECT_EQ(exitOfLine(corners, NormalSigns(corners), {0, 0, 0}, 1, 0, 3, -1), kNoExit);
}

struct Line {
  GridPoint from;
  std::int64_t unit;
  Direction d1;
  Direction d2;
};

/// Follows the line from tet `start` to the next grid point and counts the steps.
void follow(const TetPatch& patch, int start, const Line& line, int& steps) {
  const LatticePoint from = latticePoint(line.from, line.unit);
  const LatticePoint target = latticePoint(step(line.from, line.d1), line.unit);
  int tet = start;
  int entered = -1;
  for (steps = 0; steps < patch.size(); ++steps) {
    const LatticeTet corners = patch.corners(tet);
    if (locateIn(corners, target) != kNoSimplex) return;
    const int face =
        exitOfLine(corners, NormalSigns(corners), line.from, line.unit, line.d1, line.d2, entered);
    ASSERT_GE(face, 0) << "lost the line";
    ASSERT_TRUE(contains(exitsOfLine(corners, from, line.d1, line.d2), face)) << "not crossed";
    const int next = patch.neighbor(tet, face);
    ASSERT_GE(next, 0) << "left the patch before the target";
    entered = patch.faceTowards(next, tet);
    tet = next;
  }
  FAIL() << "walked in circles";
}

/// Lines from a grid point in all directions whose targets lie in the patch, from all tets in which
/// they may begin. Returns the total number of steps.
int followEverywhere(const TetPatch& patch, const GridPoint& z, std::int64_t unit) {
  int total = 0;
  const auto isInside = [&](const GridPoint& point) {
    for (int t = 0; t < patch.size(); ++t) {
      if (simplexOf(patch.corners(t), point, unit) != kNoSimplex) return true;
    }
    return false;
  };
  forAllDirectionPairs([&](Direction d1, Direction d2) {
    if (::testing::Test::HasFailure() || !isInside(step(z, d1))) return;
    for (int t = 0; t < patch.size(); ++t) {
      const LatticeTet corners = patch.corners(t);
      const CornerMask simplex = simplexOf(corners, z, unit);
      if (simplex == kNoSimplex) continue;
      if (casing(NormalSigns(corners), simplex, d1, d2) == kNoSimplex) continue;
      int steps = 0;
      follow(patch, t, {z, unit, d1, d2}, steps);
      if (::testing::Test::HasFailure()) return;
      total += steps;
    }
  });
  return total;
}

/// A box of tets, and one of the grid points in it.
void followInRandomBox(LatticeRandom& random, bool jitter, int& steps) {
  const std::int64_t unit = std::int64_t{1} << random.between(4, 20);
  const int cells = static_cast<int>(random.between(2, 4));
  LatticePoint origin;
  LatticePoint spacing;
  GridPoint z;
  for (std::size_t k = 0; k < 3; ++k) {
    // Cells of size 1/4 to 3/2, on quarters of the grid: lines run along edges and through
    // vertices.
    spacing[k] = random.between(1, 6) * unit / 4;
    z[k] = static_cast<std::int32_t>(random.between(-1000, 1000));
    origin[k] = z[k] * unit - random.between(0, cells) * spacing[k];
    if (random.oneIn(3)) origin[k] -= random.between(0, spacing[k] / 2);
  }
  steps += followEverywhere(boxPatch(random, origin, spacing, cells, jitter), z, unit);
}

TEST(ExitOfLine, ReachesTheNextGridPoint) {
  LatticeRandom random(98);
  int steps = 0;
  for (int i = cases(300); i > 0; --i) {
    ASSERT_NO_FATAL_FAILURE(followInRandomBox(random, true, steps));
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(steps, cases(300));
}

TEST(ExitOfLine, ReachesTheNextGridPointAlongEdgesAndFaces) {
  LatticeRandom random(99);
  int steps = 0;
  for (int i = cases(300); i > 0; --i) {
    ASSERT_NO_FATAL_FAILURE(followInRandomBox(random, false, steps));
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(steps, cases(300));
}

}  // namespace
}  // namespace hexhex::testing
