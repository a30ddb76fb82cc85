// Grid points of a tet one by one, where its box has few: signs by a filter, then exactly (for
// Section 5.2).
#include <algorithm>
#include <bit>

#include <base/low_level.hpp>
#include <lattice/few_points.hpp>

namespace hexhex::lattice {

namespace {

/// Doubles represent all integers up to here.
constexpr double kMostExact = 0x1p53;

/// Boxes with more half units than this along an axis hold more than kFewPoints points.
constexpr double kManySteps = 64;

constexpr double lengthOfHalf(std::int64_t unit) noexcept { return 2 / static_cast<double>(unit); }

/// Error bound of the weight at a first point, or fewer than 64 whole-unit steps away from it.
/// @param size  bounds the distance of corners from all these points, per axis; corners and first
///              points may carry one rounding of such a distance
constexpr double errorBound(double size) noexcept {
  // Errors in units of u = 2^-53, with magnitudes: edges, up to 2 size, are off by at most 4 size;
  // products of two of them by 20 size^2, and their differences, the gradients, up to 8 size^2, by
  // 48 size^2. At the first point, three products with distances, each up to 8 size^3 and off by 72
  // size^3, add up to a weight in two additions of at most 24 size^3: off by 264 size^3. From there
  // to any other point, there are three more products, each up to 8 size^3 and off by 56 size^3,
  // and 3 additions of at most 48 size^3, or fewer than 64 if it is done step by step: below 264 +
  // 168 + 64 * 48 < 2^12 size^3. 2^13 covers second-order terms as well.
  return 0x1p-40 * size * size * size;
}

CornerWeights sumOf(const CornerWeights& a, const CornerWeights& b) noexcept {
  return {a.of01 + b.of01, a.of23 + b.of23};
}

}  // namespace

HalvedTet::HalvedTet(const LatticeTet& corners, double perHalf) noexcept {
  std::array<Pair, 3> low;
  std::array<Pair, 3> high;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = [&](std::size_t corner) { return static_cast<double>(corners[corner][k]); };
    of01[k] = Pair{at(0), at(1)} * Pair{perHalf, perHalf};
    of23[k] = Pair{at(2), at(3)} * Pair{perHalf, perHalf};
    low[k] = smaller(of01[k], of23[k]);
    high[k] = larger(of23[k], of01[k]);  // in this order, each is one instruction
  }
  // All as upper bounds: of x and y, of -x and -y, and of z and -z.
  const Pair beforeXy = -smaller(Pair{low[0][0], low[1][0]}, Pair{low[0][1], low[1][1]});
  const Pair afterXy = larger(Pair{high[0][0], high[1][0]}, Pair{high[0][1], high[1][1]});
  const Pair aroundZ = larger(Pair{-low[2][0], high[2][0]}, Pair{-low[2][1], high[2][1]});
  const Pair minusFirstXy = floorOf(beforeXy);
  const Pair lengthXy = floorOf(afterXy) + minusFirstXy;
  const Pair endsZ = floorOf(aroundZ);
  const double lengthZ = endsZ[0] + endsZ[1];
  firstXy = -truncated<IntPair>(minusFirstXy);
  firstZ = -static_cast<std::int32_t>(endsZ[0]);
  stepsXy = truncated<IntPair>(lengthXy);
  stepsZ = static_cast<std::int32_t>(lengthZ);
  mostSteps = std::max(std::max(lengthXy[0], lengthXy[1]), lengthZ);
  const Pair bounds = larger(larger(beforeXy, afterXy), aroundZ);
  largest = std::max(bounds[0], bounds[1]);
}

double CornerWeights::least() const noexcept {
  const Pair lower = smaller(of01, of23);
  return lower[0] < lower[1] ? lower[0] : lower[1];
}

