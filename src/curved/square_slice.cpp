#include <algorithm>
#include <cmath>

#include <curved/simplex_point.hpp>
#include <curved/square_slice.hpp>

namespace hexhex::curved {

namespace {

/// Where the line of a side of the square crosses a side of a section.
struct BorderIntersection {
  BorderFlags borders;  ///< exact; on the border that belongs to the line
  Half half;            ///< of the border
};

class Intersections {
 public:
  Intersections(const SeenTet& tet, const Section& section, std::int64_t unit) noexcept
      : tet_(tet),
        section_(section),
        unit_(unit),
        one_(static_cast<double>(unit)),
        error_(kError * tet.reach * tet.reach) {}

  /// @param side  of the section; its ends are on opposite sides of the line
  [[nodiscard]] BorderIntersection operator()(std::size_t side, std::size_t border) const noexcept {
    const std::size_t across = axisAcross(border);
    const std::size_t along = 1 - across;
    const double line = std::array<double, 2>{0, one_}[boundsAtOne(border) ? 1 : 0];
    const std::array<double, 2>& from = section_.points[side].at;
    const std::array<double, 2>& to = section_.points[section_.next(side)].at;
    const double fromLine = from[across] - line;
    const double toLine = to[across] - line;
    const double width = one_ * (toLine - fromLine);
    const double sum = from[along] * toLine - to[along] * fromLine;
    const double beyond = sum - width;
    const double beyondHalf = sum + beyond;
    const double least = std::min(std::abs(width), std::min(std::abs(sum), std::abs(beyond)));
    if (!(least > error_)) return {exactBorders(section_.sideSimplex(side), border), Half::Unknown};
    const bool forward = width > 0;
    const bool isAboveZero = (sum > 0) == forward;
    const bool isAboveOne = (beyond > 0) == forward;
    // Sides 2 and 3 run backward.
    const bool isSecond = ((beyondHalf > 0) == forward) == (border < 2);
    const bool isUnknown = std::abs(beyondHalf) <= 2 * error_;
    return {static_cast<BorderFlags>(onBorder(border) |
                                     bordersOfCertain(along, isAboveZero, isAboveOne)),
            static_cast<Half>(isUnknown ? 2 : int{isSecond})};
  }

 private:
  /// Flags of the point where a face, or an edge in the plane, crosses the line.
  [[nodiscard]] BorderFlags exactBorders(lattice::CornerMask simplex,
                                         std::size_t border) const noexcept {
    const std::size_t across = axisAcross(border);
    const std::size_t along = 1 - across;
    lattice::LatticeTet moved = tet_.corners;
    if (boundsAtOne(border)) {
      for (lattice::LatticePoint& corner : moved) corner[across] -= unit_;
    }
    SimplexPoint point;
    if (lattice::dimension(simplex) == 1) {
      const std::size_t i = lattice::firstCorner(simplex);
      const std::size_t j = lattice::lastCorner(simplex);
      point = SimplexPoint::between(i, j, moved[i][across], moved[j][across]);
    } else {
      point = intersectionWithFace(moved, lattice::oppositeCorner(simplex), along);
    }
    return static_cast<BorderFlags>(
        onBorder(border) |
        bordersBySigns(along, point.compare(moved, along, 0), point.compare(moved, along, unit_)));
  }

  // In units of 2^-53, with R for the reach: points have errors of 8 R; distances from the line, up
  // to 2 R, 8 + 2 = 10 R; products 10 + 16 + 2 = 28 R^2; their difference `sum` 56 + 4 = 60 R^2;
  // the width 20 + 4 = 24 R; `beyond` 60 + 24 + 8 = 92 R^2; `beyondHalf` 60 + 92 + 12 = 164 R^2.
  // 2^-45 R^2 and 2^-44 R^2 leave factors of more than 2 and 3.
  static constexpr double kError = 0x1p-45;

