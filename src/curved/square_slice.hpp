// The part of a unit square that lies in a tet, by signs of exact expressions alone.
//
// All coordinates are those of the square's frame: it lies in the plane where coordinate 2 is 0,
// and coordinates 0 and 1 run from 0 to the unit.
#pragma once

#include <array>
#include <cstdint>

#include <lattice/tet_geometry.hpp>

namespace hexhex {

/// Where a coordinate is with respect to the unit interval.
enum class SquareSide : std::uint8_t { Below, AtZero, Inside, AtOne, Above };

/// Sides of the square, counter-clockwise: side i runs from its corner i to corner i + 1. As labels
/// of sides of a slice they stand behind the simplices of a tet.
inline constexpr std::uint8_t kSquareSide = 16;

struct SliceCorner {
  /// The simplex of the tet that holds the corner; of no meaning at corners of the square.
  CornerMask simplex;
  std::array<SquareSide, 2> at;
  /// What the side from here to the next corner runs along: a simplex of the tet (a face, or an
  /// edge in the square's plane), or kSquareSide + i.
  std::uint8_t side;

  [[nodiscard]] bool onBorder(std::size_t axis) const noexcept {
    return at[axis] == SquareSide::AtZero || at[axis] == SquareSide::AtOne;
  }
  /// The corner of the square, if it is on both borders.
  [[nodiscard]] std::size_t squareCorner() const noexcept {
    const bool x = at[0] == SquareSide::AtOne;
    const bool y = at[1] == SquareSide::AtOne;
    return y ? (x ? 2 : 3) : (x ? 1 : 0);
  }
  /// The side of the square, if it is on one border.
  [[nodiscard]] std::size_t squareSide() const noexcept {
    if (at[1] == SquareSide::AtZero) return 0;
    if (at[0] == SquareSide::AtOne) return 1;
    return at[1] == SquareSide::AtOne ? 2 : 3;
  }
};

/// A convex polygon, counter-clockwise; at most four corners and one more per side of the square.
class Slice {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] const SliceCorner& operator[](std::size_t i) const noexcept { return corners_[i]; }
  [[nodiscard]] SliceCorner& operator[](std::size_t i) noexcept { return corners_[i]; }
  void add(const SliceCorner& corner) noexcept { corners_[size_++] = corner; }

 private:
  std::array<SliceCorner, 8> corners_;
  std::uint32_t size_ = 0;
};

/// The simplex of a tet whose interior the plane meets in an area: the tet itself, a face that lies
/// in the plane, or none.
[[nodiscard]] CornerMask carrierOfPlane(const LatticeTet& corners) noexcept;

/// The part of the square in the closure of such a simplex; less than three corners if it has no
/// area.
[[nodiscard]] Slice sliceSquare(const LatticeTet& corners, CornerMask carrier,
                                std::int64_t unit) noexcept;

}  // namespace hexhex
