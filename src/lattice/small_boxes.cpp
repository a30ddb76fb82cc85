#include <algorithm>
#include <array>
#include <bit>

#include <base/pair.hpp>
#include <lattice/small_boxes.hpp>
#include <lattice/weight_field.hpp>

namespace hexhex {

namespace {

/// More points take longer one by one than by lines.
constexpr std::int32_t kFewPoints = 32;

using Halves = std::array<std::int32_t, 3>;

/// A tet in halves of grid units, and the points of the grid of that width in its bounding box. All
/// is exact if coordinates are below kMostExact.
struct HalvedTet {
  /// Doubles hold integers up to here.
  static constexpr double kMostExact = 0x1p53;

  std::array<Pair, 3> of01;  ///< corners, by axis
  std::array<Pair, 3> of23;
  IntPair firstXy;  ///< the first point of the box
  std::int32_t firstZ;
  IntPair countXy;  ///< of points along each axis
  std::int32_t countZ;
  double mostPoints;  ///< along an axis
  double largest;     ///< coordinate of a corner

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
    // All as upper bounds: of x and y, of the same turned around, and of z both ways.
    const Pair lowXy = smaller(Pair{low[0][0], low[1][0]}, Pair{low[0][1], low[1][1]});
    const Pair highXy = larger(Pair{high[0][0], high[1][0]}, Pair{high[0][1], high[1][1]});
    const Pair aroundZ = larger(Pair{-low[2][0], high[2][0]}, Pair{-low[2][1], high[2][1]});
    constexpr Pair kOne = {1, 1};
    const Pair beforeXy = floorOf(-lowXy);
    const Pair pointsXy = floorOf(highXy) + beforeXy + kOne;
    const Pair endsZ = floorOf(aroundZ);
    const double pointsZ = endsZ[0] + endsZ[1] + 1;
    firstXy = __builtin_convertvector(-beforeXy, IntPair);
    firstZ = static_cast<std::int32_t>(-endsZ[0]);
    countXy = __builtin_convertvector(pointsXy, IntPair);
    countZ = static_cast<std::int32_t>(pointsZ);
    mostPoints = std::max(std::max(pointsXy[0], pointsXy[1]), pointsZ);
    const Pair bounds = larger(larger(-lowXy, highXy), aroundZ);
    largest = std::max(bounds[0], bounds[1]);
  }
};

/// Those of a grid in a bounding box.
struct PointsInBox {
  IntPair firstXy;  ///< in halves
  std::int32_t firstZ;
  IntPair countXy;  ///< along each axis
  std::int32_t countZ;
  std::int32_t all;
};

/// If there are less than 2^10 along each axis.
std::int32_t countOf(IntPair xy, std::int32_t z) noexcept { return xy[0] * xy[1] * z; }

CornerWeights sumOf(const CornerWeights& a, const CornerWeights& b) noexcept {
  return {a.of01 + b.of01, a.of23 + b.of23};
}

/// Appends lines of one tet.
class FewPoints {
 public:
  /// @param moved  what was subtracted from corners to get the tet in halves, in halves
  FewPoints(const LatticeTet& corners, std::int64_t unit, const HalvedTet& halved,
            const Halves& moved) noexcept
      : corners_(corners),
        unit_(unit),
        moved_(moved),
        field_(halved.of01, halved.of23),
        error_(WeightField::errorBound(halved.mostPoints)) {}

  void append(const PointsInBox& points, std::vector<SweptLine>& lines) const {
    const CornerWeights first =
        field_.at({static_cast<double>(points.firstXy[0]), static_cast<double>(points.firstXy[1]),
                   static_cast<double>(points.firstZ)});
    if (points.all > 1) {
      appendSome(points, first, lines);
    } else if (first.least() >= -error_) {
      appendFirst(points, first, lines);
    }
  }

 private:
  /// Weights of points, the last coordinate changing fastest, and one more.
  using WeightsOf = std::array<CornerWeights, kFewPoints + 1>;

  void appendFirst(const PointsInBox& points, const CornerWeights& weights,
                   std::vector<SweptLine>& lines) const;
  void appendSome(const PointsInBox& points, const CornerWeights& first,
                  std::vector<SweptLine>& lines) const;
  void appendCandidates(const PointsInBox& points, const WeightsOf& weights, std::uint32_t found,
                        std::vector<SweptLine>& lines) const;
  void weigh(const PointsInBox& points, WeightsOf& weights) const noexcept;
  [[nodiscard]] std::uint32_t candidates(const WeightsOf& weights,
                                         std::int32_t points) const noexcept;
  [[nodiscard]] CornerMask simplexOf(const Halves& halves,
                                     const CornerWeights& weights) const noexcept;
  /// In halves.
  [[nodiscard]] Halves pointAt(const PointsInBox& points, std::int32_t x, std::int32_t y,
                               std::int32_t z) const noexcept {
    return {points.firstXy[0] + moved_[0] + 2 * x, points.firstXy[1] + moved_[1] + 2 * y,
            points.firstZ + moved_[2] + 2 * z};
  }

