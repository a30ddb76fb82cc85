// The part of a unit square that lies in a tet, determined only by signs of exact expressions.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>

#include <curved/plane_section.hpp>

namespace hexhex::curved {

/// Labels of sides of a slice: sides of its section, then sides of the square.
inline constexpr std::uint8_t kSquareSide = 4;

/// `point` of a corner that is no point of the section.
inline constexpr std::uint8_t kNoPoint = 4;

struct alignas(4) SliceCorner {
  std::uint8_t point;  ///< of the section; kNoPoint where the square's border cuts the section
  /// The simplex of the tet that holds the corner; meaningless at corners of the square.
  lattice::CornerMask simplex;
  BorderFlags borders;
  /// What the side from here to the next corner runs along: k for side k of the section,
  /// kSquareSide + i for side i of the square.
  std::uint8_t side;

  [[nodiscard]] bool isOnBorder() const noexcept { return borders >= 16; }
  /// Whether it is on two borders.
  [[nodiscard]] bool isSquareCorner() const noexcept {
    const unsigned on = unsigned{borders} >> 4;
    return (on & (on - 1)) != 0;
  }
  /// In that case: the corner of the square, between sides i - 1 and i.
  [[nodiscard]] std::size_t squareCorner() const noexcept {
    constexpr std::array<std::uint8_t, 16> kCorners = {0, 0, 0, 1, 0, 0, 2, 0,
                                                       0, 0, 0, 0, 3, 0, 0, 0};
    return kCorners[borders >> 4];
  }
  /// The side of the square, if the corner is on one border.
  [[nodiscard]] std::size_t squareSide() const noexcept {
    return static_cast<std::size_t>(std::countr_zero(unsigned{borders} >> 4));
  }
};

/// A convex polygon, counter-clockwise; at most four corners plus one per side of the square.
class Slice {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] const SliceCorner& operator[](std::size_t i) const noexcept { return corners_[i]; }
  [[nodiscard]] SliceCorner& operator[](std::size_t i) noexcept { return corners_[i]; }
  [[nodiscard]] std::size_t next(std::size_t i) const noexcept { return i + 1 < size_ ? i + 1 : 0; }
  void clear() noexcept {
    size_ = 0;
    borders = midpoints = possibleMidpoints = borderSides = squareCorners = 0;
  }
  void add(const SliceCorner& corner) noexcept {
    assert(size_ < corners_.size());
    corners_[size_++] = corner;
  }

  /// Sides of the square beyond which the section extends (bit i), or that it touches from inside
  /// (bit 4 + i).
  BorderFlags borders = 0;
  /// The sides of the square (a bit each) whose midpoints are certainly in the interior of the
  /// sliced simplex, and those whose midpoints may be anywhere in it.
  std::uint8_t midpoints = 0;
  std::uint8_t possibleMidpoints = 0;
  /// The corners (a bit each) whose sides run along the square's sides.
  std::uint8_t borderSides = 0;
  /// The corners (a bit each) that are corners of the square.
  std::uint8_t squareCorners = 0;

 private:
  std::array<SliceCorner, 8> corners_;
  std::uint32_t size_ = 0;
};

/// Position of a point on a side of the square relative to its midpoint, in the direction of the
/// border.
enum class Half : std::uint8_t { First, Second, Unknown };

/// The part of a section's side inside the open square.
struct SideCut {
  bool exists = false;
  // Per end: the side of the square that cuts the section's side there, or kUncut, and in which
  // half.
  std::uint8_t begin = 0;
  std::uint8_t end = 0;
  Half beginHalf = Half::Unknown;
  Half endHalf = Half::Unknown;

  /// The same, seen from the other side.
  [[nodiscard]] SideCut reversed() const noexcept {
    return {exists, end, begin, endHalf, beginHalf};
  }
};
inline constexpr std::uint8_t kUncut = 4;

/// What is known about the sides of a section.
struct SectionCuts {
  std::array<SideCut, 4> sides;
  std::array<std::uint8_t, 4> corner;  ///< per existing side: the corner of the slice before it
  bool areKnown = false;  ///< all of this; never where a corner or an intersection is on two lines
};

/// A side whose cut is known.
struct KnownCut {
  std::size_t side = 4;  ///< 4: none
  SideCut cut = {};
};

/// The part of the square inside a section; fewer than three corners if it has no area. It starts
/// at the section's point 0 if that is in the square, otherwise where clipping by one side of the
/// square after another would start.
/// @param known  one side of the section
/// @param cuts   receives those of all sides, if the slice was found from them
/// @param slice  receives the slice
void sliceSquare(const SeenTet& tet, const Section& section, std::int64_t unit,
                 const KnownCut& known, SectionCuts& cuts, Slice& slice) noexcept;

/// The same by clipping, for sections in any position.
[[nodiscard]] Slice clipSquare(const SeenTet& tet, const Section& section,
                               std::int64_t unit) noexcept;

}  // namespace hexhex::curved
