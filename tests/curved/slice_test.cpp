// Slices of a square and cubes that meet triangles, against arithmetic on rationals.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <curved/lagrange.hpp>
#include <curved/square_slice.hpp>

#include "extract/support.hpp"

namespace hexhex::test {

using namespace curved;

namespace {

using Rational = boost::multiprecision::cpp_rational;
using Point = std::array<Rational, 3>;

constexpr std::int64_t kUnit = 8;

Point toPoint(const lattice::LatticePoint& p) { return {p[0], p[1], p[2]}; }

/// Corners from a small range, so that all kinds of coincidences occur.
lattice::LatticeTet anyTet(std::mt19937& random) {
  std::uniform_int_distribution<std::int64_t> any(-6, 14);
  for (;;) {
    lattice::LatticeTet tet{};
    for (lattice::LatticePoint& p : tet) p = {any(random), any(random), any(random) - 4};
    if (lattice::orientation(tet[0], tet[1], tet[2], tet[3]) > 0) return tet;
  }
}

/// A convex polygon in space without those parts where `sideOf` is negative.
template <class F>
std::vector<Point> clip(const std::vector<Point>& polygon, const F& sideOf) {
  std::vector<Point> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    const Rational atA = sideOf(a);
    const Rational atB = sideOf(b);
    if (atA >= 0) result.push_back(a);
    if (atA * atB < 0) {
      const Rational s = atA / (atA - atB);
      Point p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = a[k] + s * (b[k] - a[k]);
      result.push_back(p);
    }
  }
  return result;
}

Rational areaAlong(const std::vector<Point>& polygon, std::size_t axis) {
  Rational sum = 0;
  const std::size_t x = (axis + 1) % 3;
  const std::size_t y = (axis + 2) % 3;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    sum += a[x] * b[y] - a[y] * b[x];
  }
  return sum;
}

/// The square without what lies outside the tet: from the other side than sliceSquare() goes.
std::vector<Point> squareInTet(const lattice::LatticeTet& tet) {
  std::vector<Point> polygon = {{0, 0, 0}, {kUnit, 0, 0}, {kUnit, kUnit, 0}, {0, kUnit, 0}};
  for (std::size_t face = 0; face < 4; ++face) {
    const auto corner = [&](std::size_t i) {
      return toPoint(tet[static_cast<std::size_t>(lattice::kFaceCorners[face][i])]);
    };
    const Point o = corner(0);
    const Point a = corner(1);
    const Point b = corner(2);
    polygon = clip(polygon, [&](const Point& p) {
      Rational sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3;
        const std::size_t j = (k + 2) % 3;
        sum += ((a[i] - o[i]) * (b[j] - o[j]) - (a[j] - o[j]) * (b[i] - o[i])) * (p[k] - o[k]);
      }
      return sum;
    });
  }
  return polygon;
}

/// What slices say about a corner: everything but the point of the section.
std::array<int, 3> codesOf(const SliceCorner& corner) {
  return {corner.isSquareCorner() ? 0 : corner.simplex, corner.borders, corner.side};
}

void expectSame(const Slice& a, const Slice& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(codesOf(a[i]), codesOf(b[i]));
    ASSERT_EQ(a[i].point, b[i].point);
  }
  ASSERT_EQ(a.borders, b.borders);
  ASSERT_EQ(a.borderSides, b.borderSides);
  ASSERT_EQ(a.squareCorners, b.squareCorners);
}

Slice sliceOf(const SeenTet& tet, const Section& section, std::int64_t unit) {
  SectionCuts cuts;
  Slice slice;
  sliceSquare(tet, section, unit, {}, cuts, slice);
  return slice;
}

