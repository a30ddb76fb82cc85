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

/// A coordinate of the point between corners i and j where a linear function vanishes that has
/// values of opposite signs there; all products fit 124 bits.
SquareSide sideBetween(const LatticeTet& corners, std::size_t i, std::size_t j, std::int64_t atI,
                       std::int64_t atJ, std::size_t axis, std::int64_t unit) noexcept {
  const std::int64_t weightI = atJ < 0 ? -atJ : atJ;
  const std::int64_t weightJ = atI < 0 ? -atI : atI;
  const Int128 sum = static_cast<Int128>(weightI) * corners[i][axis] +
                     static_cast<Int128>(weightJ) * corners[j][axis];
  const Int128 one = static_cast<Int128>(weightI + weightJ) * unit;
  return sideOf(sum >= 0, sum > 0, sum >= one, sum > one);
}

/// Coordinate `axis` (0 or 1) of the point in the interior of a face where the other one has a
/// value and the third vanishes: a mean of the corners' coordinates, weighted by areas in the plane
/// of the others.
SquareSide sideOnFace(const LatticeTet& corners, int face, std::size_t axis, std::int64_t other,
                      std::int64_t unit) noexcept {
  const std::array<int, 3>& f = kFaceCorners[static_cast<std::size_t>(face)];
  std::array<std::array<double, 3>, 3> c;
  for (std::size_t i = 0; i < 3; ++i) {
    const LatticePoint& corner = corners[static_cast<std::size_t>(f[i])];
    c[i] = {static_cast<double>(corner[1 - axis] - other), static_cast<double>(corner[2]),
            static_cast<double>(corner[axis])};
  }
  // Areas carry at most four roundings relative to the sum of magnitudes of their products; sums
  // and products behind them five more: 9 * 2^-53 < 2^-49. 2^-48 leaves a factor of two.
  constexpr double kRelativeError = 0x1p-48;
  const auto one = static_cast<double>(unit);
  double area = 0;
  double sum = 0;
  double magnitude = 0;
  double reach = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& a = c[(i + 1) % 3];
    const auto& b = c[(i + 2) % 3];
    const double first = a[0] * b[1];
    const double second = a[1] * b[0];
    area += first - second;
    sum += (first - second) * c[i][2];
    const double size = std::abs(first) + std::abs(second);
    magnitude += size;
    reach += size * (std::abs(c[i][2]) + one);
  }
  const double beyond = sum - area * one;
  if (std::abs(area) > kRelativeError * magnitude && std::abs(sum) > kRelativeError * reach &&
      std::abs(beyond) > kRelativeError * reach) {
    const bool turned = area < 0;
    return sideOf((sum > 0) != turned ? 1 : -1, (beyond > 0) != turned ? 1 : -1);
  }
  LatticeTet moved = corners;
  for (LatticePoint& corner : moved) corner[1 - axis] -= other;
  const SimplexPoint exact = crossingOfFace(moved, face, axis);
  return sideOf(exact.compare(corners, axis, 0), exact.compare(corners, axis, unit));
}

/// The corners of a slice before it is clipped.
class Outline {
 public:
  Outline(const LatticeTet& corners, std::int64_t unit) : corners_(corners), unit_(unit) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      allInside_[axis] = true;
      for (const LatticePoint& corner : corners) {
        allInside_[axis] = allInside_[axis] && corner[axis] > 0 && corner[axis] < unit;
      }
    }
  }

  void addCorner(std::size_t i) {
    const auto simplex = cornerBit(static_cast<int>(i));
    // A corner of the tet ends several edges that the plane crosses.
    for (std::size_t k = 0; k < slice_.size(); ++k) {
      if (slice_[k].simplex == simplex) return;
    }
    slice_.add({simplex, {sideOf(corners_[i][0], unit_), sideOf(corners_[i][1], unit_)}, 0});
  }
  /// The point of an edge in the plane; corner i may lie in the plane, corner j does not.
  void addCrossing(std::size_t i, std::size_t j) {
    if (height(corners_, i) == 0) return addCorner(i);
    const auto simplex =
        static_cast<CornerMask>(cornerBit(static_cast<int>(i)) | cornerBit(static_cast<int>(j)));
    slice_.add({simplex, {place(i, j, 0), place(i, j, 1)}, 0});
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
  [[nodiscard]] SquareSide place(std::size_t i, std::size_t j, std::size_t axis) const noexcept {
    if (allInside_[axis]) return SquareSide::Inside;
    return sideBetween(corners_, i, j, height(corners_, i), height(corners_, j), axis, unit_);
  }

  const LatticeTet& corners_;
  std::int64_t unit_;
  std::array<bool, 2> allInside_{};
  Slice slice_;
};

Slice outlineOfFace(const LatticeTet& corners, CornerMask face, std::int64_t unit) {
  const int opposite = oppositeCorner(face);
  std::array<int, 3> f = kFaceCorners[static_cast<std::size_t>(opposite)];
  // The face's normal points to the opposite corner.
  if (height(corners, static_cast<std::size_t>(opposite)) < 0) std::swap(f[1], f[2]);
  Outline outline(corners, unit);
  for (const int i : f) outline.addCorner(static_cast<std::size_t>(i));
  return outline.finish();
}

/// Corners in the plane count as above it; crossings of their edges are the corners themselves.
Slice outlineOfTet(const LatticeTet& corners, std::int64_t unit) {
  std::array<std::size_t, 4> above{};
  std::array<std::size_t, 4> below{};
  std::size_t aboveCount = 0;
  std::size_t belowCount = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    (height(corners, i) < 0 ? below[belowCount++] : above[aboveCount++]) = i;
  }
  Outline outline(corners, unit);
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
SliceCorner crossing(const HalfPlane& plane, std::uint8_t side, const LatticeTet& corners,
                     std::int64_t unit) noexcept {
  SliceCorner corner{side, {plane.border, plane.border}, side};
  const std::size_t other = 1 - plane.axis;
  if (side >= kSquareSide) {  // a corner of the square; only borders of the other axis get here
    corner.simplex = kNoSimplex;
    corner.at[other] =
        side == kSquareSide || side == kSquareSide + 3 ? SquareSide::AtZero : SquareSide::AtOne;
    return corner;
  }
  const std::int64_t at = plane.border == SquareSide::AtOne ? unit : 0;
  if (dimension(side) == 1) {
    const std::size_t i = firstCorner(side);
    const std::size_t j = lastCorner(side);
    corner.at[other] = sideBetween(corners, i, j, corners[i][plane.axis] - at,
                                   corners[j][plane.axis] - at, other, unit);
  } else {
    corner.at[other] = sideOnFace(corners, oppositeCorner(side), other, at, unit);
  }
  return corner;
}

/// Clips a slice that does not lie in the interior of a half plane.
void clip(Slice& slice, const HalfPlane& plane, const LatticeTet& corners,
          std::int64_t unit) noexcept {
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
      result.add(crossing(plane, slice[i].side, corners, unit));
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
  Slice slice =
      carrier == kWholeTet ? outlineOfTet(corners, unit) : outlineOfFace(corners, carrier, unit);
  // Corners that clipping makes lie between others, so that no other half planes have to follow.
  const unsigned toClip = halfPlanesToClip(slice);
  for (std::size_t i = 0; i < 4 && slice.size() > 2; ++i) {
    if (((toClip >> i) & 1U) != 0) clip(slice, kHalfPlanes[i], corners, unit);
  }
  return slice;
}

}  // namespace hexhex
