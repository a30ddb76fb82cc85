#include <algorithm>

#include <sweep/tet_lines.hpp>

namespace hexhex {

namespace {

LatticeTet shiftedTo(SweptGrid grid, LatticeTet corners, std::int64_t unit) noexcept {
  if (grid == SweptGrid::Centers) {
    for (LatticePoint& corner : corners) {
      for (std::int64_t& coordinate : corner) coordinate -= unit / 2;
    }
  }
  return corners;
}

void appendLines(const LatticeTet& shifted, std::int64_t unit, const GridBox& box, SweepAxes axes,
                 std::vector<SweptLine>& lines) {
  LineRasterizer(shifted, unit, box, axes).run([&](const SweptLine& line) {
    lines.push_back(line);
  });
}

}  // namespace

TetSweep::TetSweep(const ExactMap& map, Index tet, SweptGrid grid) noexcept
    : shifted(shiftedTo(grid, map.corners[tet], map.unit)),
      box(gridBox(shifted, map.unit)),
      axes(chooseSweepAxes(box)) {}

void TetSweep::run(std::int64_t unit, std::vector<SweptLine>& lines) const {
  if (!box.empty()) appendLines(shifted, unit, box, axes, lines);
}

void sweepBoth(const ExactMap& map, Index tet, std::vector<SweptLine>& vertices,
               std::vector<SweptLine>& centers) {
  // Most tets of a coarse map contain no point of either grid.
  const LatticeTet& corners = map.corners[tet];
  const auto [vertexBox, centerBox] = gridBoxes(corners, map.unit);
  const bool mayHaveVertices = !vertexBox.empty();
  const bool mayHaveCenters = !centerBox.empty();
  if (!mayHaveVertices && !mayHaveCenters) return;
  const EmptinessTest test(corners, map.unit);
  if (mayHaveVertices && !test.certainlyMisses(vertexBox, 0)) {
    appendLines(corners, map.unit, vertexBox, chooseSweepAxes(vertexBox), vertices);
  }
  if (mayHaveCenters && !test.certainlyMisses(centerBox, 0.5)) {
    appendLines(shiftedTo(SweptGrid::Centers, corners, map.unit), map.unit, centerBox,
                chooseSweepAxes(centerBox), centers);
  }
}

void TetLines::store(std::size_t block, std::span<const SweptLine> lines,
                     std::span<const Index> begins) {
  blocks_[block].assign(lines.begin(), lines.end());
  std::copy(begins.begin(), begins.end(),
            lineBegin_.begin() + static_cast<std::ptrdiff_t>(block * kSweepBlock));
}

}  // namespace hexhex