TEST(SquareSlice, AsManyCornersAsTheClippedSquare) {
  std::mt19937 random(7);
  int withArea = 0;
  for (int i = 0; i < cases(3000); ++i) {
    const lattice::LatticeTet tet = anyTet(random);
    const SeenTet seen(tet, kUnit);
    const lattice::CornerMask carrier = seen.carrier();
    const std::vector<Point> expected = squareInTet(tet);
    const bool hasArea = expected.size() >= 3 && areaAlong(expected, 2) > 0;
    if (carrier == lattice::kNoSimplex) {
      EXPECT_FALSE(hasArea);
      continue;
    }
    const Section section = sectionOf(seen, carrier, kUnit);
    const Slice slice = sliceOf(seen, section, kUnit);
    ASSERT_EQ(slice.size() >= 3, hasArea);
    if (!hasArea) continue;
    ++withArea;
    ASSERT_NO_FATAL_FAILURE(expectSame(slice, clipSquare(seen, section, kUnit)));
    // No corner twice, and none in the middle of a side: both are convex polygons without those.
    std::vector<Point> corners;
    for (std::size_t k = 0; k < expected.size(); ++k) {
      if (expected[k] != expected[(k + 1) % expected.size()]) corners.push_back(expected[k]);
    }
    std::size_t proper = 0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::vector<Point> ear = {corners[(k + corners.size() - 1) % corners.size()],
                                      corners[k], corners[(k + 1) % corners.size()]};
      if (areaAlong(ear, 2) != 0) ++proper;
    }
    ASSERT_EQ(slice.size(), proper);
    for (std::size_t k = 0; k < slice.size(); ++k) {
      const SliceCorner& from = slice[k];
      const SliceCorner& to = slice[slice.next(k)];
      ASSERT_EQ(from.borders & 15U, 0U);  // nothing is beyond a border
      // A side on the border is labelled so.
      const unsigned together = unsigned{from.borders} & to.borders;
      ASSERT_EQ(from.side >= kSquareSide, together != 0);
      if (together != 0) {
        ASSERT_NE(together & onBorder(from.side - kSquareSide), 0U);
      }
    }
  }
  EXPECT_GT(withArea, 0);
}

/// A corner of a large lattice.
lattice::LatticePoint anyPoint(std::mt19937_64& random, std::int64_t reach) {
  std::uniform_int_distribution<std::int64_t> any(-reach, reach);
  return {any(random), any(random), any(random)};
}

/// A tet so close to a special position that rounded numbers cannot tell: corners are moved so that
/// an edge meets the plane, or a face a border, within a few units of the lattice.
lattice::LatticeTet nearlySpecialTet(std::mt19937_64& random, std::int64_t unit) {
  std::uniform_int_distribution<std::int64_t> few(-2, 2);
  std::uniform_int_distribution<int> quarter(0, 3);
  for (;;) {
    lattice::LatticeTet tet{};
    for (lattice::LatticePoint& p : tet) p = anyPoint(random, 2 * unit);
    // Corner 1 is behind a corner or a side of the square, as corner 0 sees it.
    const lattice::LatticePoint target = {
        quarter(random) < 2 ? 0 : unit, quarter(random) < 2 ? unit : anyPoint(random, unit)[0], 0};
    for (std::size_t k = 0; k < 3; ++k) tet[1][k] = 2 * target[k] - tet[0][k] + few(random);
    const int side = lattice::orientation(tet[0], tet[1], tet[2], tet[3]);
    if (side < 0) std::swap(tet[2], tet[3]);
    if (side != 0) return tet;
  }
}

