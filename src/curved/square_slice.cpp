#include <algorithm>
#include <cmath>

#include <curved/simplex_point.hpp>
#include <curved/square_slice.hpp>

namespace hexhex {

namespace {

std::int64_t height(const LatticeTet& corners, std::size_t i) noexcept { return corners[i][2]; }

/// Codes ascend with the coordinate, so that they are sums of answers: nothing is for the processor
/// to guess.
SquareSide sideOf(bool atLeastZero, bool aboveZero, bool atLeastOne, bool aboveOne) noexcept {
  return static_cast<SquareSide>(int{atLeastZero} + int{aboveZero} + int{atLeastOne} +
                                 int{aboveOne});
}

SquareSide sideOf(int fromZero, int fromOne) noexcept {
  return sideOf(fromZero >= 0, fromZero > 0, fromOne >= 0, fromOne > 0);
}

SquareSide sideOf(std::int64_t x, std::int64_t unit) noexcept {
  return sideOf(x >= 0, x > 0, x >= unit, x > unit);
}

/// A tet in the square's frame, exact and rounded.
struct SeenTet {
  const LatticeTet& exact;
  std::int64_t unit;
  std::array<std::array<double, 3>, 4> rounded;  ///< corners, in units
  std::array<double, 3> reach{1, 1, 0};          ///< largest magnitude of a coordinate or border

  SeenTet(const LatticeTet& corners, std::int64_t theUnit) noexcept
      : exact(corners), unit(theUnit), rounded() {
    const double scale = 1 / static_cast<double>(unit);  // a power of two
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        rounded[i][k] = static_cast<double>(corners[i][k]) * scale;
        reach[k] = std::max(reach[k], std::abs(rounded[i][k]));
      }
    }
  }
};

SquareSide sideBetweenExact(const SeenTet& tet, std::size_t i, std::size_t j, std::size_t zero,
                            std::int64_t border, std::size_t axis) noexcept {
  const std::int64_t atI = tet.exact[i][zero] - border;
  const std::int64_t atJ = tet.exact[j][zero] - border;
  const std::int64_t weightI = atJ < 0 ? -atJ : atJ;
  const std::int64_t weightJ = atI < 0 ? -atI : atI;
  // All products fit 124 bits.
  const Int128 sum = static_cast<Int128>(weightI) * tet.exact[i][axis] +
                     static_cast<Int128>(weightJ) * tet.exact[j][axis];
  const Int128 one = static_cast<Int128>(weightI + weightJ) * tet.unit;
  return sideOf(sum >= 0, sum > 0, sum >= one, sum > one);
}

/// Coordinate `axis` of the point between corners i and j where coordinate `zero` is 0 or, if
/// `atOne`, 1; at the corners it is on opposite sides of that.
SquareSide sideBetween(const SeenTet& tet, std::size_t i, std::size_t j, std::size_t zero,
                       bool atOne, std::size_t axis) noexcept {
  // With Z and R for the reach of the two coordinates, in units of 2^-53: weights, up to 2 Z, have
  // errors up to 3 Z; products, up to 2 Z R, 3 + 2 + 2 = 7 Z R; their sum 14 + 4 Z R; the sum of
  // weights 6 + 4 Z; the difference of both 18 + 10 + 8 < 2^6 Z R, as R is at least 1. 2^-46
  // leaves a factor of two.
  constexpr double kError = 0x1p-46;
  const double border = atOne ? 1 : 0;
  const double weightI = std::abs(tet.rounded[j][zero] - border);
  const double weightJ = std::abs(tet.rounded[i][zero] - border);
  const double sum = weightI * tet.rounded[i][axis] + weightJ * tet.rounded[j][axis];
  const double beyond = sum - (weightI + weightJ);
  const double error = kError * tet.reach[zero] * tet.reach[axis];
  if (std::abs(sum) > error && std::abs(beyond) > error) {
    return sideOf(sum > 0, sum > 0, beyond > 0, beyond > 0);
  }
  return sideBetweenExact(tet, i, j, zero, atOne ? tet.unit : 0, axis);
}

SquareSide sideOnFaceExact(const SeenTet& tet, int face, std::size_t axis,
                           std::int64_t border) noexcept {
  LatticeTet moved = tet.exact;
  for (LatticePoint& corner : moved) corner[1 - axis] -= border;
  const SimplexPoint exact = crossingOfFace(moved, face, axis);
  return sideOf(exact.compare(moved, axis, 0), exact.compare(moved, axis, tet.unit));
}

