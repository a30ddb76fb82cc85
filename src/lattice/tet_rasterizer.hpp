// Rasterization of a tet: all grid points of the closed tet, line by line, each with the simplex
// whose interior contains it (Section 5.2, Algorithms 2 and 3). Also for the grid shifted by one
// half along some axes: cell centres, midpoints of hex edges, centres of hex faces.
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

#include <lattice/few_points.hpp>

namespace hexhex::lattice {

/// The bounding box of a tet on the lattice, by axis.
struct TetBounds {
  std::array<std::int64_t, 3> low;
  std::array<std::int64_t, 3> high;

  TetBounds() = default;
  explicit TetBounds(const LatticeTet& corners) noexcept;
  /// @param unit  a power of two, at least 2 unless `grid` is the vertex grid
  [[nodiscard]] GridBox gridBox(std::int64_t unit, HalfGrid grid = kVertexGrid) const noexcept;
};

[[nodiscard]] inline GridBox gridBox(const LatticeTet& corners, std::int64_t unit,
                                     HalfGrid grid = kVertexGrid) noexcept {
  return TetBounds(corners).gridBox(unit, grid);
}

class TetRasterizer {
 public:
  /// @param corners  of a positive tet; must outlive this
  /// @param unit     a power of two, at least 2 unless only vertices are swept
  /// @param epsilon  enlargement of the tet in parameter units, not negative. It never changes the
  ///                 result: if it is positive, exact predicates decide at the ends of all lines,
  ///                 starting where the enlarged tet begins (Section 5.2.3); if it is infinite, on
  ///                 the whole bounding box.
  /// @param fewPoints  whether points may be compared one by one where there are few
  TetRasterizer(const LatticeTet& corners, std::int64_t unit, double epsilon = 0,
                bool fewPoints = true) noexcept
      : corners_(corners),
        unit_(unit),
        epsilon_(epsilon),
        fewPoints_(corners, unit),
        areFew_(fewPoints && !(epsilon > 0) && fewPoints_.areFew()) {}

  /// Calls visit(SweptLine) for every line of a grid that meets the closed tet, in sweep order.
  template <class Visit>
  void sweep(HalfGrid grid, const Visit& visit) {
    if (areFew_) {
      fewPoints_.sweep(grid, visit);
      return;
    }
    if (!measured_) measure();
    const GridBox box = bounds_.gridBox(unit_, grid);
    if (box.empty()) return;
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
  /// One number per face, by opposite corner.
  using ByFace = std::array<double, 4>;

  /// The planes of the faces on the lines of one grid; values are positive inside the tet.
  struct Search {
    HalfGrid grid;
    SweepAxes axes;
    std::array<std::int32_t, 3> first;  ///< point of the box, per sweep axis
    std::array<std::int32_t, 3> size;   ///< points of the box minus one, per sweep axis
    ByFace values;                      ///< at the first point of the box
    std::array<ByFace, 3> slopes;       ///< per sweep axis
    ByFace errors;                      ///< bound of the error of values anywhere in the box
    /// So nearly parallel to the lines that its zero would be useless.
    std::array<bool, 4> isFlat;
    bool hasFlat;      ///< whether any face is
    ByFace toZero;     ///< -1 / slope along the lines; 0 if flat
    ByFace forLow;     ///< added to zeros: 0 if the plane rises, otherwise far below all others
    ByFace forHigh;    ///< likewise: 0 if it falls, otherwise far above
    double zeroError;  ///< error bound of all zeros
  };
  /// Outside: the whole line certainly misses the tet, not just its points.
  enum class Line : std::uint8_t { Outside, HasNoPoints, HasPoints };

  /// The values some steps on.
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
  /// The same with exact predicates, among points `first` to `last`; false if it has no points.
  /// @param values  at the line's first point in the box
  [[nodiscard]] bool findExactly(const Search& search, const ByFace& values, std::int32_t first,
                                 std::int32_t last, SweptLine& line) const noexcept;

  const LatticeTet& corners_;
  std::int64_t unit_;
  double epsilon_;
  FewPoints fewPoints_;
  bool areFew_;
  bool measured_ = false;
  TetBounds bounds_;
  // In grid units relative to a grid point near the tet:
  std::array<std::int32_t, 3> origin_;  ///< that point
  std::array<ByFace, 3> gradients_;     ///< of the faces' planes, per axis
  std::array<ByFace, 3> zeros_;         ///< points of the planes, per axis
  double error_;                        ///< error bound of values, see measure()
  bool isExact_;                        ///< so few digits that values are exact
};

}  // namespace hexhex::lattice