WeightField::WeightField(const HalvedTet& tet) noexcept {
  const std::array<Pair, 3>& of01 = tet.of01;
  const std::array<Pair, 3>& of23 = tet.of23;
  // Normals are cross products of two edges of a face; faces 0 and 1 are those opposite corners 0
  // and 1, and so on.
  std::array<Pair, 3> first01;
  std::array<Pair, 3> second01;
  std::array<Pair, 3> first23;
  std::array<Pair, 3> second23;
  for (std::size_t k = 0; k < 3; ++k) {
    const Pair c10 = {of01[k][1], of01[k][0]};
    const Pair c00 = {of01[k][0], of01[k][0]};
    first01[k] = Pair{of23[k][1], of23[k][0]} - c10;
    second01[k] = of23[k] - c10;
    first23[k] = Pair{of23[k][1], of01[k][1]} - c00;
    second23[k] = Pair{of01[k][1], of23[k][0]} - c00;
    zero[k] = {c10, c00};
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t m = k == 2 ? 0 : k + 1;
    const std::size_t n = k == 0 ? 2 : k - 1;
    gradient[k].of01 = first01[m] * second01[n] - first01[n] * second01[m];
    gradient[k].of23 = first23[m] * second23[n] - first23[n] * second23[m];
  }
}

CornerWeights WeightField::at(const std::array<double, 3>& point) const noexcept {
  CornerWeights weights;
  for (std::size_t k = 0; k < 3; ++k) {
    const Pair coordinate = {point[k], point[k]};
    const Pair term01 = gradient[k].of01 * (coordinate - zero[k].of01);
    const Pair term23 = gradient[k].of23 * (coordinate - zero[k].of23);
    weights = k == 0 ? CornerWeights{term01, term23}
                     : CornerWeights{weights.of01 + term01, weights.of23 + term23};
  }
  return weights;
}

FewPoints::FewPoints(const LatticeTet& corners, std::int64_t unit) noexcept
    : corners_(corners), unit_(unit), halved_(corners, lengthOfHalf(unit)) {
  areFew_ = halved_.largest < kMostExact * lengthOfHalf(unit) && halved_.mostSteps < kManySteps;
  // Sizes of the grid that has the most points along each axis.
  const IntPair mostXy = (halved_.stepsXy + 2) >> 1;
  const std::int32_t mostZ = (halved_.stepsZ + 2) >> 1;
  areFew_ = areFew_ && mostXy[0] * mostXy[1] * mostZ <= kFewPoints;
}

FewPoints::Points FewPoints::pointsOf(HalfGrid grid) const noexcept {
  // In half units, vertices have even coordinates.
  const IntPair skippedXy = (halved_.firstXy ^ IntPair{grid & 1, (grid >> 1) & 1}) & 1;
  const std::int32_t skippedZ = (halved_.firstZ ^ (grid >> 2)) & 1;
  return {halved_.firstXy + skippedXy, halved_.firstZ + skippedZ,
          (halved_.stepsXy + 2 - skippedXy) >> 1, (halved_.stepsZ + 2 - skippedZ) >> 1};
}

std::size_t FewPoints::find(HalfGrid grid, Lines& lines) noexcept {
  const Points points = pointsOf(grid);
  const std::int32_t all = points.all();
  if (all == 0) return 0;
  if (!measured_) {
    field_ = WeightField(halved_);
    error_ = errorBound(halved_.mostSteps + 1);
    measured_ = true;
  }
  WeightsOf weights;  // NOLINT: written before it is read
  weights[0] =
      field_.at({static_cast<double>(points.firstXy[0]), static_cast<double>(points.firstXy[1]),
                 static_cast<double>(points.firstZ)});
  if (all == 1) {
    return weights[0].least() >= -error_ ? findOne(points, {}, weights[0], {}, lines[0]) : 0;
  }
  weigh(points, weights);
  const std::uint32_t found = candidates(weights, all);
  return found == 0 ? 0 : findCandidates(points, weights, found, lines);
}

/// Each axis multiplies the number of points so far.
/// @param weights  holds the weights of the first point
void FewPoints::weigh(const Points& points, WeightsOf& weights) const noexcept {
  CornerWeights* end = weights.data() + 1;
  const auto multiply = [&](std::int32_t count, const CornerWeights& half) {
    if (count == 1) return;
    const CornerWeights step = sumOf(half, half);
    const CornerWeights* from = weights.data();
    for (const CornerWeights* const last = from + (end - from) * count; end != last; ++end) {
      *end = sumOf(*from++, step);
    }
  };
  multiply(points.countZ, field_.gradient[2]);
  multiply(points.countXy[1], field_.gradient[1]);
  multiply(points.countXy[0], field_.gradient[0]);
  *end = end[-1];
}

