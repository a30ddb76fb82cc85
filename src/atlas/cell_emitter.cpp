#include <algorithm>

#include <atlas/cell_emitter.hpp>

namespace hexhex {

namespace {

/// Where the corners of a cell stand in the four rows around its line, for each order of axes.
struct CornerTable {
  std::array<std::array<std::uint8_t, 8>, 6> row{};
  std::array<std::array<std::uint8_t, 8>, 6> step{};
};

constexpr CornerTable makeCornerTable() {
  CornerTable table;
  for (std::size_t order = 0; order < 6; ++order) {
    const std::array<std::uint8_t, 3>& axes = SweepAxes::kPermutations[order];
    for (std::size_t c = 0; c < 8; ++c) {
      table.row[order][c] =
          static_cast<std::uint8_t>(2 * kCellCorners[c][axes[0]] + kCellCorners[c][axes[1]]);
      table.step[order][c] = static_cast<std::uint8_t>(kCellCorners[c][axes[2]]);
    }
  }
  return table;
}

constexpr CornerTable kCornerTable = makeCornerTable();

}  // namespace

template <class Id>
void CellEmitter<Id>::emit(Index tet, std::span<const SweptLine> lines, std::span<Cell> cells) {
  if (cells.empty()) return;
  tet_ = tet;
  chart_ = vertices_.charts().chart[tet];
  gauge_ = &vertices_.charts().gauge(tet);
  const TetSweep sweep(map_.exact, tet, SweptGrid::Centers);
  const std::array<std::uint8_t, 8>& rowOf = kCornerTable.row[sweep.axes.index];
  const std::array<std::uint8_t, 8>& stepOf = kCornerTable.step[sweep.axes.index];
  CenterOwner owner(map_.topology, tet);
  Cell* place = cells.data();
  for (const SweptLine& line : lines) {
    const auto [first, count] = owner.owned(line);
    if (count == 0) continue;
    gather(sweep, line, first, count);
    std::array<const Id*, 8> corners{};
    for (std::size_t c = 0; c < 8; ++c) corners[c] = rows_[rowOf[c]].data() + stepOf[c];
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::size_t c = 0; c < 8; ++c) place[i][c] = corners[c][i];
    }
    if (anyIrregular_) {
      for (std::uint32_t i = 0; i < count; ++i) {
        const bool regular = irregular_[i] == 0 &&
                             std::all_of(place[i].begin(), place[i].end(), Brick<Id>::isVertex);
        if (regular) continue;
        const std::uint32_t at = first + i;
        traceCell(sweep.point(line, at), line.simplex(at), place[i]);
      }
    }
    place += count;
  }
}

template <class Id>
void CellEmitter<Id>::gather(const TetSweep& sweep, const SweptLine& line, std::uint32_t first,
                             std::uint32_t count) {
  const std::array<std::uint8_t, 3>& axes = sweep.axes();
  for (std::vector<Id>& row : rows_) {
    if (row.size() < std::size_t{count} + 1) row.resize(std::size_t{count} + 1);
  }
  irregular_.assign(count, 0);
  anyIrregular_ = false;
  if (chart_ == Charts::kNoChart) {
    irregular_.assign(count, 1);
    anyIrregular_ = true;
    return;
  }
  const Direction along = gauge_->rotation(direction(axes[2], 1));
  const GridPoint start = sweep.point(line, first);
  for (std::size_t r = 0; r < 4; ++r) {
    GridPoint z = start;
    z[axes[0]] += static_cast<std::int32_t>(r >> 1);
    z[axes[1]] += static_cast<std::int32_t>(r & 1);
    gatherRow({chart_, (*gauge_)(z), along, count + 1}, rows_[r].data());
  }
  gatherMarks({chart_, gauge_->cell(start), along, count});
}

template <class Id>
void CellEmitter<Id>::gatherRow(const ChartRow& row, Id* ids) {
  row.forEachPart(
      [&](const ChartPoint& c, std::uint32_t offset, std::uint32_t count, std::ptrdiff_t stride) {
        const Brick<Id>* const brick = cache_.find(row.chart, c);
        Id* const target = ids + offset;
        if (brick == nullptr) {
          std::fill_n(target, count, Brick<Id>::kEmpty);
          anyIrregular_ = true;
          return;
        }
        const Id* const source = brick->ids.data() + placeInBrick(c);
        Id largest = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
          target[i] = source[i * stride];
          largest = std::max(largest, target[i]);
        }
        if (!Brick<Id>::isVertex(largest)) anyIrregular_ = true;
      });
}

template <class Id>
void CellEmitter<Id>::gatherMarks(const ChartRow& row) {
  row.forEachPart(
      [&](const ChartPoint& c, std::uint32_t offset, std::uint32_t count, std::ptrdiff_t stride) {
        const Brick<Id>* const brick = cache_.find(row.chart, c);
        if (brick == nullptr) {
          // No vertex has its smallest corner here, which gatherRow() has noticed as well.
          std::fill_n(irregular_.begin() + offset, count, std::uint8_t{1});
          anyIrregular_ = true;
          return;
        }
        if (brick->marked == 0) return;
        const auto place = static_cast<std::ptrdiff_t>(placeInBrick(c));
        for (std::uint32_t i = 0; i < count; ++i) {
          if (!brick->isMarked(static_cast<std::size_t>(place + i * stride))) continue;
          irregular_[offset + i] = 1;
          anyIrregular_ = true;
        }
      });
}

template <class Id>
void CellEmitter<Id>::traceCell(const GridPoint& z, CornerMask generator, Cell& cell) {
  ++traced_;
  for (std::size_t c = 0; c < 8; ++c) {
    const CornerPlace place = tracer_.trace(tet_, z, generator, kCellCorners[c]);
    cell[c] = vertices_.vertexAt(place.tet, place.z, cache_);
  }
}

template class CellEmitter<std::uint32_t>;
template class CellEmitter<std::uint64_t>;

}  // namespace hexhex
