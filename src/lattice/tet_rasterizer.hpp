// Rasterization of a tet: all grid points of the closed tet, line by line, each with the simplex in
// whose interior it lies (Section 5.2, Algorithms 2 and 3). Also of the grid moved by one half
// along some axes: centres of cells, midpoints of hex edges, centres of hex faces.
//
// On a line of points the plane of every face is an affine function of one integer, so the points
// inside form the interval between the largest zero of the rising planes and the smallest zero of
// the falling ones. Zeros are computed in doubles with a proven bound; where an integer lies within
// the bound of the decisive zero, exact predicates decide at the two ends of the line.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <lattice/tet_geometry.hpp>

namespace hexhex {

/// The integer grid, moved by one half along some axes: bit k for axis k. Grid point z names the
/// point that it is moved to: the centre of a cell is named by the cell's smallest corner.
using HalfGrid = std::uint8_t;
/// Those of hex vertices, and of the centres of hex cells.
inline constexpr HalfGrid kVertexGrid = 0;
inline constexpr HalfGrid kCenterGrid = 7;

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

/// The points of a grid in the bounding box of a tet.
struct GridBox {
  std::array<GridRange, 3> range;
  [[nodiscard]] bool empty() const noexcept {
    return range[0].first > range[0].last || range[1].first > range[1].last ||
           range[2].first > range[2].last;
  }
};

/// The bounding box of a tet on the lattice, by axis.
struct TetBounds {
  std::array<std::int64_t, 3> low;
  std::array<std::int64_t, 3> high;

  explicit TetBounds(const LatticeTet& corners) noexcept;
  /// @param unit  a power of two, at least 2 unless `grid` is that of vertices
  [[nodiscard]] GridBox gridBox(std::int64_t unit, HalfGrid grid = kVertexGrid) const noexcept;
};

[[nodiscard]] inline GridBox gridBox(const LatticeTet& corners, std::int64_t unit,
                                     HalfGrid grid = kVertexGrid) noexcept {
  return TetBounds(corners).gridBox(unit, grid);
}

/// Fewest planes first, longest lines last; ties in order of the axes. (Section 5.2.1)
[[nodiscard]] SweepAxes chooseSweepAxes(const GridBox& box) noexcept;

/// A non-empty line of grid points of a closed tet, along the third sweep axis.
struct SweptLine {
  std::int32_t level;  ///< coordinate along the first sweep axis
  std::int32_t row;    ///< along the second
  std::int32_t first;  ///< along the third, of the first point
  std::uint32_t count;
  CornerMask left;   ///< simplex of the first point
  CornerMask right;  ///< of the last point
  SweepAxes axes;    ///< the same for all lines of a tet

  /// The simplex of all points between: the smallest that contains both ends, by convexity.
  /// (Appendix A.1, its six rules in one)
  [[nodiscard]] CornerMask inner() const noexcept { return static_cast<CornerMask>(left | right); }
  /// The simplex of the i-th point.
  [[nodiscard]] CornerMask simplex(std::uint32_t i) const noexcept {
    return i == 0 ? left : (i + 1 == count ? right : inner());
  }
  /// The i-th point.
  [[nodiscard]] GridPoint point(std::uint32_t i) const noexcept {
    const std::array<std::uint8_t, 3>& a = axes();
    GridPoint z{};
    z[a[0]] = level;
    z[a[1]] = row;
    z[a[2]] = first + static_cast<std::int32_t>(i);
    return z;
  }
  /// Which point a grid point on the line is; not below `count` if it is none.
  [[nodiscard]] std::uint32_t indexOf(const GridPoint& z) const noexcept {
    return static_cast<std::uint32_t>(z[axes()[2]]) - static_cast<std::uint32_t>(first);
  }
  /// Whether all points lie in the interior of the tet.
  [[nodiscard]] bool allInside() const noexcept { return left == kWholeTet && right == kWholeTet; }
};

class TetRasterizer {
 public:
  /// @param corners  of a positive tet; must outlive this
  /// @param unit     a power of two, at least 2 unless just vertices are swept
  /// @param epsilon  enlargement of the tet in parameter units, not negative. It never changes the
  ///                 result: if it is positive, exact predicates decide at the ends of all lines,
  ///                 from wherever the enlarged tet begins (Section 5.2.3), and if it is infinite,
  ///                 on the whole bounding box.
  TetRasterizer(const LatticeTet& corners, std::int64_t unit, double epsilon = 0) noexcept
      : corners_(corners), unit_(unit), epsilon_(epsilon), bounds_(corners) {}

