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

}  // namespace

TetSweep::TetSweep(const ExactMap& map, Index tet, SweptGrid grid) noexcept
    : shifted(shiftedTo(grid, map.corners[tet], map.unit)),
      box(gridBox(shifted, map.unit)),
      axes(chooseSweepAxes(box)) {}

void TetSweep::run(std::int64_t unit, std::vector<SweptLine>& lines) const {
  if (box.empty()) return;
  LineRasterizer(shifted, unit, box, axes).run([&](const SweptLine& line) {
    lines.push_back(line);
  });
}

void TetLines::store(std::size_t block, const BlockLines& lines) {
  blocks_[block].assign(lines.all().begin(), lines.all().end());
  const auto place = lineBegin_.begin() + static_cast<std::ptrdiff_t>(block * (kSweepBlock + 1));
  *std::copy(lines.begins().begin(), lines.begins().end(), place) =
      static_cast<Index>(lines.all().size());
}

}  // namespace hexhex
