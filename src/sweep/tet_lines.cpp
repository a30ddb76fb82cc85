#include <algorithm>

#include <sweep/tet_lines.hpp>

#include <lattice/small_boxes.hpp>

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
  const LatticeTet& corners = map.corners[tet];
  const auto [vertexBox, centerBox] = gridBoxes(corners, map.unit);
  if (vertexBox.empty() && centerBox.empty()) return;
  const SmallBoxes small(corners, map.unit);
  if (!vertexBox.empty() && !small.append(vertexBox, 0, vertices)) {
    appendLines(corners, map.unit, vertexBox, chooseSweepAxes(vertexBox), vertices);
  }
  if (!centerBox.empty() && !small.append(centerBox, map.unit / 2, centers)) {
    appendLines(shiftedTo(SweptGrid::Centers, corners, map.unit), map.unit, centerBox,
                chooseSweepAxes(centerBox), centers);
  }
}

void TetLines::store(std::size_t block, const BlockLines& lines) {
  blocks_[block].assign(lines.all().begin(), lines.all().end());
  const auto place = lineBegin_.begin() + static_cast<std::ptrdiff_t>(block * (kSweepBlock + 1));
  *std::copy(lines.begins().begin(), lines.begins().end(), place) =
      static_cast<Index>(lines.all().size());
}

}  // namespace hexhex
