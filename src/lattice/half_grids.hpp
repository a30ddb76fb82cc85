// The grid points of one tet, and those of the grid moved by one half along some axes: centres of
// cells, midpoints of edges and faces. All of them are points of the grid of half the width, and
// what finding them has in common is done once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include <base/pair.hpp>
#include <lattice/box_limits.hpp>
#include <lattice/half_box.hpp>
#include <lattice/line_rasterizer.hpp>
#include <lattice/weight_field.hpp>

namespace hexhex {

/// Which grids are to be swept, and where their points are in small boxes.
class HalfGridSearch {
 public:
  /// Small boxes have fewer points along each axis.
  static constexpr std::int32_t kSide = 4;
  /// Places in a small box, relative to its first point: two bits per axis name one.
  using PlaceSet = std::uint64_t;

  explicit constexpr HalfGridSearch(HalfGridSet wanted) noexcept : wanted_(wanted) {
    for (unsigned parities = 0; parities < 8; ++parities) {
      for (unsigned place = 0; place < 64; ++place) {
        const unsigned moved = (place & 1U) | ((place >> 1) & 2U) | ((place >> 2) & 4U);
        const unsigned isWanted = (unsigned{wanted} >> (moved ^ parities)) & 1U;
        places_[parities] |= PlaceSet{isWanted} << place;
      }
    }
  }

  [[nodiscard]] constexpr HalfGridSet wanted() const noexcept { return wanted_; }

  /// The wanted points of a small box that is not empty.
  [[nodiscard]] PlaceSet placesIn(const HalfBox& box) const noexcept {
    unsigned parities = 0;
    PlaceSet inBox = ~PlaceSet{0};
    for (std::size_t k = 0; k < 3; ++k) {
      parities |= static_cast<unsigned>(box.first[k] & 1) << k;
      inBox &= kWithin[k][static_cast<std::size_t>(box.steps[k])];
    }
    return places_[parities] & inBox;
  }

 private:
  /// By axis and steps of a box: the places within.
  static constexpr std::array<std::array<PlaceSet, kSide>, 3> kWithin = [] {
    std::array<std::array<PlaceSet, kSide>, 3> sets{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (unsigned place = 0; place < 64; ++place) {
        for (std::size_t steps = (place >> (2 * k)) & 3U; steps < kSide; ++steps) {
          sets[k][steps] |= PlaceSet{1} << place;
        }
      }
    }
    return sets;
  }();

  HalfGridSet wanted_;
  std::array<PlaceSet, 8> places_{};  ///< by which coordinates of the first point are odd
};

/// Sweeps a tet for the points of one grid after the other.
///
/// The four weights of a point, barycentric coordinates, are computed in floating point with a
/// proven bound, two at a time. Small tets are compared with all points of their bounding box at
/// once; exact predicates look at those that are too close to a face. In larger tets, the weights
/// tell where lines of points begin and end, as in LineRasterizer, but for all grids together.
/// Grids with a line that this does not decide, and those of tets with many lines, are swept by
/// LineRasterizer.
class HalfGrids {
 public:
  /// @param search  for the grids that may be swept
  HalfGrids(const LatticeTet& corners, std::int64_t unit, const HalfGridSearch& search) noexcept;

  /// The wanted grids that may have points in the tet.
  [[nodiscard]] HalfGridSet occupied() const noexcept { return occupied_; }

  /// Calls visit(SweptLine) for every line of a wanted grid that meets the closed tet, in sweep
  /// order.
  /// @return the order of the sweep; any, if there are no lines
  template <class Visit>
  SweepAxes sweep(HalfGrid grid, const Visit& visit) const {
    if ((occupied_ & halfGridBit(grid)) == 0) return {};
    const GridBox box = box_.of(grid);
    const SweepAxes axes = chooseSweepAxes(box);
    if (small_) {
      SweepPoints points;
      visitPoints(std::span(points).first(sortInside(grid, axes, points)), axes, visit);
    } else {
      Lines lines;
      if (findLines(grid, box, axes, lines)) {
        visitLines(lines, box, axes, visit);
      } else {
        const LatticeTet back = movedBack(grid);
        LineRasterizer(back, unit_, box, axes).run(visit);
      }
    }
    return axes;
  }

 private:
  static constexpr std::size_t kPlaces = 64;
  /// Where LineRasterizer, which leaves out rows that miss the tet, becomes faster.
  static constexpr std::int64_t kMostLines = 64;
  /// Steps of boxes for which weights are computed.
  static constexpr std::int32_t kMostSteps = 1 << 10;

  /// Volumes, in halves.
  using Weights = CornerWeights;