  const SeenTet& tet_;
  const Section& section_;
  std::int64_t unit_;
  double one_;
  double error_;
};

/// Clips a section by one side of the square after another (Sutherland and Hodgman, "Reentrant
/// polygon clipping", 1974).
class Clipper {
 public:
  Clipper(const SeenTet& tet, const Section& section, std::int64_t unit) noexcept
      : section_(section), intersections_(tet, section, unit) {}

  /// Clips a slice by the half plane on the inner side of one side of the square.
  void clip(Slice& slice, std::size_t border) const noexcept {
    unsigned out = 0;
    unsigned on = 0;
    for (std::size_t i = 0; i < slice.size(); ++i) {
      const unsigned borders = unsigned{slice[i].borders} >> border;
      out |= (borders & 1U) << i;
      on |= ((borders >> 4) & 1U) << i;
    }
    if ((out | on) == 0) return;
    const auto label = static_cast<std::uint8_t>(kSquareSide + border);
    const auto at = [&](std::size_t i) {
      return ((out >> i) & 1U) != 0 ? -1 : (((on >> i) & 1U) != 0 ? 0 : 1);
    };
    Slice result;
    for (std::size_t i = 0; i < slice.size(); ++i) {
      const int here = at(i);
      const int next = at(slice.next(i));
      if (here >= 0) {
        result.add(slice[i]);
        // The part cut off after a corner on the border is replaced by a side along the border.
        if (here == 0 && next <= 0) result[result.size() - 1].side = label;
      }
      if (here * next < 0) {
        result.add(intersection(slice[i].side, border));
        if (next < 0) result[result.size() - 1].side = label;
      }
    }
    slice = result;
  }

 private:
  /// Where the line crosses a side between its ends.
  [[nodiscard]] SliceCorner intersection(std::uint8_t side, std::size_t border) const noexcept {
    if (side >= kSquareSide) {  // a corner of the square
      const auto borders =
          static_cast<BorderFlags>(onBorder(border) | onBorder(side - kSquareSide));
      return {kNoPoint, lattice::kNoSimplex, borders, side};
    }
    return {kNoPoint, section_.sideSimplex(side), intersections_(side, border).borders, side};
  }

  const Section& section_;
  Intersections intersections_;
};

/// Cuts the sides of a section one by one; the section must have no corner on a line.
class SideCutter {
 public:
  SideCutter(const SeenTet& tet, const Section& section, std::int64_t unit) noexcept
      : section_(section), intersections_(tet, section, unit) {}

  /// @return false if an intersection is also on another line
  [[nodiscard]] bool cut(std::size_t side, SideCut& cut) const noexcept {
    const unsigned from = section_.points[side].borders;
    const unsigned to = section_.points[section_.next(side)].borders;
    cut = {(from & to) == 0, kUncut, kUncut, Half::Unknown, Half::Unknown};
    if ((from | to) == 0 || !cut.exists) return true;
    return cutEnd(side, from, cut.exists, cut.begin, cut.beginHalf) &&
           cutEnd(side, to, cut.exists, cut.end, cut.endHalf);
  }

 private:
  /// Finds the border that cuts off an end.
  /// @param beyond  the lines (a bit each) beyond which the end lies
  [[nodiscard]] bool cutEnd(std::size_t side, unsigned beyond, bool& exists, std::uint8_t& border,
                            Half& half) const noexcept {
    if (beyond == 0 || !exists) return true;
    for (unsigned open = beyond; open != 0; open &= open - 1) {
      const auto line = static_cast<std::uint8_t>(std::countr_zero(open));
      const BorderIntersection at = intersections_(side, line);
      if (at.borders == onBorder(line)) {
        border = line;
        half = at.half;
        return true;
      }
      if ((at.borders & ~unsigned{onBorder(line)}) >= 16) return false;
      // If the point is beyond another line than the end is, the side misses the square.
      if ((at.borders & beyond) == 0) break;
    }
    exists = false;
    return true;
  }

