#include <atlas/grid_region.hpp>

namespace hexhex {

std::span<const LinePoints> BoxedLines::of(const SweptLine& line) {
  found_.clear();
  if (boxes_.empty()) {
    found_.push_back({0, line.count});
    return found_;
  }
  const std::array<std::uint8_t, 3>& axes = line.axes();
  const auto holds = [&](const GridBox& box, std::size_t k, std::int32_t at) {
    const GridRange& range = box.range[axes[k]];
    return range.first <= at && at <= range.last - beyond_;
  };
  if (!hasLevel_ || level_ != line.level) {
    hasLevel_ = true;
    level_ = line.level;
    atLevel_.clear();
    for (const GridBox& box : boxes_) {
      if (holds(box, 0, level_)) atLevel_.push_back(box);
    }
  }
  const std::int64_t end = std::int64_t{line.first} + line.count;
  for (const GridBox& box : atLevel_) {
    if (!holds(box, 1, line.row)) continue;
    const GridRange& along = box.range[axes[2]];
    const std::int64_t first = std::max<std::int64_t>(line.first, along.first);
    const std::int64_t stop = std::min<std::int64_t>(end, std::int64_t{along.last} - beyond_ + 1);
    if (first >= stop) continue;
    found_.push_back(
        {static_cast<std::uint32_t>(first - line.first), static_cast<std::uint32_t>(stop - first)});
  }
  if (found_.size() < 2) return found_;
  std::sort(found_.begin(), found_.end(),
            [](const LinePoints& a, const LinePoints& b) { return a.first < b.first; });
  std::size_t last = 0;
  for (const LinePoints& next : std::span(found_).subspan(1)) {
    LinePoints& before = found_[last];
    if (next.first > before.first + before.count) {
      found_[++last] = next;
    } else {
      before.count = std::max(before.count, next.first + next.count - before.first);
    }
  }
  found_.resize(last + 1);
  return found_;
}

}  // namespace hexhex