TEST(SquareSlice, ExactFlagsWhereRoundedNumbersCannotTell) {
  constexpr std::int64_t kFine = std::int64_t{1} << 57;
  std::mt19937_64 random(5);
  int near = 0;
  for (int i = 0; i < cases(2000); ++i) {
    const lattice::LatticeTet tet = nearlySpecialTet(random, kFine);
    const SeenTet seen(tet, static_cast<double>(kFine));
    if (seen.carrier() != lattice::kWholeTet) continue;
    const Section section = sectionOf(seen, lattice::kWholeTet, kFine);
    for (std::size_t k = 0; k < section.size; ++k) {
      const SectionPoint& point = section.points[k];
      if (lattice::dimension(point.simplex) != 1) continue;
      const lattice::LatticePoint& a = tet[lattice::firstCorner(point.simplex)];
      const lattice::LatticePoint& b = tet[lattice::lastCorner(point.simplex)];
      unsigned expected = 0;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const Rational x = Rational(a[axis]) +
                           Rational(a[2]) / (Rational(a[2]) - b[2]) * (Rational(b[axis]) - a[axis]);
        expected |= bordersBySigns(axis, x.sign(), Rational(x - kFine).sign());
        near += abs(x) < 100 || abs(x - kFine) < 100 ? 1 : 0;
        const double error = std::abs((Rational(point.at[axis]) - x).convert_to<double>());
        ASSERT_LE(error, kPointError * seen.reach);
      }
      ASSERT_EQ(point.borders, expected);
    }
    // Cutting sides and clipping agree, from whatever side a section is begun.
    const Slice slice = sliceOf(seen, section, kFine);
    const Slice clipped = clipSquare(seen, section, kFine);
    ASSERT_EQ(slice.size() < 3, clipped.size() < 3);
    if (slice.size() >= 3) {
      ASSERT_NO_FATAL_FAILURE(expectSame(slice, clipped));
    }
  }
  EXPECT_GT(near, 0);
}

/// Corners that make sections with all kinds of sides, in general position.
TEST(SquareSlice, SidesOneByOneAndClippingAgree) {
  constexpr std::int64_t kFine = 1 << 20;
  std::mt19937_64 random(13);
  int sliced = 0;
  for (int i = 0; i < cases(20000); ++i) {
    const std::int64_t reach = kFine * (1 + i % 5);
    lattice::LatticeTet tet{};
    for (lattice::LatticePoint& p : tet) p = anyPoint(random, reach);
    if (lattice::orientation(tet[0], tet[1], tet[2], tet[3]) < 0) std::swap(tet[2], tet[3]);
    const SeenTet seen(tet, kFine);
    if (seen.carrier() != lattice::kWholeTet || seen.inPlane != 0) continue;
    const Section section = sectionOf(seen, lattice::kWholeTet, kFine);
    const Slice slice = sliceOf(seen, section, kFine);
    const Slice clipped = clipSquare(seen, section, kFine);
    ASSERT_EQ(slice.size() < 3, clipped.size() < 3);
    if (slice.size() < 3) continue;
    ++sliced;
    ASSERT_NO_FATAL_FAILURE(expectSame(slice, clipped));
    // Midpoints of sides that the slice is sure to have: the tet contains them.
    for (std::size_t side = 0; side < 4; ++side) {
      const lattice::LatticePoint middle = {side == 1 ? kFine : (side == 3 ? 0 : kFine / 2),
                                            side == 2 ? kFine : (side == 0 ? 0 : kFine / 2), 0};
      bool inside = true;
      for (const auto& f : lattice::kFaceCorners) {
        inside = inside && lattice::orientation(tet[static_cast<std::size_t>(f[0])],
                                                tet[static_cast<std::size_t>(f[1])],
                                                tet[static_cast<std::size_t>(f[2])], middle) > 0;
      }
      const bool isCertain = ((slice.midpoints >> side) & 1U) != 0;
      const bool isPossible = ((slice.possibleMidpoints >> side) & 1U) != 0;
      ASSERT_TRUE(isPossible || isCertain == inside);
    }
  }
  EXPECT_GT(sliced, 0);
}