  /// A point of the tet.
  struct Inside {
    GridPoint z;
    HalfGrid grid;
    CornerMask simplex;
  };
  /// A point by sweep axis.
  struct SweepPoint {
    std::array<std::int32_t, 3> at;
    CornerMask simplex;
  };
  using SweepPoints = std::array<SweepPoint, kPlaces>;
  /// Points of a line of a box, relative to it.
  struct Run {
    std::int32_t level;
    std::int32_t row;
    std::int32_t first;
    std::int32_t last;
  };
  /// Lines with points, in sweep order.
  struct Lines {
    std::array<Run, kMostLines + 1> runs;  ///< one more than there may be
    std::size_t count = 0;
    BoxLimits limits;
  };

  void measure(std::int32_t most) noexcept;
  void comparePoints(HalfGridSearch::PlaceSet places) noexcept;
  [[nodiscard]] Weights weightsAt(const std::array<double, 3>& steps) const noexcept {
    return atOrigin_.plus(gradient_[0], steps[0])
        .plus(gradient_[1], steps[1])
        .plus(gradient_[2], steps[2]);
  }
  [[nodiscard]] CornerMask exactSimplexOf(const std::array<std::int32_t, 3>& steps) const noexcept;
  /// The points of a grid, in sweep order.
  /// @return their number
  std::size_t sortInside(HalfGrid grid, SweepAxes axes, SweepPoints& points) const noexcept;
  /// @return false if it does not decide on all lines
  [[nodiscard]] bool findLines(HalfGrid grid, const GridBox& box, SweepAxes sweepAxes,
                               Lines& lines) const noexcept;
  /// How the weights change along lines. Each vanishes on a line at most once: rising ones where
  /// the tet begins, falling ones where it ends.
  struct Slopes {
    std::array<Pair, 2> toZero;    ///< -1 / slope; 0 for limits
    std::array<Pair, 2> lowBias;   ///< 0 for rising weights, else -infinity
    std::array<Pair, 2> highBias;  ///< 0 for falling weights, else infinity
    double zeroError;              ///< bound of the error of zeros
    Pair least;                    ///< limits of both ends of lines
    Pair most;
    bool areClear;  ///< all weights change enough for that bound
  };
  [[nodiscard]] Slopes slopesAlong(std::size_t axis, unsigned limits,
                                   std::int32_t steps) const noexcept;
  [[nodiscard]] static IntPair runOf(const Weights& weights, const Slopes& slopes,
                                     IntPair& unsure) noexcept;
  [[nodiscard]] BoxLimits limitsOf(HalfGrid grid, const GridBox& box,
                                   SweepAxes axes) const noexcept;
  template <class Visit>
  static void visitPoints(std::span<const SweepPoint> points, SweepAxes axes, const Visit& visit) {
    for (std::size_t i = 0; i < points.size();) {
      const auto& [level, row, first] = points[i].at;
      const CornerMask left = points[i].simplex;
      // Tets are convex: what they have of a line is consecutive.
      std::uint32_t count = 0;
      while (i < points.size() && points[i].at[0] == level && points[i].at[1] == row) ++count, ++i;
      const SweptLine line{level, row, first, count, left, points[i - 1].simplex, axes};
      visit(line);
    }
  }
  template <class Visit>
  static void visitLines(const Lines& lines, const GridBox& box, SweepAxes sweepAxes,
                         const Visit& visit) {
    const std::array<std::uint8_t, 3>& axes = sweepAxes();
    const GridRange& levels = box.range[axes[0]];
    const GridRange& rows = box.range[axes[1]];
    const GridRange& points = box.range[axes[2]];
    for (const Run& run : std::span(lines.runs).first(lines.count)) {
      const std::int32_t level = levels.first + run.level;
      const std::int32_t row = rows.first + run.row;
      const std::int32_t first = points.first + run.first;
      const std::int32_t last = points.first + run.last;
      SweptLine line{level,     row,       first,    static_cast<std::uint32_t>(last - first + 1),
                     kWholeTet, kWholeTet, sweepAxes};
      if (lines.limits.hold) {
        const auto simplexAt = [&](std::int32_t point) {
          return lines.limits.inside(
              {level == levels.first, row == rows.first, point == points.first},
              {level == levels.last, row == rows.last, point == points.last});
        };
        line.left = simplexAt(first);
        line.right = simplexAt(last);
      }
      visit(std::as_const(line));
    }
  }
  /// The tet, moved so that the points of the grid become integers.
  [[nodiscard]] LatticeTet movedBack(HalfGrid grid) const noexcept;

  const LatticeTet& corners_;
  std::int64_t unit_;
  HalfBox box_;
  HalfGridSet occupied_ = 0;
  bool small_ = false;
  bool measured_ = false;       ///< whether there are weights
  bool mayHaveLimits_ = false;  ///< unless no face of a large tet is across an axis
  std::size_t insideCount_ = 0;
  // Of weights, if there are any, at the box's first point and from point to point along each axis:
  Weights atOrigin_;
  std::array<Weights, 3> gradient_;
  double error_;                        ///< bound of the error of weights in the box
  std::array<Inside, kPlaces> inside_;  ///< of small tets
};

}  // namespace hexhex