  const LatticeTet& corners_;
  std::int64_t unit_;
  Halves moved_;
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

/// Which points are not outside of a face for certain, as bits. Without branches, as each point is
/// as good as random.
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

void FewPoints::appendFirst(const PointsInBox& points, const CornerWeights& weights,
                            std::vector<SweptLine>& lines) const {
  const Halves halves = pointAt(points, 0, 0, 0);
  const CornerMask simplex = simplexOf(halves, weights);
  if (simplex == kNoSimplex) return;
  lines.push_back({halves[0] >> 1, halves[1] >> 1, halves[2] >> 1, 1, simplex, simplex, {}});
}

void FewPoints::appendSome(const PointsInBox& points, const CornerWeights& first,
                           std::vector<SweptLine>& lines) const {
  WeightsOf weights;  // NOLINT: written before it is read
  weights[0] = first;
  weigh(points, weights);
  const std::uint32_t found = candidates(weights, points.all);
  if (found != 0) appendCandidates(points, weights, found, lines);
}

void FewPoints::appendCandidates(const PointsInBox& points, const WeightsOf& weights,
                                 std::uint32_t found, std::vector<SweptLine>& lines) const {
  const std::array<std::int32_t, 3> counts = {points.countXy[0], points.countXy[1], points.countZ};
  const SweepAxes order = chooseSweepAxes(counts);
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
        const auto i = static_cast<std::size_t>(level + row + point);
        if (((found >> i) & 1U) == 0) return;
        const Halves halves = pointAt(points, at[0], at[1], at[2]);
        const CornerMask simplex = simplexOf(halves, weights[i]);
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

/// The same near the origin.
/// @return what was subtracted, in halves
Halves moveToOrigin(LatticeTet& corners, std::int64_t unit) noexcept {
  Halves moved;
  for (std::size_t k = 0; k < 3; ++k) {
    // Rounded down to a grid point, as the unit is a power of two.
    const std::int64_t origin = corners[0][k] & -unit;
    for (LatticePoint& corner : corners) corner[k] -= origin;
    moved[k] = static_cast<std::int32_t>(2 * (origin / unit));
  }
  return moved;
}

HalfGridSet appendOf(const LatticeTet& corners, std::int64_t unit, const HalvedTet& halved,
                     const Halves& moved, std::vector<SweptLine>& vertices,
                     std::vector<SweptLine>& centers) {
  constexpr IntPair kOne = {1, 1};
  const IntPair oddXy = halved.firstXy & kOne;
  const std::int32_t oddZ = halved.firstZ & 1;
  PointsInBox ofVertices{halved.firstXy + oddXy, halved.firstZ + oddZ,
                         (halved.countXy + kOne - oddXy) >> 1, (halved.countZ + 1 - oddZ) >> 1, 0};
  PointsInBox ofCenters{halved.firstXy | kOne, halved.firstZ | 1,
                        halved.countXy - ofVertices.countXy, halved.countZ - ofVertices.countZ, 0};
  ofVertices.all = countOf(ofVertices.countXy, ofVertices.countZ);
  ofCenters.all = countOf(ofCenters.countXy, ofCenters.countZ);
  if ((ofVertices.all | ofCenters.all) == 0) return 0;
  const FewPoints few(corners, unit, halved, moved);
  unsigned left = 0;
  const auto append = [&](const PointsInBox& points, HalfGrid grid, std::vector<SweptLine>& lines) {
    if (points.all == 0) return;
    if (points.all <= kFewPoints) {
      few.append(points, lines);
    } else {
      left |= halfGridBit(grid);
    }
  };
  append(ofVertices, kVertexGrid, vertices);
  append(ofCenters, kCenterGrid, centers);
  return static_cast<HalfGridSet>(left);
}

}  // namespace

HalfGridSet appendFromSmallBoxes(const LatticeTet& corners, std::int64_t unit,
                                 std::vector<SweptLine>& vertices,
                                 std::vector<SweptLine>& centers) {
  constexpr HalfGridSet kBoth = halfGridBit(kVertexGrid) | halfGridBit(kCenterGrid);
  const auto length = static_cast<double>(unit);
  const double perHalf = 2 / length;
  const HalvedTet halved(corners, perHalf);
  if (halved.mostPoints > 2 * kFewPoints) return kBoth;
  if (halved.largest * length < HalvedTet::kMostExact) {
    return appendOf(corners, unit, halved, {}, vertices, centers);
  }
  LatticeTet near = corners;
  const Halves moved = moveToOrigin(near, unit);
  const HalvedTet again(near, perHalf);
  if (!(again.largest * length < HalvedTet::kMostExact)) return kBoth;
  return appendOf(corners, unit, again, moved, vertices, centers);
}

}  // namespace hexhex
