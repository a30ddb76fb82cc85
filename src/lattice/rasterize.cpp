#include <algorithm>

#include <lattice/rasterize.hpp>

namespace hexhex {

TetPlanes::TetPlanes(const LatticeTet& corners, std::int64_t unit) noexcept : unit_(unit) {
  std::int64_t bits = unit;
  for (const LatticePoint& corner : corners) bits |= corner[0] | corner[1] | corner[2];
  exactBelow_ = exactBelow(bits);
  for (std::size_t face = 0; face < 4; ++face) {
    Plane& plane = planes_[face];
    plane.origin = corners[static_cast<std::size_t>(kFaceCorners[face][0])];
    const LatticePoint a = corners[static_cast<std::size_t>(kFaceCorners[face][1])] - plane.origin;
    const LatticePoint b = corners[static_cast<std::size_t>(kFaceCorners[face][2])] - plane.origin;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      plane.normal[axis] = crossComponent(a, b, axis);
      plane.roundedNormal[axis] = signedToDouble(plane.normal[axis]);
    }
  }
}

int TetPlanes::side(const Plane& plane, const LatticePoint& z) const noexcept {
  const LatticePoint offset = z - plane.origin;
  double sum = 0;
  double magnitude = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double term = plane.roundedNormal[axis] * static_cast<double>(offset[axis]);
    sum += term;
    magnitude += std::abs(term);
  }
  // Each term carries two conversions, one of them in two roundings, and one multiplication, the
  // sum two additions: an error below 6.1 * 2^-53 times the sum of magnitudes. 2^-50 leaves room
  // for the rounding of `magnitude`.
  constexpr double kRelativeError = 0x1p-50;
  if (sum > kRelativeError * magnitude) return 1;
  if (sum < -kRelativeError * magnitude) return -1;
  // Components of normals that need more than 53 bits make greater magnitudes, or are multiplied by
  // zero.
  if (magnitude < exactBelow_) return (sum > 0 ? 1 : 0) - (sum < 0 ? 1 : 0);
  Int192 exact;
  for (std::size_t axis = 0; axis < 3; ++axis) exact.addProduct(plane.normal[axis], offset[axis]);
  return exact.sign();
}

CornerMask TetPlanes::generator(const GridPoint& z) const noexcept {
  const LatticePoint point = {z[0] * unit_, z[1] * unit_, z[2] * unit_};
  return simplexBySides([&](std::size_t face) { return side(planes_[face], point); });
}

std::array<double, 4> TetPlanes::weights(const GridPoint& z) const noexcept {
  std::array<double, 4> weights{};
  for (std::size_t face = 0; face < 4; ++face) {
    const Plane& plane = planes_[face];
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum += plane.roundedNormal[axis] * static_cast<double>(z[axis] * unit_ - plane.origin[axis]);
    }
    weights[face] = std::max(sum, 0.0);
  }
  return weights;
}

namespace {

/// Least and largest coordinate of the corners, without branches.
std::array<std::int64_t, 2> extent(const LatticeTet& corners, std::size_t axis) {
  const auto least = [](std::int64_t a, std::int64_t b) { return a < b ? a : b; };
  const auto largest = [](std::int64_t a, std::int64_t b) { return a < b ? b : a; };
  return {
      least(least(corners[0][axis], corners[1][axis]), least(corners[2][axis], corners[3][axis])),
      largest(largest(corners[0][axis], corners[1][axis]),
              largest(corners[2][axis], corners[3][axis]))};
}

/// Grid coordinates in a range of lattice coordinates.
GridRange rangeBetween(std::int64_t low, std::int64_t high, int shift) {
  // Right shifts of signed integers round down (C++20): ceil(low) = -floor(-low).
  return {static_cast<std::int32_t>(-((-low) >> shift)), static_cast<std::int32_t>(high >> shift)};
}

}  // namespace

GridBox gridBox(const LatticeTet& corners, std::int64_t unit) noexcept {
  const int shift = std::countr_zero(static_cast<std::uint64_t>(unit));
  GridBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = extent(corners, axis);
    box.range[axis] = rangeBetween(low, high, shift);
  }
  return box;
}

SweepAxes chooseSweepAxes(const GridBox& box) noexcept {
  std::array<std::int64_t, 3> counts{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    counts[axis] = std::int64_t{box.range[axis].last} - box.range[axis].first;
  }
  return chooseSweepAxes(counts);
}

std::array<double, 2> EpsilonPolygon::extent(double epsilon) const noexcept {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int i = 0; i < size_; ++i) {
    const Point& p = points_[static_cast<std::size_t>(i)];
    low = std::min(low, p.center[0] - p.halfSize[0]);
    high = std::max(high, p.center[0] + p.halfSize[0]);
  }
  return {low - epsilon, high + epsilon};
}

