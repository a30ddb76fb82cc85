// Reads cells off the vertex grid, and resolves corners behind cuts (docs/developer/atlas.md).
#include <algorithm>
#include <bit>
#include <cassert>

#include <atlas/cell_emitter.hpp>

namespace hexhex::atlas {

namespace {

std::size_t firstOf(lattice::CellCornerSet corners) {
  return static_cast<std::size_t>(std::countr_zero(corners));
}

}  // namespace

template <class Id>
bool CornerResolver<Id>::resolve(const CellInQuestion& question, Cell& cell,
                                 BrickCache<Id>& cache) {
  const Cell shown = cell;
  const lattice::CellCornerSet open = lookAcross(question, cell, cache);
  if (open != 0) trace(question, open, cell, cache);
  return cell != shown;
}

/// Takes vertices from the far sides of cuts.
/// @return the corners that are still in question, in terms of the tet's own chart
template <class Id>
lattice::CellCornerSet CornerResolver<Id>::lookAcross(const CellInQuestion& question, Cell& cell,
                                                      BrickCache<Id>& cache) {
  const lattice::Rotation toOwn = vertices_.charts().gauge(question.tet).rotation.inverse();
  if (!lookAcrossCuts_) return lattice::turned(toOwn, question.cuts.corners());
  lattice::CellCornerSet open = 0;
  Image image;
  for (lattice::CellCornerSet rest = question.cuts.corners(); rest != 0; rest &= rest - 1) {
    const std::size_t corner = firstOf(rest);
    const CutTransitionId id = question.cuts.transition(corner);
    if (id != image.id) image = imageAcross(id, question.place, cache);
    const std::optional<Id> there = shownBeyond(image, corner, cache);
    const std::size_t own = lattice::turnedCorner(toOwn, corner);
    const bool isHere = Brick<Id>::isVertex(cell[own]);
    const bool isThere = there && Brick<Id>::isVertex(*there);
    const bool isKnown = there && (isHere != isThere || (isHere && cell[own] == *there));
    if (!isKnown) {
      open |= lattice::CellCornerSet{1} << own;
    } else if (isThere) {
      cell[own] = *there;
    }
  }
  return open;
}

template <class Id>
typename CornerResolver<Id>::Image CornerResolver<Id>::imageAcross(CutTransitionId id,
                                                                   const lattice::ChartPoint& place,
                                                                   BrickCache<Id>& cache) {
  if (id == kAnyCuts) return {id, nullptr, {}, {}};
  const CutTransition& map = transitions_[id];
  const lattice::ChartPoint image = map.map.cell(place);
  const CutCells* const cuts = cache.at(map.to, image).cuts;
  if (cuts == nullptr) return {id, nullptr, {}, {}};
  return {id, &map, image, cuts->cells[placeInBrick(image)]};
}

/// What the chart on the far side shows at a corner.
/// @return nothing if the half diagonal may meet further cuts
template <class Id>
std::optional<Id> CornerResolver<Id>::shownBeyond(const Image& image, std::size_t corner,
                                                  BrickCache<Id>& cache) {
  if (image.map == nullptr) return std::nullopt;
  const std::size_t there = lattice::turnedCorner(image.map->map.rotation, corner);
  if (image.cuts.transition(there) != image.map->inverse) return std::nullopt;
  return cache.idAt(image.map->to, lattice::plus(image.place, lattice::kCellCorners[there]));
}

template <class Id>
void CornerResolver<Id>::trace(const CellInQuestion& question, lattice::CellCornerSet corners,
                               Cell& cell, BrickCache<Id>& cache) {
  const lattice::SweptLine& line = *question.centers;
  tracer_.enter(question.tet, line.point(question.index), line.simplex(question.index));
  for (; corners != 0; corners &= corners - 1) {
    const std::size_t corner = firstOf(corners);
    const sweep::CornerPlace place = tracer_.trace(lattice::kCellCorners[corner]);
    cell[corner] = vertices_.vertexAt(place.tet, place.z, cache);
  }
}

template class CornerResolver<std::uint32_t>;
template class CornerResolver<std::uint64_t>;

namespace {

/// The corners of a cell by the row of points along the third sweep axis that contains them: row r
/// is shifted by r % 2 along the first sweep axis, and by r / 2 along the second.
struct RowCorners {
  std::array<std::size_t, 4> near{};  ///< with coordinate 0 along the third
  std::array<std::size_t, 4> far{};   ///< with coordinate 1
};

constexpr RowCorners rowCorners(std::size_t permutation) {
  const std::array<std::uint8_t, 3>& axes = lattice::SweepAxes::kPermutations[permutation];
  RowCorners corners;
  for (std::size_t c = 0; c < 8; ++c) {
    const lattice::GridPoint& offset = lattice::kCellCorners[c];
    const std::size_t row = (offset[axes[0]] != 0 ? 1U : 0U) + (offset[axes[1]] != 0 ? 2U : 0U);
    (offset[axes[2]] == 0 ? corners.near : corners.far)[row] = c;
  }
  return corners;
}

/// Continues along four rows of points; each cell shares four corners with the one before.
/// @param rows  at the next point
/// @param near  the points before
template <std::size_t Permutation, class Id>
void readPart(std::array<const Id*, 4> rows, std::ptrdiff_t stride, std::array<Id, 4>& near,
              std::array<Id, 8>* cells, std::uint32_t count) {
  constexpr RowCorners kCorners = rowCorners(Permutation);
  for (std::uint32_t n = 0; n < count; ++n) {
    std::array<Id, 8> cell;
    for (std::size_t r = 0; r < 4; ++r) {
      cell[kCorners.near[r]] = near[r];
      near[r] = *rows[r];
      cell[kCorners.far[r]] = near[r];
      rows[r] += stride;
    }
    cells[n] = cell;
  }
}

}  // namespace

template <class Id>
std::uint64_t CellEmitter<Id>::emit(Index tet, std::span<const lattice::SweptLine> lines,
                                    std::span<Cell> cells) {
  if (cells.empty()) return 0;
  const Frame frame = frameOf(tet, lines.front().axes);
  sweep::CenterOwner owner(topology_, tet);
  std::uint64_t resolved = 0;
  for (const lattice::SweptLine& line : lines) {
    const auto [first, count] = owner.owned(line);
    if (count == 0) continue;
    resolved += emitSome(frame, {line, first, cells.first(count)});
    cells = cells.subspan(count);
  }
  assert(cells.empty());  // the tet owns no others
  return resolved;
}

template <class Id>
typename CellEmitter<Id>::Frame CellEmitter<Id>::frameOf(Index tet, lattice::SweepAxes axes) const {
  Frame frame{tet, charts_.chart[tet], SweepFrame(charts_.gauge(tet), axes())};
  const SweepFrame& sweep = frame.sweep;
  for (std::size_t k = 0; k < 3; ++k) {
    if (lattice::signOf(sweep.along(k)) < 0)
      frame.toSmallest = lattice::moved(frame.toSmallest, sweep.along(k), 1);
  }
  for (std::uint32_t r = 0; r < 4; ++r) {
    frame.rows[r] =
        lattice::moved(lattice::moved({}, sweep.along(0), r % 2), sweep.along(1), r / 2);
    frame.strides[r] =
        strideInBrick(sweep.along(0)) * (r % 2) + strideInBrick(sweep.along(1)) * (r / 2);
  }
  return frame;
}

template <class Id>
std::uint64_t CellEmitter<Id>::emitLine(const Frame& frame, const Cells& cells) {
  const lattice::SweptLine& line = cells.line;
  const std::int32_t point = line.first + static_cast<std::int32_t>(cells.first);
  ChartRow row{frame.chart, frame.sweep(line.level, line.row, point), frame.sweep.along(2),
               static_cast<std::uint32_t>(cells.corners.size()) + 1};
  // With a table of corners instead of templates, dense extractions take 8 to 12 % longer.
  constexpr std::array kRead = {
      &CellEmitter::template readCells<0>, &CellEmitter::template readCells<1>,
      &CellEmitter::template readCells<2>, &CellEmitter::template readCells<3>,
      &CellEmitter::template readCells<4>, &CellEmitter::template readCells<5>};
  const auto read = kRead[line.axes.index];
  if (!(this->*read)(frame, row, cells)) return 0;
  --row.count;
  row.start = lattice::plus(row.start, frame.toSmallest);
  return resolveCells(frame, row, cells);
}

template <class Id>
std::uint64_t CellEmitter<Id>::emitWithoutChart(const Frame& frame, const Cells& cells) {
  constexpr CutCell kCutOff = CutCell().with(lattice::kAllCellCorners, kAnyCuts);
  for (std::uint32_t i = 0; i < cells.corners.size(); ++i) {
    cells.corners[i].fill(Brick<Id>::kEmpty);
    resolver_.resolve({frame.tet, &cells.line, cells.first + i, {}, kCutOff}, cells.corners[i],
                      cache_);
  }
  return cells.corners.size();
}

/// Reads the corners of a line of cells from the chart.
/// @tparam Permutation  of the sweep's axes
/// @param row  the first of the four rows of points around the cells, with one more point than
///             cells
/// @return whether any of the bricks has cut cells
template <class Id>
template <std::size_t Permutation>
bool CellEmitter<Id>::readCells(const Frame& frame, const ChartRow& row, const Cells& cells) {
  bool isCut = false;
  std::array<Id, 4> near;
  row.forEachPart([&](const lattice::ChartPoint& c, std::uint32_t offset, std::uint32_t count,
                      std::ptrdiff_t stride) {
    std::array<const Id*, 4> rows = rowsAt(frame, c, isCut);
    if (offset == 0) {
      for (std::size_t r = 0; r < 4; ++r) {
        near[r] = *rows[r];
        rows[r] += stride;
      }
      ++offset;
      --count;
    }
    readPart<Permutation>(rows, stride, near, cells.corners.data() + (offset - 1), count);
  });
  return isCut;
}

/// The points of the four rows at point c of the first.
/// @param isCut  set to true if a brick has cut cells
template <class Id>
std::array<const Id*, 4> CellEmitter<Id>::rowsAt(const Frame& frame, const lattice::ChartPoint& c,
                                                 bool& isCut) {
  std::array<const Id*, 4> rows;
  const auto look = [&](std::size_t r, const lattice::ChartPoint& point) {
    const Brick<Id>& brick = cache_.at(frame.chart, point);
    isCut = isCut || brick.cuts != nullptr;
    rows[r] = brick.ids.data() + placeInBrick(point);
  };
  look(0, c);
  const lattice::ChartPoint last = lattice::plus(c, frame.rows[3]);
  // Without this shortcut, dense extractions take 5 to 7 % longer.
  const bool inOneBrick = ((last[0] ^ c[0]) | (last[1] ^ c[1]) | (last[2] ^ c[2])) < kBrickSide;
  for (std::size_t r = 1; r < 4; ++r) {
    if (inOneBrick) {
      rows[r] = rows[0] + frame.strides[r];
    } else {
      look(r, lattice::plus(c, frame.rows[r]));
    }
  }
  return rows;
}

/// Resolves the cells for which cuts are recorded.
/// @param row  their smallest corners
template <class Id>
std::uint64_t CellEmitter<Id>::resolveCells(const Frame& frame, const ChartRow& row,
                                            const Cells& cells) {
  std::uint64_t resolved = 0;
  row.forEachPart([&](const lattice::ChartPoint& c, std::uint32_t offset, std::uint32_t count,
                      std::ptrdiff_t stride) {
    const CutCells* const cuts = cache_.at(row.chart, c).cuts;
    if (cuts == nullptr) return;
    auto place = static_cast<std::ptrdiff_t>(placeInBrick(c));
    for (std::uint32_t i = 0; i < count; ++i, place += stride) {
      const CutCell cut = cuts->cells[static_cast<std::size_t>(place)];
      if (!cut.isCut()) continue;
      const CellInQuestion question{frame.tet, &cells.line, cells.first + offset + i,
                                    lattice::moved(c, row.along, i), cut};
      if (resolver_.resolve(question, cells.corners[offset + i], cache_)) ++resolved;
    }
  });
  return resolved;
}

template class CellEmitter<std::uint32_t>;
template class CellEmitter<std::uint64_t>;

}  // namespace hexhex::atlas
