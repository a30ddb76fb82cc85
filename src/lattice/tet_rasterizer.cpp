// Rasterization of a tet, with proven error bounds (Section 5.2, Algorithms 2 and 3).
#include <algorithm>
#include <bit>
#include <cmath>

#include <base/lanes.hpp>
#include <lattice/tet_rasterizer.hpp>

namespace hexhex::lattice {

namespace {

int shiftOf(std::int64_t unit) { return std::countr_zero(static_cast<std::uint64_t>(unit)); }

/// The shift of a grid along an axis, in lattice units.
std::int64_t moved(HalfGrid grid, std::size_t axis, std::int64_t unit) {
  return ((grid >> axis) & 1) * (unit / 2);
}

}  // namespace

TetBounds::TetBounds(const LatticeTet& corners) noexcept {
  const auto lesser = [](std::int64_t a, std::int64_t b) { return a < b ? a : b; };
  const auto greater = [](std::int64_t a, std::int64_t b) { return a < b ? b : a; };
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = lesser(lesser(corners[0][k], corners[1][k]), lesser(corners[2][k], corners[3][k]));
    high[k] = greater(greater(corners[0][k], corners[1][k]), greater(corners[2][k], corners[3][k]));
  }
}

GridBox TetBounds::gridBox(std::int64_t unit, HalfGrid grid) const noexcept {
  const int shift = shiftOf(unit);
  GridBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t zero = moved(grid, axis, unit);
    // Right shifts of signed integers round down (C++20): ceil(low) = -floor(-low).
    box.range[axis] = {static_cast<std::int32_t>(-((zero - low[axis]) >> shift)),
                       static_cast<std::int32_t>((high[axis] - zero) >> shift)};
  }
  return box;
}