/// The section behind a face is that of the tet there, and so is its slice.
TEST(SquareSlice, BehindAFace) {
  constexpr std::int64_t kFine = 1 << 20;
  std::mt19937_64 random(17);
  std::array<std::size_t, 4> order = {0, 1, 2, 3};
  int crossed = 0;
  for (int i = 0; i < cases(20000); ++i) {
    lattice::LatticeTet tet{};
    for (lattice::LatticePoint& p : tet) p = anyPoint(random, 2 * kFine);
    const lattice::LatticePoint apex = anyPoint(random, 2 * kFine);
    if (lattice::orientation(tet[0], tet[1], tet[2], tet[3]) < 0) std::swap(tet[2], tet[3]);
    const SeenTet seen(tet, kFine);
    if (seen.carrier() != lattice::kWholeTet || seen.inPlane != 0) continue;
    const Section section = sectionOf(seen, lattice::kWholeTet, kFine);
    SectionCuts cuts;
    Slice slice;
    sliceSquare(seen, section, kFine, {}, cuts, slice);
    for (std::size_t side = 0; side < section.size && cuts.areKnown; ++side) {
      const auto face =
          static_cast<std::size_t>(lattice::oppositeCorner(section.sideSimplex(side)));
      lattice::LatticeTet behind = tet;
      behind[face] = apex;
      // In another order of corners.
      std::shuffle(order.begin(), order.end(), random);
      lattice::LatticeTet shuffled{};
      for (std::size_t k = 0; k < 4; ++k) shuffled[order[k]] = behind[k];
      if (lattice::orientation(shuffled[0], shuffled[1], shuffled[2], shuffled[3]) < 0) continue;
      // On the same side of the face:
      if (lattice::orientation(behind[0], behind[1], behind[2], behind[3]) >= 0) continue;
      SeenTet there(shuffled, kFine);
      if (there.inPlane != 0) continue;
      ++crossed;
      there.reach = std::max(there.reach, seen.reach);
      const Section expected = sectionOf(there, lattice::kWholeTet, kFine);
      std::size_t entry = 4;
      const Section found =
          sectionBehind(there, static_cast<int>(order[face]), section, side, kFine, entry);
      ASSERT_EQ(found.size, expected.size);
      ASSERT_EQ(found.sideSimplex(entry), lattice::faceMask(static_cast<int>(order[face])));
      for (std::size_t k = 0; k < found.size; ++k) {
        ASSERT_EQ(found.points[k].at, expected.points[k].at);
        ASSERT_EQ(found.points[k].simplex, expected.points[k].simplex);
        ASSERT_EQ(found.points[k].borders, expected.points[k].borders);
      }
      SectionCuts cutsThere;
      Slice sliceThere;
      sliceSquare(there, found, kFine, {entry, cuts.sides[side].reversed()}, cutsThere, sliceThere);
      if (sliceThere.size() >= 3) {
        ASSERT_NO_FATAL_FAILURE(expectSame(sliceThere, sliceOf(there, expected, kFine)));
      }
    }
  }
  EXPECT_GT(crossed, 0);
}

TEST(CubeMeetsFace, AsTheClippedTriangle) {
  std::mt19937 random(11);
  int met = 0;
  for (int i = 0; i < cases(3000); ++i) {
    const lattice::LatticeTet tet = anyTet(random);
    for (int face = 0; face < 4; ++face) {
      std::vector<Point> polygon;
      for (const int corner : lattice::kFaceCorners[static_cast<std::size_t>(face)]) {
        polygon.push_back(toPoint(tet[static_cast<std::size_t>(corner)]));
      }
      for (std::size_t k = 0; k < 3; ++k) {
        polygon = clip(polygon, [k](const Point& p) { return p[k]; });
        polygon = clip(polygon, [k](const Point& p) { return Rational(kUnit - p[k]); });
      }
      // The part in the closed cube meets the open one unless it lies in one of the cube's sides.
      bool expected = !polygon.empty();
      for (std::size_t k = 0; k < 3; ++k) {
        bool low = true;
        bool high = true;
        for (const Point& p : polygon) {
          low = low && p[k] == 0;
          high = high && p[k] == kUnit;
        }
        expected = expected && !low && !high;
      }
      ASSERT_EQ(cubeMeetsFace(tet, face, kUnit), expected);
      met += expected ? 1 : 0;
    }
  }
  EXPECT_GT(met, 0);
}

}  // namespace
}  // namespace hexhex::test