/// Coordinate `axis` (0 or 1) of the point in the interior of a face where the other one is 0 or,
/// if `atOne`, 1, and the third is 0: a mean of the corners' coordinates, weighted by areas in the
/// plane of the others.
SquareSide sideOnFace(const SeenTet& tet, int face, std::size_t axis, bool atOne) noexcept {
  // With A, Q, R for the reach of the other coordinate, the third, and this one, in units of 2^-53:
  // distances from the border, up to 2 A, have errors up to 3 A; products, up to 2 A Q, 3 + 2 + 2
  // = 7 A Q; areas, up to 4 A Q, 14 + 4 = 18 A Q; their sum 54 + 20 < 2^7 A Q; products with
  // coordinates 18 + 4 + 4 = 26 A Q R; their sum 78 + 20 < 2^7 A Q R; the difference of both sums
  // 98 + 74 + 24 < 2^8 A Q R, as R is at least 1. 2^-44 leaves a factor of two.
  constexpr double kError = 0x1p-44;
  const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
  const auto& a = tet.rounded[static_cast<std::size_t>(f[0])];
  const auto& b = tet.rounded[static_cast<std::size_t>(f[1])];
  const auto& c = tet.rounded[static_cast<std::size_t>(f[2])];
  const std::size_t other = 1 - axis;
  const double border = atOne ? 1 : 0;
  const double x = a[other] - border;
  const double y = b[other] - border;
  const double z = c[other] - border;
  const double atA = y * c[2] - z * b[2];
  const double atB = z * a[2] - x * c[2];
  const double atC = x * b[2] - y * a[2];
  const double area = atA + atB + atC;
  const double sum = atA * a[axis] + atB * b[axis] + atC * c[axis];
  const double beyond = sum - area;
  const double areaError = kError * tet.reach[other] * tet.reach[2];
  const double error = areaError * tet.reach[axis];
  if (std::abs(area) > areaError && std::abs(sum) > error && std::abs(beyond) > error) {
    const bool above = (sum > 0) == (area > 0);
    const bool aboveOne = (beyond > 0) == (area > 0);
    return sideOf(above, above, aboveOne, aboveOne);
  }
  return sideOnFaceExact(tet, face, axis, atOne ? tet.unit : 0);
}

/// The corners of a slice before it is clipped.
class Outline {
 public:
  explicit Outline(const SeenTet& tet) : tet_(tet), corners_(tet.exact) {}

  void addCorner(std::size_t i) {
    const auto simplex = cornerBit(static_cast<int>(i));
    // A corner of the tet ends several edges that the plane crosses.
    for (std::size_t k = 0; k < slice_.size(); ++k) {
      if (slice_[k].simplex == simplex) return;
    }
    slice_.add(
        {simplex, {sideOf(corners_[i][0], tet_.unit), sideOf(corners_[i][1], tet_.unit)}, 0});
  }
  /// The point of an edge in the plane; corner i may lie in the plane, corner j does not.
  void addCrossing(std::size_t i, std::size_t j) {
    if (height(corners_, i) == 0) return addCorner(i);
    const auto simplex =
        static_cast<CornerMask>(cornerBit(static_cast<int>(i)) | cornerBit(static_cast<int>(j)));
    slice_.add(
        {simplex, {sideBetween(tet_, i, j, 2, false, 0), sideBetween(tet_, i, j, 2, false, 1)}, 0});
  }

  /// Two corners that follow each other span the simplex that their side runs in.
  [[nodiscard]] Slice finish() {
    for (std::size_t i = 0; i < slice_.size(); ++i) {
      const CornerMask next = slice_[i + 1 < slice_.size() ? i + 1 : 0].simplex;
      slice_[i].side = static_cast<std::uint8_t>(slice_[i].simplex | next);
    }
    return slice_;
  }

 private:
  const SeenTet& tet_;
  const LatticeTet& corners_;
  Slice slice_;
};

Slice outlineOfFace(const SeenTet& tet, CornerMask face) {
  const LatticeTet& corners = tet.exact;
  const int opposite = oppositeCorner(face);
  std::array<int, 3> f = kFaceCorners[static_cast<std::size_t>(opposite)];
  // The face's normal points to the opposite corner.
  if (height(corners, static_cast<std::size_t>(opposite)) < 0) std::swap(f[1], f[2]);
  Outline outline(tet);
  for (const int i : f) outline.addCorner(static_cast<std::size_t>(i));
  return outline.finish();
}

/// Corners in the plane count as above it; crossings of their edges are the corners themselves.
Slice outlineOfTet(const SeenTet& tet) {
  const LatticeTet& corners = tet.exact;
  std::array<std::size_t, 4> above{};
  std::array<std::size_t, 4> below{};
  std::size_t aboveCount = 0;
  std::size_t belowCount = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    (height(corners, i) < 0 ? below[belowCount++] : above[aboveCount++]) = i;
  }
  Outline outline(tet);
  if (aboveCount == 2) {
    // With corners i, j above and k, l below, in an even order, the sides go around as ik, jk, jl,
    // il: see the tet (1, 0, 1), (-1, 0, 1), (0, 1, -1), (0, -1, -1). Of the orders with i < j and
    // k < l, those of {0, 2}, {1, 3} are odd.
    const bool odd = (above[0] + above[1]) % 2 == 0;
    if (odd) std::swap(below[0], below[1]);
    outline.addCrossing(above[0], below[0]);
    outline.addCrossing(above[1], below[0]);
    outline.addCrossing(above[1], below[1]);
    outline.addCrossing(above[0], below[1]);
    return outline.finish();
  }
  // One corner alone on its side: the edges to the others, as the opposite face is walked around,
  // whose normal points to that corner.
  const std::size_t alone = aboveCount == 1 ? above[0] : below[0];
  std::array<int, 3> f = kFaceCorners[alone];
  if (belowCount == 1) std::swap(f[1], f[2]);
  for (const int i : f) {
    const auto other = static_cast<std::size_t>(i);
    // Only corners above may lie in the plane.
    belowCount == 1 ? outline.addCrossing(other, alone) : outline.addCrossing(alone, other);
  }
  return outline.finish();
}

