#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <lattice/half_grids.hpp>

namespace hexhex {

namespace {

constexpr std::array<double, 4> kSteps = {0, 1, 2, 3};

}  // namespace

HalfGrids::HalfGrids(const LatticeTet& corners, std::int64_t unit,
                     const HalfGridSearch& search) noexcept
    : corners_(corners), unit_(unit), box_(corners, unit) {
  if ((box_.steps[0] | box_.steps[1] | box_.steps[2]) < 0) return;  // one of them is
  const std::int32_t most = std::max(std::max(box_.steps[0], box_.steps[1]), box_.steps[2]);
  if (most < HalfGridSearch::kSide) {
    small_ = true;
    const HalfGridSearch::PlaceSet places = search.placesIn(box_);
    if (places == 0) return;
    measure(most);
    comparePoints(places);
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) mayHaveLimits_ |= BoxLimits::mayBeAcross(corners, k);
  occupied_ = static_cast<HalfGridSet>(search.wanted() & box_.grids());
  if (occupied_ != 0 && most < kMostSteps) measure(most);
}

/// Sets the weights.
/// @param most  steps of the box along an axis
void HalfGrids::measure(std::int32_t most) noexcept {
  measured_ = true;
  error_ = WeightField::errorBound(static_cast<double>(most) + 1);
  const double perHalf = 2.0 / static_cast<double>(unit_);
  const Pair scale = {perHalf, perHalf};
  std::array<Pair, 3> of01;
  std::array<Pair, 3> of23;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t zero = box_.first[k] * (unit_ / 2);
    const auto at = [&](std::size_t corner) {
      return static_cast<double>(corners_[corner][k] - zero);
    };
    of01[k] = Pair{at(0), at(1)} * scale;
    of23[k] = Pair{at(2), at(3)} * scale;
  }
  const WeightField field(of01, of23);
  atOrigin_ = field.at({0, 0, 0});
  gradient_ = field.gradient;
}

/// Sets `inside_` and `occupied_`.
void HalfGrids::comparePoints(HalfGridSearch::PlaceSet places) noexcept {
  using PlaceSet = HalfGridSearch::PlaceSet;
  const auto stepsTo = [](unsigned place) {
    return std::array<double, 3>{kSteps[place & 3U], kSteps[(place >> 2) & 3U], kSteps[place >> 4]};
  };
  // Without branches, as what is inside is as good as random.
  PlaceSet inside = 0;
  PlaceSet unsure = 0;
  for (; places != 0; places &= places - 1) {
    const auto place = static_cast<unsigned>(std::countr_zero(places));
    const double least = weightsAt(stepsTo(place)).least();
    inside |= PlaceSet{least >= -error_ ? 1U : 0U} << place;
    unsure |= PlaceSet{least <= error_ ? 1U : 0U} << place;
  }
  for (; inside != 0; inside &= inside - 1) {
    const auto place = static_cast<unsigned>(std::countr_zero(inside));
    const std::array<std::int32_t, 3> steps = {static_cast<std::int32_t>(place & 3U),
                                               static_cast<std::int32_t>((place >> 2) & 3U),
                                               static_cast<std::int32_t>(place >> 4)};
    CornerMask simplex = kWholeTet;
    if (((unsure >> place) & 1U) != 0) simplex = exactSimplexOf(steps);
    if (simplex == kNoSimplex) continue;
    Inside& point = inside_[insideCount_++];
    unsigned grid = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t at = box_.first[k] + steps[k];
      grid |= static_cast<unsigned>(at & 1) << k;
      point.z[k] = at >> 1;
    }
    point.grid = static_cast<HalfGrid>(grid);
    point.simplex = simplex;
    occupied_ = static_cast<HalfGridSet>(occupied_ | halfGridBit(point.grid));
  }
}

/// The simplex whose interior holds a point near some face, or kNoSimplex outside.
/// @param steps  from the box's first point
CornerMask HalfGrids::exactSimplexOf(const std::array<std::int32_t, 3>& steps) const noexcept {
  LatticePoint point;
  for (std::size_t k = 0; k < 3; ++k) {
    point[k] = (std::int64_t{box_.first[k]} + steps[k]) * (unit_ / 2);
  }
  const std::array<double, 4> weights =
      weightsAt({static_cast<double>(steps[0]), static_cast<double>(steps[1]),
                 static_cast<double>(steps[2])})
          .byCorner();
  return simplexBySides([&](std::size_t face) {
    return weights[face] > error_ ? 1 : sideOfFace(corners_, face, point);
  });
}

std::size_t HalfGrids::sortInside(HalfGrid grid, SweepAxes sweepAxes,
                                  SweepPoints& points) const noexcept {
  const std::array<std::uint8_t, 3>& axes = sweepAxes();
  std::size_t count = 0;
  for (std::size_t i = 0; i < insideCount_; ++i) {
    if (inside_[i].grid != grid) continue;
    const GridPoint& z = inside_[i].z;
    const SweepPoint point{{z[axes[0]], z[axes[1]], z[axes[2]]}, inside_[i].simplex};
    std::size_t at = count++;
    for (; at > 0 && point.at < points[at - 1].at; --at) points[at] = points[at - 1];
    points[at] = point;
  }
  return count;
}

/// Of the points of a grid.
BoxLimits HalfGrids::limitsOf(HalfGrid grid, const GridBox& box, SweepAxes axes) const noexcept {
  LatticePoint first;
  LatticePoint last;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t moved = (grid >> k) & 1;
    first[k] = (2 * std::int64_t{box.range[k].first} + moved) * (unit_ / 2);
    last[k] = (2 * std::int64_t{box.range[k].last} + moved) * (unit_ / 2);
  }
  return {corners_, first, last, axes};
}