/// Computes what the lines of all grids have in common.
void TetRasterizer::measure() noexcept {
  measured_ = true;
  bounds_ = TetBounds(corners_);
  const int shift = shiftOf(unit_);
  const double scale = 1.0 / static_cast<double>(unit_);
  double size = 0;
  std::int64_t bits = std::max<std::int64_t>(unit_ / 2, 1);  // points are multiples of this
  std::array<ByFace, 3> first;                               // edges of faces
  std::array<ByFace, 3> second;
  for (std::size_t k = 0; k < 3; ++k) {
    origin_[k] = static_cast<std::int32_t>(bounds_.low[k] >> shift);
    const std::int64_t origin = std::int64_t{origin_[k]} << shift;
    size = std::max(size, static_cast<double>(bounds_.high[k] - origin) * scale + 1);
    ByFace relative;  // corners
    for (std::size_t i = 0; i < 4; ++i) {
      relative[i] = static_cast<double>(corners_[i][k] - origin) * scale;
      bits |= corners_[i][k] - origin;
    }
    for (std::size_t face = 0; face < 4; ++face) {
      const auto corner = [&](std::size_t i) {
        return relative[static_cast<std::size_t>(kFaceCorners[face][i])];
      };
      zeros_[k][face] = corner(0);
      first[k][face] = corner(1) - corner(0);
      second[k][face] = corner(2) - corner(0);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = k == 2 ? 0 : k + 1;
    const std::size_t j = k == 0 ? 2 : k - 1;
    for (std::size_t face = 0; face < 4; ++face) {
      gradients_[k][face] = first[i][face] * second[j][face] - first[j][face] * second[i][face];
    }
  }
  // Errors in units of u = 2^-53, with magnitudes, where corners and points of the box are less
  // than `size` from each other and from the origin: edges, up to 2 size, are off by at most 4
  // size; products of two of them by 20 size^2, and their differences, the gradients, up to 8
  // size^2, by 48 size^2. At the first point of a box, three products with distances, each up to 8
  // size^3 and off by 72 size^3, add up to a value in two additions of at most 24 size^3: off by
  // 264 size^3. From there to any other point there are three more products, each up to 8 size^3
  // and off by 56 size^3, and three additions of at most 48 size^3: below 264 + 168 + 144 < 2^10
  // size^3. 2^13 covers second-order terms, and conversions of the ends of lines to integers.
  error_ = 0x1p-40 * size * size * size;
  // Without rounding, none of these sums of products exceeds 48 size^3.
  const double latticeSize = size * static_cast<double>(unit_);
  isExact_ = 48 * latticeSize * latticeSize * latticeSize < exactBelow(bits);
}

bool TetRasterizer::prepare(HalfGrid grid, const GridBox& box, Search& search) const noexcept {
  search.values = {};
  search.errors.fill(error_);
  ByFace most{};  // largest increase of values in the box, from its first point on
  for (std::size_t k = 0; k < 3; ++k) {
    const GridRange& range = box.range[k];
    const double start = static_cast<double>(range.first - origin_[k]) + 0.5 * ((grid >> k) & 1);
    const auto length = static_cast<double>(range.last - range.first);
    for (std::size_t face = 0; face < 4; ++face) {
      search.values[face] += gradients_[k][face] * (start - zeros_[k][face]);
      const double change = gradients_[k][face] * length;
      most[face] += 0.5 * (change + std::abs(change));  // if positive
    }
    if (epsilon_ > 0) {
      for (std::size_t face = 0; face < 4; ++face) {
        search.errors[face] += epsilon_ * std::abs(gradients_[k][face]);
      }
    }
  }
  for (std::size_t face = 0; face < 4; ++face) {
    if (search.values[face] + most[face] < -search.errors[face]) return false;
  }
  search.grid = grid;
  search.axes = chooseSweepAxes(box);
  const std::array<std::uint8_t, 3>& axes = search.axes();
  for (std::size_t k = 0; k < 3; ++k) {
    const GridRange& range = box.range[axes[k]];
    search.first[k] = range.first;
    search.size[k] = range.last - range.first;
    search.slopes[k] = gradients_[axes[k]];
  }
  constexpr double kFar = 1e300;  // beyond all zeros
  search.hasFlat = false;
  double zeroError = 0;
  for (std::size_t face = 0; face < 4; ++face) {
    const double slope = search.slopes[2][face];
    // Other zeros are accurate to an eighth.
    constexpr double kClearSlope = 16;
    const bool isFlat = !(std::abs(slope) > kClearSlope * search.errors[face]);
    search.isFlat[face] = isFlat;
    search.hasFlat = search.hasFlat || isFlat;
    const double toZero = isFlat ? 0 : -1 / slope;
    search.toZero[face] = toZero;
    search.forLow[face] = -kFar * (toZero < 0 ? 0 : 1);
    search.forHigh[face] = kFar * (toZero > 0 ? 0 : 1);
    zeroError = std::max(zeroError, 2 * search.errors[face] * std::abs(toZero));
  }
  // For rounding of the zero itself and of its conversion to an integer.
  search.zeroError = zeroError + 0x1p-48 * (static_cast<double>(search.size[2]) + 16);
  return true;
}

TetRasterizer::Line TetRasterizer::findLine(const Search& search, const ByFace& values,
                                            std::int32_t row, SweptLine& line) const noexcept {
  // Outside the box, so that empty lines stay empty, and not integers, lest a limit be mistaken for
  // a zero near one.
  constexpr double kBefore = -1.5;
  const double behind = static_cast<double>(search.size[2]) + 1.5;
  const ByFace here = valuesAfter(values, search.slopes[1], row);
  Pair lows = {kBefore, kBefore};
  Pair highs = {behind, behind};
  for (std::size_t face = 0; face < 4; face += 2) {
    const Pair zeros = loadPair(&here[face]) * loadPair(&search.toZero[face]);
    lows = larger(lows, zeros + loadPair(&search.forLow[face]));
    highs = smaller(highs, zeros + loadPair(&search.forHigh[face]));
  }
  double low = std::max(lows[0], lows[1]);
  double high = std::min(highs[0], highs[1]);
  bool isCertain = !(epsilon_ > 0);
  for (std::size_t face = 0; search.hasFlat && face < 4; ++face) {
    if (!search.isFlat[face]) continue;
    const double reach = search.errors[face] + std::abs(search.slopes[2][face]) * search.size[2];
    if (here[face] < -reach) return Line::Outside;
    if (!(here[face] > reach)) isCertain = false;
  }
  if (low - search.zeroError > high + search.zeroError) return Line::Outside;
  low = std::min(low, behind);
  high = std::max(high, kBefore);
  // Adding 4 turns truncation into floor. If no integer lies within the error bound of either zero,
  // the points strictly between the zeros are all inside the tet, and no others are in it.
  const auto floorOf = [](double x) { return static_cast<std::int32_t>(x + 4) - 4; };
  const std::int32_t beforeFirst = floorOf(low - search.zeroError);
  const std::int32_t last = floorOf(high + search.zeroError);
  const std::int32_t from = std::max(beforeFirst + 1, 0);
  const std::int32_t to = std::min(last, search.size[2]);
  if (from > to) return Line::HasNoPoints;
  line.row = search.first[1] + row;
  isCertain = isCertain && floorOf(low + search.zeroError) == beforeFirst &&
              floorOf(high - search.zeroError) == last;
  if (!isCertain) {
    return findExactly(search, here, from, to, line) ? Line::HasPoints : Line::HasNoPoints;
  }
  line.first = search.first[2] + from;
  line.count = static_cast<std::uint32_t>(to - from + 1);
  line.left = kWholeTet;
  line.right = kWholeTet;
  return Line::HasPoints;
}

bool TetRasterizer::findExactly(const Search& search, const ByFace& values, std::int32_t first,
                                std::int32_t last, SweptLine& line) const noexcept {
  const std::array<std::uint8_t, 3>& axes = search.axes();
  LatticePoint point;
  point[axes[0]] = line.level * unit_ + moved(search.grid, axes[0], unit_);
  point[axes[1]] = line.row * unit_ + moved(search.grid, axes[1], unit_);
  const auto simplexAt = [&](std::int32_t i) {
    point[axes[2]] = (search.first[2] + i) * unit_ + moved(search.grid, axes[2], unit_);
    return simplexBySides([&](std::size_t face) {
      const double value = values[face] + search.slopes[2][face] * i;
      if (isExact_) return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0);
      const bool isInside = !(epsilon_ > 0) && value > search.errors[face];
      return isInside ? 1 : sideOfFace(corners_, face, point);
    });
  };
  for (; first <= last; ++first) {
    line.left = simplexAt(first);
    if (line.left != kNoSimplex) break;
  }
  if (first > last) return false;
  line.right = line.left;
  for (; last > first; --last) {
    line.right = simplexAt(last);
    if (line.right != kNoSimplex) break;
  }
  if (last == first) line.right = line.left;
  line.first = search.first[2] + first;
  line.count = static_cast<std::uint32_t>(last - first + 1);
  return true;
}

}  // namespace hexhex::lattice
