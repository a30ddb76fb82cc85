// Conservative rasterization of a tet: all grid points of the closed tet, line by line, each with
// the simplex in whose interior it lies (Section 5.2, Algorithms 2 and 3).
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <lattice/tet_geometry.hpp>

namespace hexhex {

/// The four face planes of a tet, prepared for testing many points: exact normals, and their
/// rounded values as a filter.
class TetPlanes {
 public:
  TetPlanes(const LatticeTet& corners, std::int64_t unit) noexcept;

  /// The simplex whose interior contains grid point z, or kNoSimplex outside. (Algorithm 3)
  [[nodiscard]] CornerMask generator(const GridPoint& z) const noexcept;

  /// Barycentric coordinates of z, times a common positive factor, rounded. Not negative for points
  /// of the tet.
  [[nodiscard]] std::array<double, 4> weights(const GridPoint& z) const noexcept;

 private:
  struct Plane {
    LatticePoint origin;
    std::array<Int128, 3> normal;
    std::array<double, 3> roundedNormal;
  };
  [[nodiscard]] int side(const Plane& plane, const LatticePoint& z) const noexcept;

  std::array<Plane, 4> planes_;
  std::int64_t unit_;
  double exactBelow_;  ///< sums of lesser magnitude are exact
};

/// The order in which a tet is swept: planes of constant coordinate axes[0], in them lines of
/// constant axes[1], along axes[2].
struct SweepAxes {
  std::uint8_t index = 0;  ///< of the six permutations

  static constexpr std::array<std::array<std::uint8_t, 3>, 6> kPermutations = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

  [[nodiscard]] constexpr const std::array<std::uint8_t, 3>& operator()() const noexcept {
    return kPermutations[index];
  }
};

/// Range of grid coordinates, inclusive; empty if first > last.
struct GridRange {
  std::int32_t first = 0;
  std::int32_t last = -1;
};

/// The grid points in the bounding box of a tet.
struct GridBox {
  std::array<GridRange, 3> range;
  [[nodiscard]] bool empty() const noexcept {
    return range[0].first > range[0].last || range[1].first > range[1].last ||
           range[2].first > range[2].last;
  }
};

/// @param unit  a power of two
[[nodiscard]] GridBox gridBox(const LatticeTet& corners, std::int64_t unit) noexcept;

/// Fewest planes first, longest lines last; ties in order of the axes. (Section 5.2.1)
/// @param counts  of points, by axis
template <class Count>
[[nodiscard]] constexpr SweepAxes chooseSweepAxes(const std::array<Count, 3>& counts) noexcept {
  // By which axes have fewer points than others before them: 1 than 0, 2 than 1, 2 than 0. A table,
  // as each order is as good as random.
  constexpr std::array<std::uint8_t, 8> kOrders = {0, 2, 1, 5, 0, 3, 4, 5};
  const unsigned fewer = (counts[1] < counts[0] ? 1U : 0U) | (counts[2] < counts[1] ? 2U : 0U) |
                         (counts[2] < counts[0] ? 4U : 0U);
  return {kOrders[fewer]};
}
[[nodiscard]] SweepAxes chooseSweepAxes(const GridBox& box) noexcept;

/// Consecutive grid points of a closed tet along the third sweep axis. The simplices of the two end
/// points and, if there are more than two, the common one of all points between.
struct GridLine {
  std::int32_t first = 0;
  std::int32_t count = 0;  ///< may be 0
  CornerMask left = kNoSimplex;
  CornerMask inner = kNoSimplex;
  CornerMask right = kNoSimplex;

  /// The simplex of the i-th point.
  [[nodiscard]] CornerMask simplex(std::int32_t i) const noexcept {
    return i == 0 ? left : (i == count - 1 ? right : inner);
  }
};

/// Where the tet is cut by one plane, in coordinates of that plane: at most four points, each known
/// up to a box. The intersection lies in the hull of the boxes. (Section 5.2.2)
class EpsilonPolygon {
 public:
  struct Point {
    std::array<double, 2> center;
    std::array<double, 2> halfSize;
  };
  void add(const Point& point) noexcept { points_[static_cast<std::size_t>(size_++)] = point; }

  /// Conservative range of the polygon's first coordinate.
  [[nodiscard]] std::array<double, 2> extent(double epsilon) const noexcept;
  /// Conservative range of the second coordinate on the line where the first one is y.
  [[nodiscard]] std::array<double, 2> section(double y, double epsilon) const noexcept;

 private:
  // A plane meets a tet in at most four points; points on tet vertices and on edges exclude each
  // other.
  std::array<Point, 4> points_;
  int size_ = 0;
};

class TetRasterizer {
 public:
  /// Above this enlargement the bounding box decides, as for infinity: no tet of a map has room for
  /// it, and arithmetic on it could overflow.
  static constexpr double kEverything = 1e9;

  /// @param epsilon  enlargement of the tet in parameter units (not times unit), >= 0
  TetRasterizer(const LatticeTet& corners, std::int64_t unit, const GridBox& box, SweepAxes axes,
                double epsilon) noexcept;

  /// Calls sink.plane(y0) for every plane of the box, in ascending order, then sink.line(GridLine)
  /// for consecutive lines from y0 on.
  template <class Sink>
  void run(Sink& sink) const {
    const std::array<std::uint8_t, 3>& axes = axes_();
    const GridRange planes = box_.range[axes[0]];
    for (std::int32_t level = planes.first; level <= planes.last; ++level) {
      const EpsilonPolygon polygon = cut(level);
      const GridRange lines = everything_ ? box_.range[axes[1]]
                                          : clamped(polygon.extent(epsilon_), box_.range[axes[1]]);
      sink.plane(lines.first);
      for (std::int32_t y = lines.first; y <= lines.last; ++y) {
        const GridRange candidates =
            everything_ ? box_.range[axes[2]]
                        : clamped(polygon.section(y, epsilon_), box_.range[axes[2]]);
        sink.line(exactLine(level, y, candidates));
      }
    }
  }

  [[nodiscard]] const TetPlanes& planes() const noexcept { return planes_; }

 private:
  [[nodiscard]] EpsilonPolygon cut(std::int32_t level) const noexcept;
  [[nodiscard]] GridLine exactLine(std::int32_t level, std::int32_t y,
                                   GridRange candidates) const noexcept;
  [[nodiscard]] static GridRange clamped(const std::array<double, 2>& range,
                                         GridRange limits) noexcept;

  TetPlanes planes_;
  LatticeTet corners_;
  std::int64_t unit_;
  GridBox box_;
  SweepAxes axes_;
  double epsilon_;
  bool everything_;
};

}  // namespace hexhex
