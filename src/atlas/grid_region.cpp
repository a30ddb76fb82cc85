// Selects the points of lines that are in boxes.
#include <algorithm>
#include <cassert>
#include <limits>

#include <atlas/grid_region.hpp>

namespace hexhex::atlas {

std::span<const LinePoints> BoxedLines::of(const lattice::SweptLine& line) {
  found_.clear();
  if (boxes_.empty()) {
    found_.push_back({0, line.count});
    return found_;
  }
  const std::array<std::uint8_t, 3>& axes = line.axes();
  if (!levels_.holds(line.level)) {
    levels_ = select(boxes_, axes[0], line.level, atLevel_);
    rows_ = {};
  }
  if (!rows_.holds(line.row)) {
    rows_ = select(atLevel_, axes[1], line.row, atRow_);
    join(axes[2]);
  }
  assert(std::ranges::all_of(boxes_, [](const lattice::GridBox& box) {
    return std::ranges::all_of(box.range, [](auto range) { return range.first <= range.last; });
  }));
  const std::int64_t last = std::int64_t{line.first} + line.count - 1;
  for (const lattice::GridRange& range : ranges_) {
    const std::int64_t first = std::max(line.first, range.first);
    const std::int64_t end = std::min<std::int64_t>(last, range.last) + 1;
    if (first >= end) continue;
    found_.push_back(
        {static_cast<std::uint32_t>(first - line.first), static_cast<std::uint32_t>(end - first)});
  }
  return found_;
}

BoxedLines::Known BoxedLines::select(std::span<const lattice::GridBox> from, std::size_t axis,
                                     std::int64_t at,
                                     std::vector<lattice::GridBox>& selected) const {
  selected.clear();
  Known known{at, std::numeric_limits<std::int64_t>::max()};
  for (const lattice::GridBox& box : from) {
    const std::int64_t end = std::int64_t{box.range[axis].last} - beyond_ + 1;
    if (at < box.range[axis].first) {
      known.end = std::min<std::int64_t>(known.end, box.range[axis].first);
    } else if (at < end) {
      known.end = std::min(known.end, end);
      selected.push_back(box);
    }
  }
  return known;
}

/// Joins the boxes of a row to ranges along it.
void BoxedLines::join(std::size_t axis) {
  ranges_.clear();
  for (const lattice::GridBox& box : atRow_) {
    ranges_.push_back({box.range[axis].first, box.range[axis].last - beyond_});
  }
  std::sort(
      ranges_.begin(), ranges_.end(),
      [](const lattice::GridRange& a, const lattice::GridRange& b) { return a.first < b.first; });
  std::size_t count = 0;
  for (const lattice::GridRange& next : ranges_) {
    if (count == 0 || next.first > ranges_[count - 1].last + 1) {
      ranges_[count++] = next;
    } else {
      ranges_[count - 1].last = std::max(ranges_[count - 1].last, next.last);
    }
  }
  ranges_.resize(count);
}

}  // namespace hexhex::atlas