/// @param limits  faces that are limits of the box, as bits
/// @param steps   from the first to the last point of the lines
HalfGrids::Slopes HalfGrids::slopesAlong(std::size_t axis, unsigned limits,
                                         std::int32_t steps) const noexcept {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr Pair kZero = {0, 0};
  constexpr Pair kAll = {kInfinity, kInfinity};
  Slopes slopes;
  Pair least = kAll;
  for (std::size_t i = 0; i < 2; ++i) {
    const Pair slope = (i == 0 ? gradient_[axis].of01 : gradient_[axis].of23) * Pair{2, 2};
    Pair steepness = magnitudeOf(slope);
    slopes.toZero[i] = Pair{-1, -1} / slope;
    slopes.lowBias[i] = chosen(slope > kZero, kZero, -kAll);
    slopes.highBias[i] = chosen(slope > kZero, kAll, kZero);
    for (std::size_t j = 0; limits != 0 && j < 2; ++j) {
      if (((limits >> (2 * i + j)) & 1U) == 0) continue;
      steepness[j] = kInfinity;
      slopes.toZero[i][j] = 0;
      slopes.lowBias[i][j] = -kInfinity;
      slopes.highBias[i][j] = kInfinity;
    }
    least = smaller(steepness, least);
  }
  const double leastSlope = std::min(least[0], least[1]);
  // Errors of weights at a line's first point, and of slopes on the way from there, make less than
  // 2 error_: zeros are known to an eighth.
  constexpr double kClearSlope = 16;
  slopes.areClear = leastSlope > kClearSlope * error_;
  const auto last = static_cast<double>(steps);
  // First points end up in the box, or behind it; last points in the box, or before it, so that
  // empty lines stay empty. No limit is an integer, lest it be mistaken for a zero near one.
  slopes.least = Pair{-0.5, -1.5};
  slopes.most = Pair{last + 1.5, last + 0.5};
  // Besides, the roundings of the zero itself and on its way to an integer.
  slopes.zeroError = 2 * error_ / leastSlope + 0x1p-48 * (last + 16);
  return slopes;
}

/// The first and the last point of a line; the other way round if there are none.
/// @param weights  at its first point in the box
/// @param unsure   gets bits if it cannot tell
IntPair HalfGrids::runOf(const Weights& weights, const Slopes& slopes, IntPair& unsure) noexcept {
  const Pair zero01 = weights.of01 * slopes.toZero[0];
  const Pair zero23 = weights.of23 * slopes.toZero[1];
  const Pair lows = larger(zero01 + slopes.lowBias[0], zero23 + slopes.lowBias[1]);
  const Pair highs = smaller(zero01 + slopes.highBias[0], zero23 + slopes.highBias[1]);
  // The largest of the ones and the smallest of the others at once.
  constexpr Pair kSigns = {1, -1};
  const Pair ends =
      kSigns * larger(kSigns * Pair{lows[0], highs[0]}, kSigns * Pair{lows[1], highs[1]});
  // Adding 4 makes truncation a floor. If no integer lies within the bound of either zero, the
  // points strictly between them are all inside the tet, and no others are in it.
  const Pair clamped = smaller(larger(ends, slopes.least), slopes.most) + Pair{4, 4};
  const Pair error = {slopes.zeroError, slopes.zeroError};
  const IntPair from = __builtin_convertvector(clamped - error, IntPair);
  const IntPair to = __builtin_convertvector(clamped + error, IntPair);
  unsure |= from ^ to;
  return from - IntPair{3, 4};
}

bool HalfGrids::findLines(HalfGrid grid, const GridBox& box, SweepAxes sweepAxes,
                          Lines& lines) const noexcept {
  const std::array<std::uint8_t, 3>& axes = sweepAxes();
  std::array<std::int32_t, 3> size;  // steps, by sweep axis
  std::array<double, 3> toFirst;     // from the first point of the box, by axis
  for (std::size_t k = 0; k < 3; ++k) {
    const GridRange& range = box.range[axes[k]];
    size[k] = range.last - range.first;
    toFirst[axes[k]] =
        static_cast<double>(2 * range.first + ((grid >> axes[k]) & 1) - box_.first[axes[k]]);
  }
  if (!measured_ || (std::int64_t{size[0]} + 1) * (std::int64_t{size[1]} + 1) > kMostLines) {
    return false;
  }
  if (mayHaveLimits_) lines.limits = limitsOf(grid, box, sweepAxes);
  const Slopes slopes = slopesAlong(axes[2], lines.limits.faces, size[2]);
  if (!slopes.areClear) return false;
  IntPair unsure = {0, 0};
  Run* end = lines.runs.data();
  Weights atLevel = weightsAt(toFirst);
  for (std::int32_t level = 0; level <= size[0]; ++level) {
    Weights weights = atLevel;
    for (std::int32_t row = 0; row <= size[1]; ++row) {
      const IntPair run = runOf(weights, slopes, unsure);
      // Without a branch, as which lines have points is as good as random.
      *end = {level, row, run[0], run[1]};
      end += run[0] <= run[1] ? 1 : 0;
      weights = weights.plus(gradient_[axes[1]], 2);
    }
    atLevel = atLevel.plus(gradient_[axes[0]], 2);
  }
  lines.count = static_cast<std::size_t>(end - lines.runs.data());
  return (unsure[0] | unsure[1]) == 0;
}

LatticeTet HalfGrids::movedBack(HalfGrid grid) const noexcept {
  LatticeTet back = corners_;
  for (LatticePoint& corner : back) {
    for (std::size_t k = 0; k < 3; ++k) corner[k] -= ((grid >> k) & 1) != 0 ? unit_ / 2 : 0;
  }
  return back;
}

}  // namespace hexhex
