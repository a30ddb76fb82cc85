// The half diagonals of cells that a triangle may cut (for the atlas engine; not in the paper).
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <base/lanes.hpp>
#include <lattice/triangle_cells.hpp>

namespace hexhex::lattice {

namespace {

// By value: std::min and std::max, which return references, become unpredictable branches.
constexpr std::int64_t lesser(std::int64_t a, std::int64_t b) noexcept { return a < b ? a : b; }
constexpr std::int64_t greater(std::int64_t a, std::int64_t b) noexcept { return a < b ? b : a; }

/// Two lines through the centre of a cell, and the weights of the triangle's corners at the points
/// where its plane meets the lines. In units in which half diagonals are `sum` / 2 long, the plane
/// is as far from the centre as the determinant of the triangle's corners.
struct LinePair {
  Pair least;  ///< weight
  Pair most;
  Pair sum;  ///< of the three weights

  explicit LinePair(const std::array<Pair, 3>& weights) noexcept
      : least(smaller(smaller(weights[0], weights[1]), weights[2])),
        most(larger(weights[2], larger(weights[1], weights[0]))),
        sum(weights[0] + weights[1] + weights[2]) {}
};

/// For the half diagonals on two lines, in their directions and the opposite ones: negative if the
/// triangle certainly does not cut them.
struct CutSigns {
  Pair ahead;
  Pair behind;
};

constexpr Pair broadcast(double x) noexcept { return Pair{x, x}; }

/// @param least  the determinant, which is positive, minus its error bound
CutSigns cutOn(const LinePair& lines, double least, double error) noexcept {
  const Pair half = lines.sum * broadcast(0.5);  // length of the half diagonals
  return {smaller(lines.least + broadcast(error), half - broadcast(least)),
          smaller(broadcast(error) - lines.most, -half - broadcast(least))};
}

/// For planes that may contain the centre, and then whole lines.
CutSigns cutAtCenter(const LinePair& lines, double error) noexcept {
  const Pair inside = larger(lines.least, -lines.most);
  const Pair both = larger(inside, -magnitudeOf(lines.sum)) + broadcast(error);
  return {both, both};
}

/// @param up,down  along (1, 1, 1) and (-1, 1, 1), and along (1, 1, -1) and (-1, 1, -1)
CellCornerSet cornersBehind(const CutSigns& up, const CutSigns& down) noexcept {
  // Corners 6, 4, 2 and 0 in the first lane, and 7, 5, 3 and 1 in the second.
  PairBits notCut = signBits(up.ahead);
  notCut = (notCut << 2) | signBits(down.behind);
  notCut = (notCut << 2) | signBits(down.ahead);
  notCut = (notCut << 2) | signBits(up.behind);
  return kAllCellCorners & ~static_cast<CellCornerSet>(notCut[0] | notCut[1] << 1);
}

}  // namespace

TriangleCells::TriangleCells(const std::array<LatticePoint, 3>& corners, std::int64_t unit) noexcept
    : triangle_(corners), unit_(unit) {
  const int shift = std::countr_zero(static_cast<std::uint64_t>(unit));
  const double scale = 1.0 / static_cast<double>(unit);
  std::array<std::array<double, 3>, 3> relative;
  double size = 1;
  cells_ = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t low = lesser(lesser(corners[0][k], corners[1][k]), corners[2][k]);
    const std::int64_t high = greater(greater(corners[0][k], corners[1][k]), corners[2][k]);
    origin_[k] = static_cast<std::int32_t>(low >> shift);
    const std::int64_t origin = std::int64_t{origin_[k]} << shift;
    first_[k] = firstHalfCell(low - origin, shift);
    last_[k] = lastHalfCell(high - origin, shift);
    cells_ = first_[k] > last_[k]
                 ? 0
                 : std::min(cells_ * ((last_[k] >> 1) - (first_[k] >> 1) + 1), kFewCells + 1);
    for (std::size_t i = 0; i < 3; ++i) {
      relative[i][k] = static_cast<double>(corners[i][k] - origin) * scale;
    }
    size = std::max(size, static_cast<double>(high - origin) * scale);
  }
  cuts_ = HalfDiagonalCuts(relative, size);
}

CellCornerSet HalfDiagonalCuts::cutIn(const GridPoint& z) const noexcept {
  // Corners of the triangle relative to the centre: 0 and 1, 1 and 2 as pairs; 0 and 2 alone.
  std::array<Pair, 3> p01;
  std::array<Pair, 3> p12;
  std::array<double, 3> p0;
  std::array<double, 3> p2;
  for (std::size_t k = 0; k < 3; ++k) {
    const double center = static_cast<double>(z[k]) + 0.5;
    p01[k] = Pair{corners_[0][k], corners_[1][k]} - broadcast(center);
    p2[k] = corners_[2][k] - center;
    p0[k] = p01[k][0];
    p12[k] = Pair{p01[k][1], p2[k]};
  }
  // Cross products of corners 0 and 1, 1 and 2 as pairs; of 2 and 0 alone.
  std::array<Pair, 3> first;
  std::array<double, 3> last;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = k == 2 ? 0 : k + 1;
    const std::size_t j = k == 0 ? 2 : k - 1;
    first[k] = p01[i] * p12[j] - p01[j] * p12[i];
    last[k] = p2[i] * p0[j] - p2[j] * p0[i];
  }
  const double determinant = p2[0] * first[0][0] + p2[1] * first[1][0] + p2[2] * first[2][0];
  // The triangle is turned so that the determinant is positive. Weights along the diagonals (1, 1,
  // 1) and (-1, 1, 1), and along (1, 1, -1) and (-1, 1, -1).
  const double sign = std::copysign(1.0, determinant);
  const Pair signs = {sign, -sign};
  std::array<Pair, 3> up;
  std::array<Pair, 3> down;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = [&](std::size_t k) { return broadcast(i < 2 ? first[k][i] : last[k]); };
    const Pair xy = at(0) * signs + at(1) * broadcast(sign);
    const Pair w = at(2) * broadcast(sign);
    up[i] = xy + w;
    down[i] = xy - w;
  }
  const LinePair upward(up);
  const LinePair downward(down);
  const double least = std::abs(determinant) - determinantError_;
  if (least > determinantError_) {
    return cornersBehind(cutOn(upward, least, error_), cutOn(downward, least, error_));
  }
  return cornersBehind(cutAtCenter(upward, error_), cutAtCenter(downward, error_));
}

}  // namespace hexhex::lattice