  const Section& section_;
  Intersections intersections_;
};

/// Adds the corners of the square between two points of its border.
void addCorners(Slice& slice, std::size_t fromSide, std::size_t toSide) noexcept {
  while (fromSide != toSide) {
    fromSide = (fromSide + 1) % 4;
    const unsigned bit = 1U << slice.size();
    slice.borderSides = static_cast<std::uint8_t>(slice.borderSides | bit);
    slice.squareCorners = static_cast<std::uint8_t>(slice.squareCorners | bit);
    slice.add({kNoPoint, lattice::kNoSimplex,
               static_cast<BorderFlags>(onBorder(fromSide) | onBorder((fromSide + 3) % 4)),
               static_cast<std::uint8_t>(kSquareSide + fromSide)});
  }
}

/// Notes the midpoints between two points of the square's border.
void noteMidpoints(Slice& slice, const SideCut& exit, const SideCut& entry) noexcept {
  unsigned certain = 0;
  unsigned possible = 0;
  if (exit.end == entry.begin) {
    certain = unsigned{exit.endHalf == Half::First && entry.beginHalf == Half::Second} << exit.end;
    possible = unsigned{exit.endHalf == Half::Unknown || entry.beginHalf == Half::Unknown}
               << exit.end;
  } else {
    for (std::size_t i = (exit.end + 1U) % 4; i != entry.begin; i = (i + 1) % 4) certain |= 1U << i;
    certain |= unsigned{exit.endHalf == Half::First} << exit.end;
    certain |= unsigned{entry.beginHalf == Half::Second} << entry.begin;
    possible = (unsigned{exit.endHalf == Half::Unknown} << exit.end) |
               (unsigned{entry.beginHalf == Half::Unknown} << entry.begin);
  }
  slice.midpoints = static_cast<std::uint8_t>(slice.midpoints | certain);
  slice.possibleMidpoints = static_cast<std::uint8_t>(slice.possibleMidpoints | possible);
}

/// Joins what is inside the square of a section's sides; makes no corners if nothing is inside.
void join(const Section& section, SectionCuts& cuts, Slice& slice) noexcept {
  slice.clear();
  const SideCut* first = nullptr;
  const SideCut* last = nullptr;
  unsigned pointsBelow = 0;  // of the section, before the first side
  for (std::size_t k = 0; k < section.size; ++k) {
    const SideCut& cut = cuts.sides[k];
    if (first == nullptr && k > 0) pointsBelow |= section.points[k].borders & 1U;
    if (!cut.exists) continue;
    const auto side = static_cast<std::uint8_t>(k);
    if (cut.begin != kUncut && first != nullptr) {
      addCorners(slice, last->end, cut.begin);
      noteMidpoints(slice, *last, cut);
    }
    cuts.corner[k] = static_cast<std::uint8_t>(slice.size());
    if (cut.begin == kUncut) {
      slice.add({side, section.points[k].simplex, 0, side});
    } else {
      slice.add({kNoPoint, section.sideSimplex(k), onBorder(cut.begin), side});
    }
    if (cut.end != kUncut) {
      slice.borderSides = static_cast<std::uint8_t>(slice.borderSides | (1U << slice.size()));
      slice.add({kNoPoint, section.sideSimplex(k), onBorder(cut.end),
                 static_cast<std::uint8_t>(kSquareSide + cut.end)});
    }
    if (first == nullptr) first = &cut;
    last = &cut;
  }
  if (first == nullptr || first->begin == kUncut) return;
  // After the last side, the slice follows the border to the first side.
  const std::uint8_t exit = last->end;
  const std::uint8_t entry = first->begin;
  noteMidpoints(slice, *last, *first);
  // Clipping by one side of the square after another starts at corner 0 of the square instead of
  // the first side, if it passes that corner and if the section, on its part from point 0, crosses
  // the line of side 0 from above: the point where clipping starts, which ends up beyond side 3,
  // then comes before that line.
  if (entry >= exit || pointsBelow == 0 || (section.points[0].borders & 1U) != 0) {
    addCorners(slice, exit, entry);
    return;
  }
  const Slice sides = slice;
  slice.clear();
  addCorners(slice, 3, entry);
  slice.midpoints = sides.midpoints;
  slice.possibleMidpoints = sides.possibleMidpoints;
  slice.borderSides =
      static_cast<std::uint8_t>(slice.borderSides | (sides.borderSides << slice.size()));
  slice.squareCorners =
      static_cast<std::uint8_t>(slice.squareCorners | (sides.squareCorners << slice.size()));
  for (std::uint8_t& corner : cuts.corner)
    corner = static_cast<std::uint8_t>(corner + slice.size());
  for (std::size_t i = 0; i < sides.size(); ++i) slice.add(sides[i]);
  addCorners(slice, exit, 3);
}

/// A section inside the open square.
void takeWhole(const Section& section, SectionCuts& cuts, Slice& slice) noexcept {
  slice.clear();
  for (std::size_t k = 0; k < section.size; ++k) {
    const auto side = static_cast<std::uint8_t>(k);
    slice.add({side, section.points[k].simplex, 0, side});
    cuts.sides[k] = {true, kUncut, kUncut, Half::Unknown, Half::Unknown};
    cuts.corner[k] = side;
  }
  cuts.areKnown = true;
}

}  // namespace

Slice clipSquare(const SeenTet& tet, const Section& section, std::int64_t unit) noexcept {
  Slice slice;
  unsigned borders = 0;
  for (std::size_t k = 0; k < section.size; ++k) {
    const SectionPoint& point = section.points[k];
    const auto index = static_cast<std::uint8_t>(k);
    slice.add({index, point.simplex, point.borders, index});
    borders |= point.borders;
  }
  // Corners made by clipping lie between others, so no further half planes are needed for them.
  const Clipper clipper(tet, section, unit);
  for (std::size_t i = 0; i < 4 && slice.size() > 2; ++i) {
    if ((((borders | (borders >> 4)) >> i) & 1U) != 0) clipper.clip(slice, i);
  }
  slice.borders = static_cast<BorderFlags>(borders);
  unsigned midpoints = 0;
  unsigned borderSides = 0;
  unsigned squareCorners = 0;
  for (std::size_t i = 0; i < slice.size(); ++i) {
    squareCorners |= unsigned{slice[i].isSquareCorner()} << i;
    if (slice[i].side < kSquareSide) continue;
    borderSides |= 1U << i;
    midpoints |= 1U << (slice[i].side - kSquareSide);
  }
  slice.possibleMidpoints = static_cast<std::uint8_t>(midpoints);
  slice.borderSides = static_cast<std::uint8_t>(borderSides);
  slice.squareCorners = static_cast<std::uint8_t>(squareCorners);
  return slice;
}

void sliceSquare(const SeenTet& tet, const Section& section, std::int64_t unit,
                 const KnownCut& known, SectionCuts& cuts, Slice& slice) noexcept {
  cuts.areKnown = false;
  unsigned borders = 0;
  for (std::size_t k = 0; k < section.size; ++k) borders |= section.points[k].borders;
  if (borders == 0) return takeWhole(section, cuts, slice);
  bool isGeneral = borders < 16;
  const SideCutter cutter(tet, section, unit);
  for (std::size_t k = 0; k < section.size && isGeneral; ++k) {
    if (k == known.side) {
      cuts.sides[k] = known.cut;
    } else {
      isGeneral = cutter.cut(k, cuts.sides[k]);
    }
  }
  if (isGeneral) {
    join(section, cuts, slice);
    slice.borders = static_cast<BorderFlags>(borders);
    cuts.areKnown = slice.size() != 0;
  }
  // It also happens that no side meets the square: when the square is inside the section, or beside
  // it.
  if (!cuts.areKnown) slice = clipSquare(tet, section, unit);
}

}  // namespace hexhex::curved
