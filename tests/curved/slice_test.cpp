// Slices of a square and cubes that meet triangles, against arithmetic on rationals.
#include <array>
#include <random>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>
#include <curved/cube_meets_face.hpp>
#include <curved/square_slice.hpp>
#include <gtest/gtest.h>

#include "extract/support.hpp"

namespace hexhex::test {

namespace {

using Rational = boost::multiprecision::cpp_rational;
using Point = std::array<Rational, 3>;

constexpr std::int64_t kUnit = 8;

Point toPoint(const LatticePoint& p) { return {p[0], p[1], p[2]}; }

/// Corners from a small range, so that all kinds of coincidences occur.
LatticeTet anyTet(std::mt19937& random) {
  std::uniform_int_distribution<std::int64_t> any(-6, 14);
  for (;;) {
    LatticeTet tet{};
    for (LatticePoint& p : tet) p = {any(random), any(random), any(random) - 4};
    if (orientation(tet[0], tet[1], tet[2], tet[3]) > 0) return tet;
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
std::vector<Point> squareInTet(const LatticeTet& tet) {
  std::vector<Point> polygon = {{0, 0, 0}, {kUnit, 0, 0}, {kUnit, kUnit, 0}, {0, kUnit, 0}};
  for (std::size_t face = 0; face < 4; ++face) {
    const auto corner = [&](std::size_t i) {
      return toPoint(tet[static_cast<std::size_t>(kFaceCorners[face][i])]);
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

TEST(SquareSlice, AsManyCornersAsTheClippedSquare) {
  std::mt19937 random(7);
  int withArea = 0;
  for (int i = 0; i < cases(3000); ++i) {
    const LatticeTet tet = anyTet(random);
    const CornerMask carrier = carrierOfPlane(tet);
    const std::vector<Point> expected = squareInTet(tet);
    const bool hasArea = expected.size() >= 3 && areaAlong(expected, 2) > 0;
    if (carrier == kNoSimplex) {
      EXPECT_FALSE(hasArea);
      continue;
    }
    const Slice slice = sliceSquare(tet, carrier, kUnit);
    ASSERT_EQ(slice.size() >= 3, hasArea);
    if (!hasArea) continue;
    ++withArea;
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
      const SliceCorner& to = slice[(k + 1) % slice.size()];
      for (const SquareSide at : {from.at[0], from.at[1]}) {
        ASSERT_NE(at, SquareSide::Below);
        ASSERT_NE(at, SquareSide::Above);
      }
      // A side on the border is labelled so.
      const bool onBorder = from.side >= kSquareSide;
      const bool together = (from.at[0] == to.at[0] && from.onBorder(0)) ||
                            (from.at[1] == to.at[1] && from.onBorder(1));
      ASSERT_EQ(onBorder, together);
    }
  }
  EXPECT_GT(withArea, 0);
}

TEST(CubeMeetsFace, AsTheClippedTriangle) {
  std::mt19937 random(11);
  int met = 0;
  for (int i = 0; i < cases(3000); ++i) {
    const LatticeTet tet = anyTet(random);
    for (int face = 0; face < 4; ++face) {
      std::vector<Point> polygon;
      for (const int corner : kFaceCorners[static_cast<std::size_t>(face)]) {
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
