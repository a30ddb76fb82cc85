#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include <base/low_level.hpp>
#include <base/pair.hpp>
#include <lattice/few_points.hpp>

namespace hexhex {

namespace {

/// More points take longer one by one than by lines.
constexpr std::int32_t kFewPoints = 16;

using Halves = std::array<std::int32_t, 3>;

/// Doubles hold integers up to here.
constexpr double kMostExact = 0x1p53;

/// Boxes with more half units than this along an axis have more points.
constexpr double kManySteps = 64;

/// A tet in halves of grid units, and its bounding box in the grid of that width. All is exact if
/// doubles hold the corners.
struct HalvedTet {
  std::array<Pair, 3> of01;  ///< corners, by axis
  std::array<Pair, 3> of23;
  IntPair firstXy;  ///< point of the box
  std::int32_t firstZ;
  IntPair stepsXy;  ///< from the first to the last point; -1 if there are none
  std::int32_t stepsZ;
  double mostSteps;  ///< along an axis
  double largest;    ///< coordinate of a corner

  HalvedTet(const LatticeTet& corners, double perHalf) noexcept {
    std::array<Pair, 3> low;
    std::array<Pair, 3> high;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = [&](std::size_t corner) { return static_cast<double>(corners[corner][k]); };
      of01[k] = Pair{at(0), at(1)} * Pair{perHalf, perHalf};
      of23[k] = Pair{at(2), at(3)} * Pair{perHalf, perHalf};
      low[k] = smaller(of01[k], of23[k]);
      high[k] = larger(of23[k], of01[k]);  // in this order there is an instruction for each
    }
    // All as upper bounds: of x and y, of both negated, and of z and -z.
    const Pair beforeXy = -smaller(Pair{low[0][0], low[1][0]}, Pair{low[0][1], low[1][1]});
    const Pair afterXy = larger(Pair{high[0][0], high[1][0]}, Pair{high[0][1], high[1][1]});
    const Pair aroundZ = larger(Pair{-low[2][0], high[2][0]}, Pair{-low[2][1], high[2][1]});
    const Pair minusFirstXy = floorOf(beforeXy);
    const Pair lengthXy = floorOf(afterXy) + minusFirstXy;
    const Pair endsZ = floorOf(aroundZ);
    const double lengthZ = endsZ[0] + endsZ[1];
    firstXy = -__builtin_convertvector(minusFirstXy, IntPair);
    firstZ = -static_cast<std::int32_t>(endsZ[0]);
    stepsXy = __builtin_convertvector(lengthXy, IntPair);
    stepsZ = static_cast<std::int32_t>(lengthZ);
    mostSteps = std::max(std::max(lengthXy[0], lengthXy[1]), lengthZ);
    const Pair bounds = larger(larger(beforeXy, afterXy), aroundZ);
    largest = std::max(bounds[0], bounds[1]);
  }
};

/// Those of a grid in a bounding box.
struct PointsInBox {
  IntPair firstXy;  ///< in halves
  std::int32_t firstZ;
  IntPair countXy;  ///< along each axis
  std::int32_t countZ;

  /// If there are less than 2^10 along each axis.
  [[nodiscard]] std::int32_t all() const noexcept { return countXy[0] * countXy[1] * countZ; }
  /// A point by steps from the first one, in halves.
  [[nodiscard]] Halves at(const std::array<std::int32_t, 3>& steps) const noexcept {
    return {firstXy[0] + 2 * steps[0], firstXy[1] + 2 * steps[1], firstZ + 2 * steps[2]};
  }
};

/// A number for each corner of a tet.
struct CornerWeights {
  Pair of01;
  Pair of23;

  [[nodiscard]] double least() const noexcept {
    const Pair lower = smaller(of01, of23);
    return lower[0] < lower[1] ? lower[0] : lower[1];
  }
  [[nodiscard]] std::array<double, 4> byCorner() const noexcept {
    return {of01[0], of01[1], of23[0], of23[1]};
  }
};

/// The weights of points, as volumes, in units of a grid: positive inside of the face opposite a
/// corner.
struct WeightField {
  std::array<CornerWeights, 3> gradient;  ///< by axis
  std::array<CornerWeights, 3> zero;      ///< by axis, a point where the weight vanishes

