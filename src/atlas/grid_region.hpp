// A part of a map, for a grid of only that part's vertices.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <lattice/swept_line.hpp>

namespace hexhex::atlas {

/// Some tets, and in the chart of each the boxes of grid points that may be asked for. Points
/// beyond may be in the grid or not.
struct GridRegion {
  std::vector<Index> tets;         ///< ascending
  std::vector<std::size_t> begin;  ///< per tet (+1): its boxes; none if all of it counts
  std::vector<lattice::GridBox> boxes;
  /// Per tet: its faces that the boxes may meet, one bit each. The tets behind them are in the
  /// region, too.
  std::vector<std::uint8_t> faces;

  [[nodiscard]] std::span<const lattice::GridBox> boxesOf(std::size_t i) const noexcept {
    return std::span(boxes).subspan(begin[i], begin[i + 1] - begin[i]);
  }
};

/// Whether a box holds all corners of the cell with smallest corner z.
[[nodiscard]] constexpr bool holdsCell(const lattice::GridBox& box,
                                       const lattice::GridPoint& z) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    if (z[k] < box.range[k].first || z[k] >= box.range[k].last) return false;
  }
  return true;
}

/// Consecutive points of a line.
struct LinePoints {
  std::uint32_t first;
  std::uint32_t count;
};

/// The points of a tet's lines that are in boxes.
class BoxedLines {
 public:
  /// @param boxes   if there are none, all points count
  /// @param beyond  0 for points; 1 for cells, by smallest corner: all their corners must be in a
  ///                box
  BoxedLines(std::span<const lattice::GridBox> boxes, std::int32_t beyond) noexcept
      : boxes_(boxes), beyond_(beyond) {}

  /// Disjoint ranges that do not touch, ascending.
  [[nodiscard]] std::span<const LinePoints> of(const lattice::SweptLine& line);

 private:
  /// Coordinates that are in the same boxes.
  struct Known {
    std::int64_t first = std::numeric_limits<std::int64_t>::min();
    std::int64_t end = std::numeric_limits<std::int64_t>::max();

    [[nodiscard]] bool holds(std::int64_t at) const noexcept { return first <= at && at < end; }
  };
  struct Rows {
    Known known;
    std::size_t firstRange;  ///< in `ranges_`
    std::size_t endRange;
  };
  /// The boxes that contain a coordinate.
  /// @return the range in which they stay the same
  [[nodiscard]] Known select(std::span<const lattice::GridBox> from, std::size_t axis,
                             std::int64_t at, std::vector<lattice::GridBox>& selected) const;
  [[nodiscard]] const Rows& rowsOf(const lattice::SweptLine& line);
  void join(std::size_t axis);

  std::span<const lattice::GridBox> boxes_;
  std::int32_t beyond_;
  // Many successive levels, and rows of each, are in the same boxes.
  Known levels_{0, 0};
  std::vector<lattice::GridBox> atLevel_;
  std::vector<lattice::GridBox> atRow_;
  std::vector<Rows> rows_;                  ///< of the levels, as far as seen
  std::vector<lattice::GridRange> ranges_;  ///< along lines; per row: ascending, disjoint
  std::vector<LinePoints> found_;
};

}  // namespace hexhex::atlas
