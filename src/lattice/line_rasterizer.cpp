#include <algorithm>
#include <cmath>
#include <limits>

#include <lattice/line_rasterizer.hpp>

namespace hexhex {

namespace {

/// Plane values are sums of products of up to three converted 64-bit integers: conversions, two
/// multiplications, and up to five additions make at most 12 roundings of relative size 2^-53 of
/// the sum of magnitudes; 16 covers the rounding of that sum.
constexpr double kValueError = 0x1p-49;

struct Plane {
  std::array<double, 3> origin;     ///< relative to the box's first point
  std::array<double, 3> normal;     ///< inward
  std::array<double, 3> magnitude;  ///< sums of magnitudes behind the normal
};

/// Edge vectors are differences of integers: exact before they are rounded.
std::array<double, 3> difference(const LatticePoint& a, const LatticePoint& b, double scale) {
  return {static_cast<double>(a[0] - b[0]) * scale, static_cast<double>(a[1] - b[1]) * scale,
          static_cast<double>(a[2] - b[2]) * scale};
}

Plane makePlane(const LatticeTet& corners, std::size_t face, const LatticePoint& boxOrigin,
                double scale) {
  const LatticePoint& p = corners[static_cast<std::size_t>(kFaceCorners[face][0])];
  const auto a = difference(corners[static_cast<std::size_t>(kFaceCorners[face][1])], p, scale);
  const auto b = difference(corners[static_cast<std::size_t>(kFaceCorners[face][2])], p, scale);
  Plane plane{difference(p, boxOrigin, scale), {}, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = k == 2 ? 0 : k + 1;
    const std::size_t j = k == 0 ? 2 : k - 1;
    const double first = a[i] * b[j];
    const double second = a[j] * b[i];
    plane.normal[k] = first - second;
    plane.magnitude[k] = std::abs(first) + std::abs(second);
  }
  return plane;
}

/// Bound of the error of a plane's value anywhere in the box.
double errorBound(const Plane& plane, const std::array<std::int32_t, 3>& size) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += plane.magnitude[k] * (std::abs(plane.origin[k]) + static_cast<double>(size[k]));
  }
  return kValueError * sum;
}

double valueAtBoxOrigin(const Plane& plane) {
  return -(plane.normal[0] * plane.origin[0] + plane.normal[1] * plane.origin[1] +
           plane.normal[2] * plane.origin[2]);
}

}  // namespace

LineRasterizer::LineRasterizer(const LatticeTet& corners, std::int64_t unit, const GridBox& box,
                               SweepAxes axes) noexcept
    : corners_(corners), unit_(unit), sweepAxes_(axes), axes_(axes()) {
  for (std::size_t k = 0; k < 3; ++k) {
    origin_[k] = box.range[axes_[k]].first;
    size_[k] = box.range[axes_[k]].last - origin_[k];
  }
  preparePlanes();
  if (size_[1] >= kFewRows) prepareEdges();
}

void LineRasterizer::preparePlanes() noexcept {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double scale = 1.0 / static_cast<double>(unit_);
  LatticePoint boxOrigin{};
  std::array<std::int32_t, 3> size{};
  for (std::size_t k = 0; k < 3; ++k) {
    boxOrigin[axes_[k]] = origin_[k] * unit_;
    size[axes_[k]] = size_[k];
  }
  LatticePoint boxEnd = boxOrigin;
  for (std::size_t k = 0; k < 3; ++k) boxEnd[k] += size[k] * unit_;
  limits_ = BoxLimits(corners_, boxOrigin, boxEnd, sweepAxes_);
  for (std::size_t f = 0; f < 4; ++f) {
    lowBias_[f] = -kInfinity;
    highBias_[f] = kInfinity;
    if (((limits_.faces >> f) & 1U) != 0) {
      offset_[f] = 0;
      for (std::size_t k = 0; k < 3; ++k) normal_[k][f] = 0;
      continue;
    }
    const Plane plane = makePlane(corners_, f, boxOrigin, scale);
    offset_[f] = valueAtBoxOrigin(plane);
    for (std::size_t k = 0; k < 3; ++k) normal_[k][f] = plane.normal[axes_[k]];
    valueError_[f] = errorBound(plane, size);
    if (plane.magnitude[axes_[2]] == 0) {  // all products are zero, exactly
      constant_[f] = true;
      hasConstant_ = true;
      continue;
    }
    const double slope = normal_[2][f];
    // Twice the value's error covers the slope's own error on the way from the box's first point.
    const double error = 2 * valueError_[f] / std::abs(slope);
    if (!(error < 0.125)) {
      hasUnsure_ = true;
      continue;
    }
    toZero_[f] = -1 / slope;
    (slope > 0 ? lowBias_ : highBias_)[f] = 0;
    zeroError_ = std::max(zeroError_, error);
  }
  // The roundings of the zero itself and on its way to an integer.
  zeroError_ += 0x1p-48 * (static_cast<double>(size_[2]) + 8);
}

