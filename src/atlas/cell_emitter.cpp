#include <algorithm>
#include <cstdlib>
#include <limits>

#include <atlas/cell_emitter.hpp>

namespace hexhex {

namespace {

/// Corners of a cell with coordinate 0 along an axis, and those next to them with coordinate 1.
struct FacingCorners {
  std::array<std::size_t, 4> near{};
  std::array<std::size_t, 4> far{};
};

constexpr FacingCorners facingCorners(std::size_t axis) {
  FacingCorners corners;
  std::size_t count = 0;
  for (std::size_t c = 0; c < 8; ++c) {
    if (kCellCorners[c][axis] != 0) continue;
    GridPoint across = kCellCorners[c];
    across[axis] = 1;
    corners.near[count] = c;
    for (std::size_t d = 0; d < 8; ++d) {
      if (kCellCorners[d] == across) corners.far[count] = d;
    }
    ++count;
  }
  return corners;
}

/// Reads a line of cells along an axis; each shares four corners with the next.
/// @param corner   the place of the first cell's smallest corner
/// @param corners  how far from there the corners are
/// @return all ids, or-ed
template <std::size_t Axis, class Id>
Id readCells(const Id* corner, const std::array<std::ptrdiff_t, 8>& corners, std::ptrdiff_t step,
             std::array<Id, 8>* cells, std::uint32_t count) {
  constexpr FacingCorners kFacing = facingCorners(Axis);
  std::array<const Id*, 4> rows;
  std::array<Id, 4> near;
  Id together = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    rows[i] = corner + corners[kFacing.near[i]];
    near[i] = *rows[i];
    together |= near[i];
  }
  for (std::uint32_t n = 0; n < count; ++n) {
    std::array<Id, 8> cell;
    for (std::size_t i = 0; i < 4; ++i) {
      rows[i] += step;
      cell[kFacing.near[i]] = near[i];
      near[i] = *rows[i];
      cell[kFacing.far[i]] = near[i];
      together |= near[i];
    }
    cells[n] = cell;
  }
  return together;
}

}  // namespace

template <class Id>
void CellEmitter<Id>::emit(Index tet, std::span<const SweptLine> lines, std::span<Cell> cells) {
  if (cells.empty()) return;
  tet_ = tet;
  chart_ = vertices_.charts().chart[tet];
  gauge_ = &vertices_.charts().gauge(tet);
  const TetSweep sweep(map_.exact, tet, SweptGrid::Centers);
  Job job{sweep, SweepFrame(*gauge_, sweep.axes()), CenterOwner(map_.topology, tet), cells.data()};
  while (!lines.empty()) {
    const std::span<const SweptLine> together =
        lines.first(chart_ == Charts::kNoChart ? lines.size() : load(job, lines));
    for (const SweptLine& line : together) {
      const auto [first, count] = job.owner.owned(line);
      if (count == 0) continue;
      if (chart_ != Charts::kNoChart) {
        emitLine(job, line, first, count);
        continue;
      }
      for (std::uint32_t i = first; i < first + count; ++i) {
        emitIrregular(sweep.point(line, i), line.simplex(i), *job.place++);
      }
    }
    lines = lines.subspan(together.size());
  }
}

/// Loads the vertices around the first lines: those of a few levels, or one line alone if their
/// box is much larger than they.
/// @return the number of lines
template <class Id>
std::size_t CellEmitter<Id>::load(const Job& job, std::span<const SweptLine> lines) {
  constexpr std::int32_t kLevels = kBrickSide;
  SweptLine low = lines.front();
  std::int32_t highRow = low.row;
  std::int32_t highPoint = low.first;
  std::uint64_t cells = 0;
  std::size_t count = 0;
  for (const SweptLine& line : lines) {
    if (line.level >= lines.front().level + kLevels) break;
    low.row = std::min(low.row, line.row);
    low.first = std::min(low.first, line.first);
    highRow = std::max(highRow, line.row);
    highPoint = std::max(highPoint, line.first + static_cast<std::int32_t>(line.count) - 1);
    cells += line.count;
    ++count;
  }
  const std::int32_t highLevel = lines[count - 1].level;
  const auto size = [](std::int32_t from, std::int32_t to) {
    return static_cast<std::uint64_t>(std::int64_t{to} - from + 2);
  };
  // Each factor fits 32 bits; a box of that many rows is too large whatever their length.
  const std::uint64_t rows = size(low.level, highLevel) * size(low.row, highRow);
  const std::uint64_t most = 64 * cells + 1024;
  if (rows > most || rows * size(low.first, highPoint) > most) {
    const SweptLine& line = lines.front();
    loadBox(job, job.sweep.point(line, 0), job.sweep.point(line, line.count - 1));
    return 1;
  }
  SweptLine high = low;
  high.level = highLevel;
  high.row = highRow;
  high.first = highPoint;
  loadBox(job, job.sweep.point(low, 0), job.sweep.point(high, 0));
  return count;
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
  const Id together = [&] {
    switch (job.sweep.axes()[2]) {
      case 0:
        return readCells<0>(corner, corners_, step, cells, count);
      case 1:
        return readCells<1>(corner, corners_, step, cells, count);
      default:
        return readCells<2>(corner, corners_, step, cells, count);
    }
  }();
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
    if (!block_.isMarked(static_cast<std::size_t>(at)) &&
        std::all_of(cells[i].begin(), cells[i].end(), Brick<Id>::isVertex)) {
      continue;
    }
    emitIrregular(job.sweep.point(line, first + i), line.simplex(first + i), cells[i]);
  }
}

/// Walks to the corners, and takes from the picture what a straight way without a cut leads to.
template <class Id>
void CellEmitter<Id>::emitIrregular(const GridPoint& z, CornerMask generator, Cell& cell) {
  bool hidden = false;
  const CellCornerSet missed =
      walker_.run(tet_, z, [&](const CellWalker::Stop& stop, CellCornerSet corners) {
        if (stop.inSight) return;
        hidden = true;
        for (std::size_t c = 0; c < 8; ++c) {
          if (((corners >> c) & 1U) == 0) continue;
          GridPoint corner = z;
          for (std::size_t k = 0; k < 3; ++k) corner[k] += kCellCorners[c][k];
          cell[c] = vertices_.vertexAt(stop.tet, stop.toTet(corner), cache_);
        }
      });
  if (missed != 0) tracer_.enter(tet_, z, generator);
  for (std::size_t c = 0; missed >> c != 0; ++c) {
    if (((missed >> c) & 1U) == 0) continue;
    hidden = true;
    const CornerPlace place = tracer_.trace(kCellCorners[c]);
    cell[c] = vertices_.vertexAt(place.tet, place.z, cache_);
  }
  if (hidden) ++traced_;
}

template class CellEmitter<std::uint32_t>;
template class CellEmitter<std::uint64_t>;

}  // namespace hexhex