/// One side of the square as a half plane.
struct HalfPlane {
  std::size_t axis;   ///< of the coordinate that it bounds
  SquareSide border;  ///< AtZero from below, AtOne from above
  std::uint8_t label;

  /// Positive inside, 0 on the border, negative outside.
  [[nodiscard]] int side(const SliceCorner& corner) const noexcept {
    const int beyond = static_cast<int>(corner.at[axis]) - static_cast<int>(border);
    return border == SquareSide::AtZero ? beyond : -beyond;
  }
};

constexpr std::array<HalfPlane, 4> kHalfPlanes = {{{1, SquareSide::AtZero, kSquareSide},
                                                   {0, SquareSide::AtOne, kSquareSide + 1},
                                                   {1, SquareSide::AtOne, kSquareSide + 2},
                                                   {0, SquareSide::AtZero, kSquareSide + 3}}};

/// The half planes (a bit each) that a slice does not lie in the interior of.
unsigned halfPlanesToClip(const Slice& slice) noexcept {
  constexpr std::array<std::array<unsigned, 5>, 2> kBits = {{{8, 8, 0, 2, 2}, {1, 1, 0, 4, 4}}};
  unsigned bits = 0;
  for (std::size_t i = 0; i < slice.size(); ++i) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      bits |= kBits[axis][static_cast<std::size_t>(slice[i].at[axis])];
    }
  }
  return bits;
}

/// Where the border of a half plane crosses a side between its ends.
SliceCorner crossing(const HalfPlane& plane, std::uint8_t side, const SeenTet& tet) noexcept {
  SliceCorner corner{side, {plane.border, plane.border}, side};
  const std::size_t other = 1 - plane.axis;
  if (side >= kSquareSide) {  // a corner of the square; only borders of the other axis get here
    corner.simplex = kNoSimplex;
    corner.at[other] =
        side == kSquareSide || side == kSquareSide + 3 ? SquareSide::AtZero : SquareSide::AtOne;
    return corner;
  }
  const bool atOne = plane.border == SquareSide::AtOne;
  if (dimension(side) == 1) {
    corner.at[other] =
        sideBetween(tet, firstCorner(side), lastCorner(side), plane.axis, atOne, other);
  } else {
    corner.at[other] = sideOnFace(tet, oppositeCorner(side), other, atOne);
  }
  return corner;
}

/// Clips a slice that does not lie in the interior of a half plane.
void clip(Slice& slice, const HalfPlane& plane, const SeenTet& tet) noexcept {
  std::array<int, 9> at{};
  int least = 1;
  const std::size_t size = slice.size();
  for (std::size_t i = 0; i < size; ++i) {
    at[i] = plane.side(slice[i]);
    least = std::min(least, at[i]);
  }
  if (least > 0) return;
  at[size] = at[0];
  Slice result;
  for (std::size_t i = 0; i < size; ++i) {
    if (at[i] >= 0) {
      result.add(slice[i]);
      // What is cut off behind a corner on the border leaves a side along the border.
      if (at[i] == 0 && at[i + 1] <= 0) result[result.size() - 1].side = plane.label;
    }
    if (at[i] * at[i + 1] < 0) {
      result.add(crossing(plane, slice[i].side, tet));
      if (at[i + 1] < 0) result[result.size() - 1].side = plane.label;
    }
  }
  slice = result;
}

}  // namespace

CornerMask carrierOfPlane(const LatticeTet& corners) noexcept {
  bool above = false;
  bool below = false;
  CornerMask inPlane = kNoSimplex;
  for (std::size_t i = 0; i < 4; ++i) {
    above = above || height(corners, i) > 0;
    below = below || height(corners, i) < 0;
    if (height(corners, i) == 0) {
      inPlane = static_cast<CornerMask>(inPlane | cornerBit(static_cast<int>(i)));
    }
  }
  if (above && below) return kWholeTet;
  return dimension(inPlane) == 2 ? inPlane : kNoSimplex;
}

Slice sliceSquare(const LatticeTet& corners, CornerMask carrier, std::int64_t unit) noexcept {
  const SeenTet tet(corners, unit);
  Slice slice = carrier == kWholeTet ? outlineOfTet(tet) : outlineOfFace(tet, carrier);
  // Corners that clipping makes lie between others, so that no other half planes have to follow.
  const unsigned toClip = halfPlanesToClip(slice);
  for (std::size_t i = 0; i < 4 && slice.size() > 2; ++i) {
    if (((toClip >> i) & 1U) != 0) clip(slice, kHalfPlanes[i], tet);
  }
  return slice;
}

}  // namespace hexhex