void LineRasterizer::prepareEdges() noexcept {
  const double scale = 1.0 / static_cast<double>(unit_);
  std::array<std::array<double, 2>, 4> at{};
  double extent = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      at[i][k] = static_cast<double>(corners_[i][axes_[k]] - origin_[k] * unit_) * scale;
      extent = std::max(extent, std::abs(at[i][k]));
    }
  }
  std::size_t e = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      const bool upward = at[i][0] < at[j][0];
      const std::array<double, 2>& low = upward ? at[i] : at[j];
      const std::array<double, 2>& high = upward ? at[j] : at[i];
      const double rise = high[0] - low[0];
      const bool flat = rise < 1e-6;
      const double perLevel = flat ? 0 : (high[1] - low[1]) / rise;
      edges_[e++] = {low[0],  high[0],  low[1],
                     high[1], perLevel, 1e-9 + 0x1p-48 * (extent + 1) * (1 + std::abs(perLevel)),
                     flat};
    }
  }
}

GridRange LineRasterizer::rowsAt(std::int32_t level) const noexcept {
  if (size_[1] < kFewRows) return {0, size_[1]};
  const auto height = static_cast<double>(level);
  double first = static_cast<double>(size_[1]) + 1;
  double last = -1;
  for (const Edge& edge : edges_) {
    // Ends within rounding of the level count as crossings; rows found so only cost time.
    if (edge.low > height + 1e-9 || edge.high < height - 1e-9) continue;
    if (edge.flat) {
      first = std::min({first, edge.lowRow - edge.margin, edge.highRow - edge.margin});
      last = std::max({last, edge.lowRow + edge.margin, edge.highRow + edge.margin});
      continue;
    }
    const double row = edge.lowRow + (height - edge.low) * edge.rowsPerLevel;
    first = std::min(first, row - edge.margin);
    last = std::max(last, row + edge.margin);
  }
  // Truncation rounds down where the box allows rows at all.
  const double from = std::max(first, 0.0);
  const auto floor = static_cast<std::int32_t>(from);
  return {from > static_cast<double>(floor) ? floor + 1 : floor,
          last < 0 ? -1 : static_cast<std::int32_t>(std::min(last, static_cast<double>(size_[1])))};
}

void LineRasterizer::startLevel(std::int32_t level) noexcept {
  for (std::size_t f = 0; f < 4; ++f) value_[f] = offset_[f] + normal_[0][f] * level;
}

bool LineRasterizer::lineAt(std::int32_t level, std::int32_t row, SweptLine& line) noexcept {
  // The interval between the zeros of rising and falling planes, clamped to a range that integers
  // hold; beyond the box by a little so that empty lines stay empty.
  // Not integers, so that no limit of the range is mistaken for a zero near one.
  double low = -2.5;
  double high = static_cast<double>(size_[2]) + 2.5;
  std::array<double, 4> value{};
  for (std::size_t f = 0; f < 4; ++f) value[f] = value_[f] + normal_[1][f] * row;
  for (std::size_t f = 0; f < 4; ++f) {
    const double zero = value[f] * toZero_[f];
    low = std::max(low, zero + lowBias_[f]);
    high = std::min(high, zero + highBias_[f]);
  }
  low = std::min(low, static_cast<double>(size_[2]) + 2.5);
  high = std::max(high, -2.5);
  // Adding 4 makes truncation a floor. If no integer lies within the bound of either zero, the
  // points strictly between them are all inside the tet, and no others are in it.
  const auto lowFrom = static_cast<std::int32_t>(low - zeroError_ + 4);
  const auto lowTo = static_cast<std::int32_t>(low + zeroError_ + 4);
  const auto highFrom = static_cast<std::int32_t>(high - zeroError_ + 4);
  const auto highTo = static_cast<std::int32_t>(high + zeroError_ + 4);
  bool sure = lowFrom == lowTo && highFrom == highTo && !hasUnsure_;
  if (hasConstant_) {
    for (std::size_t f = 0; f < 4; ++f) {
      if (!constant_[f] || value[f] > valueError_[f]) continue;
      if (value[f] < -valueError_[f]) return false;
      sure = false;
    }
  }
  const std::int32_t first = std::max(lowFrom - 3, 0);
  const std::int32_t last = std::min(highTo - 4, size_[2]);
  if (first > last) return false;
  line.level = origin_[0] + level;
  line.row = origin_[1] + row;
  if (!sure) return exactLine(first, last, line);
  line.first = origin_[2] + first;
  line.count = static_cast<std::uint32_t>(last - first + 1);
  line.left = limits_.hold ? insideOfLimits(level, row, first) : kWholeTet;
  line.right = limits_.hold ? insideOfLimits(level, row, last) : kWholeTet;
  return true;
}

bool LineRasterizer::exactLine(std::int32_t first, std::int32_t last, SweptLine& line) noexcept {
  if (!planes_) planes_.emplace(corners_, unit_);
  GridPoint z{};
  z[axes_[0]] = line.level;
  z[axes_[1]] = line.row;
  const auto simplexAt = [&](std::int32_t point) {
    z[axes_[2]] = origin_[2] + point;
    return planes_->generator(z);
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
  line.first = origin_[2] + first;
  line.count = static_cast<std::uint32_t>(last - first + 1);
  return true;
}

}  // namespace hexhex
