#include <algorithm>

#include <sweep/tet_lines.hpp>

namespace hexhex {

TetSweep::TetSweep(const ExactMap& map, Index tet, SweptGrid grid) noexcept
    : shifted(map.corners[tet]) {
  if (grid == SweptGrid::Centers) {
    for (LatticePoint& corner : shifted) {
      for (std::int64_t& coordinate : corner) coordinate -= map.unit / 2;
    }
  }
  box = gridBox(shifted, map.unit);
  axes = chooseSweepAxes(box);
}

void TetSweep::run(std::int64_t unit, std::vector<SweptLine>& lines) const {
  if (box.empty() || certainlyMisses(shifted, unit, box)) return;
  LineRasterizer(shifted, unit, box, axes).run([&](const SweptLine& line) {
    lines.push_back(line);
  });
}

void TetLines::store(std::size_t block, std::span<const SweptLine> lines,
                     std::span<const Index> begins) {
  blocks_[block].assign(lines.begin(), lines.end());
  std::copy(begins.begin(), begins.end(),
            lineBegin_.begin() + static_cast<std::ptrdiff_t>(block * kSweepBlock));
}

}  // namespace hexhex