  WeightField() = default;
  /// @param of01,of23  the corners, by axis
  WeightField(const std::array<Pair, 3>& of01, const std::array<Pair, 3>& of23) noexcept {
    // Normals are products of two edges of their faces: of faces 0 and 1 that are opposite corners
    // 0 and 1, and so on.
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

  [[nodiscard]] CornerWeights at(const std::array<double, 3>& point) const noexcept {
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

  /// Of the error of a weight at() a point, or less than 64 steps of whole units from there.
  /// @param size  bounds the distance of corners from all these points, by axis; corners and
  ///              first points may carry one rounding of such a distance
  [[nodiscard]] static constexpr double errorBound(double size) noexcept {
    // Errors in units of u = 2^-53, with magnitudes: edges, up to 2 size, are known to 4 size;
    // products of two of them to 20 size^2, and their differences, the gradients, up to 8 size^2,
    // to 48 size^2. At the first point, three products with distances, each up to 8 size^3 and
    // known to 72 size^3, make up a weight in two additions of at most 24 size^3: known to 264
    // size^3. From there to any other point, there are three more products, each up to 8 size^3 and
    // known to 56 size^3, and 3 additions of at most 48 size^3, or, if it is done step by step,
    // less than 64: below 264 + 168 + 64 * 48 < 2^12 size^3. 2^13 covers terms of second order as
    // well.
    return 0x1p-40 * size * size * size;
  }
};

CornerWeights sumOf(const CornerWeights& a, const CornerWeights& b) noexcept {
  return {a.of01 + b.of01, a.of23 + b.of23};
}

/// Appends lines of one tet.
class FewPoints {
 public:
  FewPoints(const LatticeTet& corners, std::int64_t unit, const HalvedTet& halved) noexcept
      : corners_(corners),
        unit_(unit),
        field_(halved.of01, halved.of23),
        error_(WeightField::errorBound(halved.mostSteps + 1)) {}

  /// @param all  how many there are
  void append(const PointsInBox& points, std::int32_t all, std::vector<SweptLine>& lines) const {
    const CornerWeights first =
        field_.at({static_cast<double>(points.firstXy[0]), static_cast<double>(points.firstXy[1]),
                   static_cast<double>(points.firstZ)});
    if (all > 1) {
      appendSome(points, all, first, lines);
    } else if (first.least() >= -error_) {
      appendOne(points, {}, first, {}, lines);
    }
  }

 private:
  /// Weights of points, the last coordinate changing fastest, and one more.
  using WeightsOf = std::array<CornerWeights, kFewPoints + 1>;

  void appendOne(const PointsInBox& points, const std::array<std::int32_t, 3>& at,
                 const CornerWeights& weights, SweepAxes order,
                 std::vector<SweptLine>& lines) const;
  void appendSome(const PointsInBox& points, std::int32_t all, const CornerWeights& first,
                  std::vector<SweptLine>& lines) const;
  void appendCandidates(const PointsInBox& points, const WeightsOf& weights, std::uint32_t found,
                        std::vector<SweptLine>& lines) const;
  void weigh(const PointsInBox& points, WeightsOf& weights) const noexcept;
  [[nodiscard]] std::uint32_t candidates(const WeightsOf& weights,
                                         std::int32_t points) const noexcept;
  [[nodiscard]] CornerMask simplexOf(const Halves& halves,
                                     const CornerWeights& weights) const noexcept;
  const LatticeTet& corners_;
  std::int64_t unit_;
  WeightField field_;
  double error_;  ///< bound of the error of weights in the box
};

/// Each axis multiplies the points that there are so far.
/// @param weights  those of the first point are known
void FewPoints::weigh(const PointsInBox& points, WeightsOf& weights) const noexcept {
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

/// Which points are not certainly outside of a face, as bits.
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

/// The simplex whose interior contains a candidate. Most of those near faces are corners.
CornerMask FewPoints::simplexOf(const Halves& halves, const CornerWeights& weights) const noexcept {
  if (weights.least() > error_) return kWholeTet;
  // A product may be odd only where the unit is.
  const LatticePoint point = {halves[0] * unit_ / 2, halves[1] * unit_ / 2, halves[2] * unit_ / 2};
  for (std::size_t i = 0; i < 4; ++i) {
    if (corners_[i] == point) return cornerBit(static_cast<int>(i));
  }
  const std::array<double, 4> byCorner = weights.byCorner();
  return simplexBySides([&](std::size_t face) {
    return byCorner[face] > error_ ? 1 : sideOfFace(corners_, face, point);
  });
}

/// @param at  steps from the first point, by axis
void FewPoints::appendOne(const PointsInBox& points, const std::array<std::int32_t, 3>& at,
                          const CornerWeights& weights, SweepAxes order,
                          std::vector<SweptLine>& lines) const {
  const Halves halves = points.at(at);
  const CornerMask simplex = simplexOf(halves, weights);
  if (simplex == kNoSimplex) return;
  const std::array<std::uint8_t, 3>& axes = order();
  lines.push_back({halves[axes[0]] >> 1, halves[axes[1]] >> 1, halves[axes[2]] >> 1, 1, simplex,
                   simplex, order});
}

void FewPoints::appendSome(const PointsInBox& points, std::int32_t all, const CornerWeights& first,
                           std::vector<SweptLine>& lines) const {
  WeightsOf weights;  // NOLINT: written before it is read
  weights[0] = first;
  weigh(points, weights);
  const std::uint32_t found = candidates(weights, all);
  if (found != 0) appendCandidates(points, weights, found, lines);
}

void FewPoints::appendCandidates(const PointsInBox& points, const WeightsOf& weights,
                                 std::uint32_t found, std::vector<SweptLine>& lines) const {
  const std::array<std::int32_t, 3> counts = {points.countXy[0], points.countXy[1], points.countZ};
  const SweepAxes order =
      chooseSweepAxes(GridBox{{{{0, counts[0] - 1}, {0, counts[1] - 1}, {0, counts[2] - 1}}}});
  if (hasOneBit(found)) {
    const std::int32_t i = std::countr_zero(found);
    const std::int32_t row = i / counts[2];
    appendOne(points, {row / counts[1], row % counts[1], i % counts[2]},
              weights[static_cast<std::size_t>(i)], order, lines);
    return;
  }
  const std::array<std::uint8_t, 3>& axes = order();
  const std::array<std::int32_t, 3> strides = {counts[1] * counts[2], counts[2], 1};
  std::array<std::int32_t, 3> at{};
  const auto forEach = [&](std::size_t k, const auto& visit) {
    for (at[axes[k]] = 0; at[axes[k]] < counts[axes[k]]; ++at[axes[k]]) {
      visit(at[axes[k]] * strides[axes[k]]);
    }
  };
  forEach(0, [&](std::int32_t level) {
    forEach(1, [&](std::int32_t row) {
      SweptLine line{0, 0, 0, 0, kNoSimplex, kNoSimplex, order};
      forEach(2, [&](std::int32_t point) {
        const std::int32_t i = level + row + point;
        if (((found >> i) & 1U) == 0) return;
        const Halves halves = points.at(at);
        const CornerMask simplex = simplexOf(halves, weights[static_cast<std::size_t>(i)]);
        if (simplex == kNoSimplex) return;
        // Tets are convex: what they have of a line is consecutive.
        if (line.count == 0) {
          line.level = halves[axes[0]] >> 1;
          line.row = halves[axes[1]] >> 1;
          line.first = halves[axes[2]] >> 1;
          line.left = simplex;
        }
        ++line.count;
        line.right = simplex;
      });
      if (line.count > 0) lines.push_back(line);
    });
  });
}

}  // namespace

bool sweepFewPoints(const LatticeTet& corners, std::int64_t unit, std::vector<SweptLine>& vertices,
                    std::vector<SweptLine>& centers) {
  const double perHalf = 2 / static_cast<double>(unit);
  const HalvedTet halved(corners, perHalf);
  if (!(halved.largest < kMostExact * perHalf) || halved.mostSteps >= kManySteps) return false;
  constexpr IntPair kOne = {1, 1};
  const IntPair oddXy = halved.firstXy & kOne;
  const std::int32_t oddZ = halved.firstZ & 1;
  const PointsInBox ofVertices{halved.firstXy + oddXy, halved.firstZ + oddZ,
                               (halved.stepsXy + 2 * kOne - oddXy) >> 1,
                               (halved.stepsZ + 2 - oddZ) >> 1};
  const PointsInBox ofCenters{halved.firstXy | kOne, halved.firstZ | 1,
                              halved.stepsXy + kOne - ofVertices.countXy,
                              halved.stepsZ + 1 - ofVertices.countZ};
  const std::int32_t vertexCount = ofVertices.all();
  const std::int32_t centerCount = ofCenters.all();
  if (vertexCount > kFewPoints || centerCount > kFewPoints) return false;
  if ((vertexCount | centerCount) == 0) return true;
  const FewPoints few(corners, unit, halved);
  if (vertexCount > 0) few.append(ofVertices, vertexCount, vertices);
  if (centerCount > 0) few.append(ofCenters, centerCount, centers);
  return true;
}

}  // namespace hexhex
