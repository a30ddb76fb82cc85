// Selects the points of lines that are in boxes.
#include <algorithm>
#include <cassert>

#include <atlas/grid_region.hpp>

namespace hexhex::atlas {

std::span<const LinePoints> BoxedLines::of(const lattice::SweptLine& line) {
  found_.clear();
  if (boxes_.empty()) {
    found_.push_back({0, line.count});
    return found_;
  }
  assert(std::ranges::all_of(boxes_, [](const lattice::GridBox& box) {
    return std::ranges::all_of(box.range, [](auto range) { return range.first <= range.last; });
  }));
  const Rows& rows = rowsOf(line);
  const std::int64_t last = std::int64_t{line.first} + line.count - 1;
  for (std::size_t r = rows.firstRange; r < rows.endRange; ++r) {
    const std::int64_t first = std::max(line.first, ranges_[r].first);
    const std::int64_t end = std::min<std::int64_t>(last, ranges_[r].last) + 1;
    if (first >= end) continue;
    found_.push_back(
        {static_cast<std::uint32_t>(first - line.first), static_cast<std::uint32_t>(end - first)});
  }
  return found_;
}

const BoxedLines::Rows& BoxedLines::rowsOf(const lattice::SweptLine& line) {
  const std::array<std::uint8_t, 3>& axes = line.axes();
  if (!levels_.holds(line.level)) {
    levels_ = select(boxes_, axes[0], line.level, atLevel_);
    rows_.clear();
    ranges_.clear();
  }
  const auto known = std::find_if(rows_.begin(), rows_.end(),
                                  [&](const Rows& rows) { return rows.known.holds(line.row); });
  if (known != rows_.end()) return *known;
  const std::size_t firstRange = ranges_.size();
  const Known rows = select(atLevel_, axes[1], line.row, atRow_);
  join(axes[2]);
  return rows_.emplace_back(Rows{rows, firstRange, ranges_.size()});
}

BoxedLines::Known BoxedLines::select(std::span<const lattice::GridBox> from, std::size_t axis,
                                     std::int64_t at,
                                     std::vector<lattice::GridBox>& selected) const {
  selected.clear();
  Known known;
  for (const lattice::GridBox& box : from) {
    const std::int64_t end = std::int64_t{box.range[axis].last} - beyond_ + 1;
    if (at < box.range[axis].first) {
      known.end = std::min<std::int64_t>(known.end, box.range[axis].first);
    } else if (at < end) {
      known.first = std::max<std::int64_t>(known.first, box.range[axis].first);
      known.end = std::min(known.end, end);
      selected.push_back(box);
    } else {
      known.first = std::max(known.first, end);
    }
  }
  return known;
}

/// Joins the boxes of a row to ranges along it, after those of other rows.
void BoxedLines::join(std::size_t axis) {
  std::sort(atRow_.begin(), atRow_.end(),
            [axis](const lattice::GridBox& a, const lattice::GridBox& b) {
              return a.range[axis].first < b.range[axis].first;
            });
  const std::size_t firstRange = ranges_.size();
  for (const lattice::GridBox& box : atRow_) {
    const lattice::GridRange next = {box.range[axis].first, box.range[axis].last - beyond_};
    if (ranges_.size() == firstRange || next.first > ranges_.back().last + 1) {
      ranges_.push_back(next);
    } else {
      ranges_.back().last = std::max(ranges_.back().last, next.last);
    }
  }
}

}  // namespace hexhex::atlas
