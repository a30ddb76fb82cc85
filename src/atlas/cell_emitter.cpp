#include <algorithm>
#include <cstdlib>
#include <limits>

#include <atlas/cell_emitter.hpp>

namespace hexhex {

template <class Id>
void CellEmitter<Id>::emit(Index tet, std::span<const SweptLine> lines, std::span<Cell> cells) {
  if (cells.empty()) return;
  tet_ = tet;
  chart_ = vertices_.charts().chart[tet];
  gauge_ = &vertices_.charts().gauge(tet);
  const TetSweep sweep(map_.exact, tet, SweptGrid::Centers);
  Job job{sweep, SweepFrame(*gauge_, sweep.axes()), CenterOwner(map_.topology, tet), cells.data()};
  const bool whole = chart_ != Charts::kNoChart && loadWhole(job, cells.size());
  for (const SweptLine& line : lines) {
    const auto [first, count] = job.owner.owned(line);
    if (count == 0) continue;
    if (chart_ == Charts::kNoChart) {
      for (std::uint32_t i = first; i < first + count; ++i) {
        emitIrregular(sweep.point(line, i), true, line.simplex(i), *job.place++);
      }
      continue;
    }
    if (!whole) loadBox(job, sweep.point(line, first), sweep.point(line, first + count - 1));
    emitLine(job, line, first, count);
  }
}

/// Loads the vertices around all of the tet's cells, unless its box is much larger than the tet.
template <class Id>
bool CellEmitter<Id>::loadWhole(const Job& job, std::size_t cells) {
  const GridBox& box = job.sweep.box;
  std::uint64_t points = 1;
  for (const GridRange& range : box.range) {
    points *= static_cast<std::uint64_t>(std::int64_t{range.last} - range.first + 2);
    if (points > 64 * cells + 1024) return false;
  }
  loadBox(job, {box.range[0].first, box.range[1].first, box.range[2].first},
          {box.range[0].last, box.range[1].last, box.range[2].last});
  return true;
}

/// @param first, last  cells at opposite ends of a box in the tet's chart
template <class Id>
void CellEmitter<Id>::loadBox(const Job& job, const GridPoint& first, const GridPoint& last) {
  const ChartPoint a = gauge_->cell(first);
  const ChartPoint b = gauge_->cell(last);
  ChartPoint low{};
  std::array<std::uint32_t, 3> size{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto difference = static_cast<std::int32_t>(b[k] - a[k]);
    low[k] = difference < 0 ? b[k] : a[k];
    size[k] = static_cast<std::uint32_t>(std::abs(difference)) + 2;
  }
  block_.load(cache_, chart_, low, size);
  const std::array<std::uint8_t, 3>& axes = job.sweep.axes();
  for (std::size_t c = 0; c < 8; ++c) {
    corners_[c] = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      corners_[c] += kCellCorners[c][axes[k]] * block_.stride(job.frame.along(k));
    }
  }
}

template <class Id>
void CellEmitter<Id>::emitLine(Job& job, const SweptLine& line, std::uint32_t first,
                               std::uint32_t count) {
  const ChartPoint start =
      job.frame(line.level, line.row, line.first + static_cast<std::int32_t>(first));
  const std::ptrdiff_t step = block_.stride(job.frame.along(2));
  const Id* corner = block_.ids() + block_.offset(start);
  Cell* const cells = job.place;
  job.place += count;
  const std::array<std::ptrdiff_t, 8> corners = corners_;  // which the loop can hold in registers
  Id together = 0;
  for (std::uint32_t i = 0; i < count; ++i, corner += step) {
    Cell cell;
    for (std::size_t c = 0; c < 8; ++c) cell[c] = corner[corners[c]];
    cells[i] = cell;
    together |=
        (cell[0] | cell[1]) | (cell[2] | cell[3]) | (cell[4] | cell[5]) | (cell[6] | cell[7]);
  }
  // Both special values have the highest bit set, as no vertex of a mesh of usual size has.
  constexpr Id kHighestBit = ~(std::numeric_limits<Id>::max() >> 1);
  if (!block_.anyMarked() && (together & kHighestBit) == 0) return;
  // A cell is marked at its smallest corner in the chart.
  ChartPoint smallest = start;
  for (std::size_t k = 0; k < 3; ++k) {
    const Direction d = job.frame.along(k);
    if (signOf(d) < 0) --smallest[static_cast<std::size_t>(axisOf(d))];
  }
  auto at = static_cast<std::ptrdiff_t>(block_.offset(smallest));
  for (std::uint32_t i = 0; i < count; ++i, at += step) {
    const bool marked = block_.isMarked(static_cast<std::size_t>(at));
    if (!marked && std::all_of(cells[i].begin(), cells[i].end(), Brick<Id>::isVertex)) continue;
    emitIrregular(job.sweep.point(line, first + i), marked, line.simplex(first + i), cells[i]);
  }
}

