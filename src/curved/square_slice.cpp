#include <algorithm>

#include <curved/square_slice.hpp>

namespace hexhex {

namespace {

std::int64_t height(const LatticeTet& corners, std::size_t i) noexcept { return corners[i][2]; }

SquareSide placeOf(const SimplexPoint& point, const LatticeTet& corners, std::size_t axis,
                   std::int64_t unit) noexcept {
  const int fromZero = point.compare(corners, axis, 0);
  if (fromZero < 0) return SquareSide::Below;
  if (fromZero == 0) return SquareSide::AtZero;
  const int fromOne = point.compare(corners, axis, unit);
  if (fromOne > 0) return SquareSide::Above;
  return fromOne == 0 ? SquareSide::AtOne : SquareSide::Inside;
}

/// The corners of a slice before it is clipped.
class Outline {
 public:
  Outline(const LatticeTet& corners, std::int64_t unit) : corners_(corners), unit_(unit) {}

  void addCorner(std::size_t i) { add(SimplexPoint::corner(i)); }
  /// The point of an edge in the plane, whose ends are not both in it.
  void addCrossing(std::size_t i, std::size_t j) {
    add(SimplexPoint::between(i, j, height(corners_, i), height(corners_, j)));
  }

  /// Two corners that follow each other span the simplex that their side runs in.
  [[nodiscard]] Slice finish() {
    for (std::size_t i = 0; i < slice_.size(); ++i) {
      const CornerMask next = slice_[(i + 1) % slice_.size()].point.simplex();
      slice_[i].side = static_cast<std::uint8_t>(slice_[i].point.simplex() | next);
    }
    return slice_;
  }

 private:
  void add(SimplexPoint point) {
    // A crossing at an end of its edge is the corner there, and may be so twice.
    const CornerMask simplex = point.simplex();
    if (dimension(simplex) == 0) point = SimplexPoint::corner(firstCorner(simplex));
    for (std::size_t i = 0; i < slice_.size(); ++i) {
      if (slice_[i].point.simplex() == simplex) return;
    }
    slice_.add({point,
                {placeOf(point, corners_, 0, unit_), placeOf(point, corners_, 1, unit_)},
                kNoSimplex});
  }

  const LatticeTet& corners_;
  std::int64_t unit_;
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
  for (const int i : f) outline.addCrossing(alone, static_cast<std::size_t>(i));
  return outline.finish();
}

/// One side of the square as a half plane.
struct HalfPlane {
  std::size_t axis;   ///< of the coordinate that it bounds
  SquareSide border;  ///< AtZero from below, AtOne from above
  std::uint8_t label;

  /// 1 inside, 0 on the border, -1 outside.
  [[nodiscard]] int side(const SliceCorner& corner) const noexcept {
    const SquareSide at = corner.at[axis];
    if (at == border) return 0;
    return border == SquareSide::AtZero ? (at > border ? 1 : -1) : (at < border ? 1 : -1);
  }
};

/// Where the border of a half plane crosses a side between its ends.
SliceCorner crossing(const HalfPlane& plane, std::uint8_t side, const LatticeTet& corners,
                     std::int64_t unit) noexcept {
  SliceCorner corner{{}, {plane.border, plane.border}, side};
  const std::size_t other = 1 - plane.axis;
  if (side >= kSquareSide) {  // a corner of the square; only borders of the other axis get here
    corner.at[other] =
        side == kSquareSide || side == kSquareSide + 3 ? SquareSide::AtZero : SquareSide::AtOne;
    return corner;
  }
  const std::int64_t at = plane.border == SquareSide::AtOne ? unit : 0;
  if (dimension(side) == 1) {
    const std::size_t i = firstCorner(side);
    const std::size_t j = lastCorner(side);
    corner.point = SimplexPoint::between(i, j, corners[i][plane.axis] - at,
                                         corners[j][plane.axis] - at);
  } else {
    LatticeTet moved = corners;
    for (LatticePoint& p : moved) p[plane.axis] -= at;
    corner.point = crossingOfFace(moved, oppositeCorner(side), other);
  }
  corner.at[other] = placeOf(corner.point, corners, other, unit);
  return corner;
}

Slice clipped(const Slice& slice, const HalfPlane& plane, const LatticeTet& corners,
              std::int64_t unit) noexcept {
  Slice result;
  for (std::size_t i = 0; i < slice.size(); ++i) {
    const SliceCorner& from = slice[i];
    const SliceCorner& to = slice[(i + 1) % slice.size()];
    const int atFrom = plane.side(from);
    const int atTo = plane.side(to);
    if (atFrom >= 0) {
      result.add(from);
      // What is cut off behind a corner on the border leaves a side along the border.
      if (atFrom == 0 && atTo <= 0) result[result.size() - 1].side = plane.label;
    }
    if (atFrom * atTo < 0) {
      result.add(crossing(plane, from.side, corners, unit));
      if (atTo < 0) result[result.size() - 1].side = plane.label;
    }
  }
  return result;
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
  constexpr std::array<HalfPlane, 4> kHalfPlanes = {{{1, SquareSide::AtZero, kSquareSide},
                                                     {0, SquareSide::AtOne, kSquareSide + 1},
                                                     {1, SquareSide::AtOne, kSquareSide + 2},
                                                     {0, SquareSide::AtZero, kSquareSide + 3}}};
  Slice slice = carrier == kWholeTet ? outlineOfTet(corners, unit)
                                     : outlineOfFace(corners, carrier, unit);
  for (const HalfPlane& plane : kHalfPlanes) {
    bool cut = false;
    for (std::size_t i = 0; i < slice.size(); ++i) cut = cut || plane.side(slice[i]) <= 0;
    if (cut) slice = clipped(slice, plane, corners, unit);
    if (slice.size() < 3) return slice;
  }
  return slice;
}

}  // namespace hexhex