  /// Calls visit(SweptLine) for every line of a grid that meets the closed tet, in sweep order.
  template <class Visit>
  void sweep(HalfGrid grid, const Visit& visit) {
    const GridBox box = bounds_.gridBox(unit_, grid);
    if (box.empty()) return;
    if (!measured_) measure();
    Search search;
    if (!prepare(grid, box, search)) return;
    SweptLine line;
    line.axes = search.axes;
    for (std::int32_t level = 0; level <= search.size[0]; ++level) {
      const ByFace values = valuesAfter(search.values, search.slopes[0], level);
      line.level = search.first[0] + level;
      bool entered = false;
      for (std::int32_t row = 0; row <= search.size[1]; ++row) {
        const Line found = findLine(search, values, row, line);
        if (found == Line::Outside && entered) break;  // the tet is convex
        entered = entered || found != Line::Outside;
        if (found == Line::HasPoints) visit(std::as_const(line));
      }
    }
  }
  /// Appends the lines of a grid.
  void append(HalfGrid grid, std::vector<SweptLine>& lines) {
    sweep(grid, [&](const SweptLine& line) { lines.push_back(line); });
  }

 private:
  /// A number for each face, by opposite corner.
  using ByFace = std::array<double, 4>;

  /// The planes of faces on the lines of one grid: their values are positive inside of the tet.
  struct Search {
    HalfGrid grid;
    SweepAxes axes;
    std::array<std::int32_t, 3> first;  ///< point of the box, by sweep axis
    std::array<std::int32_t, 3> size;   ///< points of the box minus one, by sweep axis
    ByFace values;                      ///< at the first point of the box
    std::array<ByFace, 3> slopes;       ///< by sweep axis
    ByFace errors;                      ///< more than values may be wrong by anywhere in the box
    /// So nearly parallel to the lines that zeros would be useless.
    std::array<bool, 4> isFlat;
    bool hasFlat;      ///< any face
    ByFace toZero;     ///< -1 / slope along the lines; 0 if flat
    ByFace forLow;     ///< added to zeros: 0 if the plane rises, otherwise far below all others
    ByFace forHigh;    ///< likewise: 0 if it falls, otherwise far above
    double zeroError;  ///< bound of the error of all zeros
  };
  /// Outside: the whole line certainly misses the tet, not just its points.
  enum class Line : std::uint8_t { Outside, HasNoPoints, HasPoints };

  /// Values some steps farther.
  [[nodiscard]] static ByFace valuesAfter(const ByFace& values, const ByFace& slopes,
                                          std::int32_t steps) noexcept {
    ByFace there;
    for (std::size_t face = 0; face < 4; ++face) there[face] = values[face] + slopes[face] * steps;
    return there;
  }

  void measure() noexcept;
  /// False if the tet misses the box.
  [[nodiscard]] bool prepare(HalfGrid grid, const GridBox& box, Search& search) const noexcept;
  /// The line at a row relative to the box.
  /// @param values  at the first row
  [[nodiscard]] Line findLine(const Search& search, const ByFace& values, std::int32_t row,
                              SweptLine& line) const noexcept;
  /// The same by exact predicates, among points `first` to `last`; false if it has no points.
  /// @param values  at the line's first point in the box
  [[nodiscard]] bool findExactly(const Search& search, const ByFace& values, std::int32_t first,
                                 std::int32_t last, SweptLine& line) const noexcept;

  const LatticeTet& corners_;
  std::int64_t unit_;
  double epsilon_;
  TetBounds bounds_;
  bool measured_ = false;
  // Then, in grid units relative to a grid point near the tet:
  std::array<std::int32_t, 3> origin_;  ///< that point
  std::array<ByFace, 3> gradients_;     ///< of the faces' planes, by axis
  std::array<ByFace, 3> zeros_;         ///< points of the planes, by axis
  double error_;                        ///< bound of the error of values, see measure()
};

}  // namespace hexhex