std::array<double, 2> EpsilonPolygon::section(double y, double epsilon) const noexcept {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  // The polygon is the hull of its points, and the hull's section is the hull of the sections of
  // all segments between two of them, diagonals included.
  for (int i = 0; i < size_; ++i) {
    for (int j = i; j < size_; ++j) {
      const Point* p = &points_[static_cast<std::size_t>(i)];
      const Point* q = &points_[static_cast<std::size_t>(j)];
      if (p->center[0] > q->center[0]) std::swap(p, q);
      const double halfSizeY = std::max(p->halfSize[0], q->halfSize[0]) + epsilon;
      const double halfSizeX = std::max(p->halfSize[1], q->halfSize[1]) + epsilon;
      const double rise = q->center[0] - p->center[0];
      if (y < p->center[0] - halfSizeY || y > q->center[0] + halfSizeY) continue;
      double left = std::min(p->center[1], q->center[1]);
      double right = std::max(p->center[1], q->center[1]);
      if (rise > 2 * halfSizeY) {
        // A point of the hull of both boxes at height y divides it in a ratio that differs from the
        // centre line's by at most halfSizeY / rise, and is at most halfSizeX beside it.
        const double slope = (q->center[1] - p->center[1]) / rise;
        const double t = std::clamp(y - p->center[0], 0.0, rise);
        const double x = p->center[1] + t * slope;
        const double slack = std::abs(slope) * halfSizeY;
        left = std::max(left, x - slack);
        right = std::min(right, x + slack);
      }
      low = std::min(low, left - halfSizeX);
      high = std::max(high, right + halfSizeX);
    }
  }
  return {low, high};
}

TetRasterizer::TetRasterizer(const LatticeTet& corners, std::int64_t unit, const GridBox& box,
                             SweepAxes axes, double epsilon) noexcept
    : planes_(corners, unit),
      corners_(corners),
      unit_(unit),
      box_(box),
      axes_(axes),
      epsilon_(epsilon),
      everything_(!(epsilon < kEverything)) {}

EpsilonPolygon TetRasterizer::cut(std::int32_t level) const noexcept {
  const std::array<std::uint8_t, 3>& axes = axes_();
  const std::int64_t height = level * unit_;
  const double scale = 1.0 / static_cast<double>(unit_);
  const auto coordinate = [&](std::size_t corner, int axis) {
    return static_cast<double>(corners_[corner][axes[static_cast<std::size_t>(axis)]]) * scale;
  };
  EpsilonPolygon polygon;
  for (std::size_t a = 0; a < 4; ++a) {
    if (corners_[a][axes[0]] == height) polygon.add({{coordinate(a, 1), coordinate(a, 2)}, {}});
    for (std::size_t b = 0; b < 4; ++b) {
      // Edges that cross the plane, each once: from below to above.
      if (corners_[a][axes[0]] >= height || corners_[b][axes[0]] <= height) continue;
      const double rise = static_cast<double>(corners_[b][axes[0]] - corners_[a][axes[0]]) * scale;
      const double t = static_cast<double>(height - corners_[a][axes[0]]) * scale / rise;
      EpsilonPolygon::Point point{};
      for (int k = 0; k < 2; ++k) {
        const double run = coordinate(b, k + 1) - coordinate(a, k + 1);
        point.center[static_cast<std::size_t>(k)] = coordinate(a, k + 1) + t * run;
        point.halfSize[static_cast<std::size_t>(k)] = epsilon_ + epsilon_ * std::abs(run) / rise;
      }
      polygon.add(point);
    }
  }
  return polygon;
}

GridLine TetRasterizer::exactLine(std::int32_t level, std::int32_t y,
                                  GridRange candidates) const noexcept {
  const std::array<std::uint8_t, 3>& axes = axes_();
  GridPoint z{};
  z[axes[0]] = level;
  z[axes[1]] = y;
  const auto generatorAt = [&](std::int32_t x) {
    z[axes[2]] = x;
    return planes_.generator(z);
  };
  GridLine line;
  line.first = candidates.first;
  for (; line.first <= candidates.last; ++line.first) {
    line.left = generatorAt(line.first);
    if (line.left != kNoSimplex) break;
  }
  if (line.left == kNoSimplex) return line;
  std::int32_t last = candidates.last;
  line.right = line.left;
  for (; last > line.first; --last) {
    line.right = generatorAt(last);
    if (line.right != kNoSimplex) break;
  }
  if (last == line.first) line.right = line.left;
  line.count = last - line.first + 1;
  // By convexity all points between lie in the tet, in the interior of the smallest simplex that
  // contains both ends. (Appendix A.1, its six rules in one)
  line.inner = static_cast<CornerMask>(line.left | line.right);
  return line;
}

GridRange TetRasterizer::clamped(const std::array<double, 2>& range, GridRange limits) noexcept {
  // Negated comparisons: an empty or undefined range keeps the limits' safe side.
  const double low = std::ceil(range[0]);
  const double high = std::floor(range[1]);
  if (low > static_cast<double>(limits.last) || high < static_cast<double>(limits.first)) {
    return {limits.first, limits.first - 1};
  }
  return {low > static_cast<double>(limits.first) ? static_cast<std::int32_t>(low) : limits.first,
          high < static_cast<double>(limits.last) ? static_cast<std::int32_t>(high) : limits.last};
}

}  // namespace hexhex