/// The points that are not certainly outside of any face, as bits.
std::uint32_t FewPoints::candidates(const WeightsOf& weights, std::int32_t points) const noexcept {
  const Pair least = {-error_, -error_};
  PairMask found = {0, 0};
  PairMask bits = {1, 2};
  const CornerWeights* pair = weights.data();
  for (const CornerWeights* const end = pair + points; pair < end; pair += 2, bits <<= 2) {
    const Pair first = smaller(pair[0].of01, pair[0].of23);
    const Pair second = smaller(pair[1].of01, pair[1].of23);
    const Pair both = smaller(Pair{first[0], second[0]}, Pair{first[1], second[1]});
    found |= (both >= least) & bits;
  }
  const std::uint64_t all = (std::uint64_t{1} << points) - 1;
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(found[0] | found[1]) & all);
}

/// The simplex whose interior contains a candidate. Most candidates near faces are corners.
CornerMask FewPoints::simplexOf(const Halves& halves, const CornerWeights& weights) const noexcept {
  if (weights.least() > error_) return kWholeTet;
  // Only an odd unit can make the product odd.
  const LatticePoint point = {halves[0] * unit_ / 2, halves[1] * unit_ / 2, halves[2] * unit_ / 2};
  for (std::size_t i = 0; i < 4; ++i) {
    if (corners_[i] == point) return cornerBit(static_cast<int>(i));
  }
  const std::array<double, 4> byCorner = weights.byCorner();
  return simplexBySides([&](std::size_t face) {
    return byCorner[face] > error_ ? 1 : sideOfFace(corners_, face, point);
  });
}

/// @param at  steps from the first point, per axis
/// @return 1 if the point is in the tet, otherwise 0
std::size_t FewPoints::findOne(const Points& points, const std::array<std::int32_t, 3>& at,
                               const CornerWeights& weights, SweepAxes order,
                               SweptLine& line) const noexcept {
  const Halves halves = points.at(at);
  const CornerMask simplex = simplexOf(halves, weights);
  const std::array<std::uint8_t, 3>& axes = order();
  line = {
      halves[axes[0]] >> 1, halves[axes[1]] >> 1, halves[axes[2]] >> 1, 1, simplex, simplex, order};
  return simplex == kNoSimplex ? 0 : 1;
}

std::size_t FewPoints::findCandidates(const Points& points, const WeightsOf& weights,
                                      std::uint32_t candidates, Lines& lines) const noexcept {
  const std::array<std::int32_t, 3> counts = {points.countXy[0], points.countXy[1], points.countZ};
  const SweepAxes order =
      chooseSweepAxes(GridBox{{{{0, counts[0] - 1}, {0, counts[1] - 1}, {0, counts[2] - 1}}}});
  if (hasOneBit(candidates)) {
    const std::int32_t i = std::countr_zero(candidates);
    const std::int32_t row = i / counts[2];
    return findOne(points, {row / counts[1], row % counts[1], i % counts[2]},
                   weights[static_cast<std::size_t>(i)], order, lines[0]);
  }
  const std::array<std::uint8_t, 3>& axes = order();
  const std::array<std::int32_t, 3> strides = {counts[1] * counts[2], counts[2], 1};
  std::array<std::int32_t, 3> at{};
  const auto forEach = [&](std::size_t k, const auto& visit) {
    for (at[axes[k]] = 0; at[axes[k]] < counts[axes[k]]; ++at[axes[k]]) {
      visit(at[axes[k]] * strides[axes[k]]);
    }
  };
  std::size_t found = 0;
  forEach(0, [&](std::int32_t level) {
    forEach(1, [&](std::int32_t row) {
      SweptLine line{0, 0, 0, 0, kNoSimplex, kNoSimplex, order};
      forEach(2, [&](std::int32_t point) {
        const std::int32_t i = level + row + point;
        if (((candidates >> i) & 1U) == 0) return;
        const Halves halves = points.at(at);
        const CornerMask simplex = simplexOf(halves, weights[static_cast<std::size_t>(i)]);
        if (simplex == kNoSimplex) return;
        // Tets are convex: their points on a line are consecutive.
        if (line.count == 0) {
          line.level = halves[axes[0]] >> 1;
          line.row = halves[axes[1]] >> 1;
          line.first = halves[axes[2]] >> 1;
          line.left = simplex;
        }
        ++line.count;
        line.right = simplex;
      });
      if (line.count > 0) lines[found++] = line;
    });
  });
  return found;
}

}  // namespace hexhex::lattice