/// The picture shows those corners of a cell whose diagonals no cut crosses.
template <class Id>
void CellEmitter<Id>::emitIrregular(const GridPoint& z, bool marked, CornerMask generator,
                                    Cell& cell) {
  CellCornerSet hidden = marked ? hiddenCorners(z) : 0;
  for (std::size_t c = 0; c < 8; ++c) {
    if (!Brick<Id>::isVertex(cell[c])) hidden |= 1U << c;
  }
  if (hidden == 0) return;
  ++traced_;
  tracer_.enter(tet_, z, generator);
  reveal(hidden, cell);
}

/// Finds what a cell's crossings are in the chart of its tet; false if nobody knows.
template <class Id>
bool CellEmitter<Id>::see(SeenCell& cell) {
  const Index chart = vertices_.charts().chart[cell.tet];
  if (chart == Charts::kNoChart) return false;
  const Brick<Id>* const brick = cache_.find(chart, cell.smallest);
  if (brick == nullptr) return false;  // there was no place for marks
  const auto place = static_cast<std::uint16_t>(placeInBrick(cell.smallest));
  const std::span<const Crossing> all = crossings_.of(*brick);
  const auto first = std::lower_bound(
      all.begin(), all.end(), place,
      [](const Crossing& crossing, std::uint16_t at) { return crossing.place < at; });
  auto last = first;
  while (last != all.end() && last->place == place) ++last;
  cell.crossings = {first, last};
  return true;
}

template <class Id>
CellCornerSet CellEmitter<Id>::hiddenCorners(const GridPoint& z) {
  constexpr CellCornerSet kAll = 0xff;
  SeenCell cell{tet_, gauge_->cell(z), {}};
  return see(cell) ? crossedDiagonals(map_, vertices_.charts(), cell) : kAll;
}

/// Traces one hidden corner; where that arrives, the others are often in sight.
template <class Id>
void CellEmitter<Id>::reveal(CellCornerSet hidden, Cell& cell) {
  bool tried = false;
  for (std::size_t c = 0; c < 8; ++c) {
    if (((hidden >> c) & 1U) == 0) continue;
    const CornerPlace place = tracer_.trace(kCellCorners[c]);
    cell[c] = vertices_.vertexAt(place.tet, place.z, cache_);
    hidden &= ~(1U << c);
    if (hidden != 0 && !tried && revealTogether(place, c, hidden, cell)) return;
    tried = true;
  }
}

/// Seen from the tet that a traced corner was found in, the other hidden corners are at their
/// places in its chart, unless a cut comes between: straight ways from corner to corner stay inside
/// the cell's cube, as the way that was traced did.
template <class Id>
bool CellEmitter<Id>::revealTogether(const CornerPlace& place, std::size_t traced,
                                     CellCornerSet hidden, Cell& cell) {
  const Charts& charts = vertices_.charts();
  if (charts.chart[place.tet] == Charts::kNoChart) return false;
  // All corners in the chart of that tet.
  std::array<GridPoint, 8> corners{};
  GridPoint smallest = place.z;
  for (std::size_t c = 0; c < 8; ++c) {
    GridPoint offset{};
    for (std::size_t k = 0; k < 3; ++k) offset[k] = kCellCorners[c][k] - kCellCorners[traced][k];
    offset = place.rotation(offset);
    for (std::size_t k = 0; k < 3; ++k) {
      corners[c][k] = place.z[k] + offset[k];
      smallest[k] = std::min(smallest[k], corners[c][k]);
    }
  }
  SeenCell seen{place.tet, charts.gauge(place.tet).cell(smallest), {}};
  if (!see(seen)) return false;
  constexpr std::array<std::uint8_t, 8> kVtkCorner = {0, 1, 3, 2, 4, 5, 7, 6};  // by x + 2 y + 4 z
  CellCornerSet together = 0;
  for (std::size_t c = 0; c < 8; ++c) {
    if (c != traced && ((hidden >> c) & 1U) == 0) continue;
    std::size_t index = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      index |= static_cast<std::size_t>(corners[c][k] - smallest[k]) << k;
    }
    together |= 1U << kVtkCorner[index];
  }
  if (!areTogether(map_, charts, seen, together)) return false;
  for (std::size_t c = 0; c < 8; ++c) {
    if (((hidden >> c) & 1U) == 0) continue;
    const ChartPoint at = charts.gauge(place.tet)(corners[c]);
    const Brick<Id>* const brick = cache_.find(charts.chart[place.tet], at);
    if (brick == nullptr || !Brick<Id>::isVertex(brick->ids[placeInBrick(at)])) return false;
    cell[c] = brick->ids[placeInBrick(at)];
  }
  return true;
}

template class CellEmitter<std::uint32_t>;
template class CellEmitter<std::uint64_t>;

}  // namespace hexhex
