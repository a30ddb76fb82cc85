#include <bit>
#include <limits>
#include <utility>

#include <atlas/cell_emitter.hpp>

namespace hexhex {

namespace {

/// The corners of a cell by the row of points along the third sweep axis that they are in: row r is
/// shifted by r % 2 along the first sweep axis, and by r / 2 along the second.
struct RowCorners {
  std::array<std::size_t, 4> near{};  ///< with coordinate 0 along the third
  std::array<std::size_t, 4> far{};   ///< with coordinate 1
};

constexpr RowCorners rowCorners(std::size_t permutation) {
  const std::array<std::uint8_t, 3>& axes = SweepAxes::kPermutations[permutation];
  RowCorners corners;
  for (std::size_t c = 0; c < 8; ++c) {
    const GridPoint& offset = kCellCorners[c];
    const std::size_t row = (offset[axes[0]] != 0 ? 1U : 0U) + (offset[axes[1]] != 0 ? 2U : 0U);
    (offset[axes[2]] == 0 ? corners.near : corners.far)[row] = c;
  }
  return corners;
}

/// Goes on along four rows of points; each cell shares four corners with the one before.
/// @param rows  at the next point
/// @param near  the points before
/// @return all ids, or-ed
template <std::size_t Permutation, class Id>
Id readCells(std::array<const Id*, 4> rows, std::ptrdiff_t stride, std::array<Id, 4>& near,
             std::array<Id, 8>* cells, std::uint32_t count) {
  constexpr RowCorners kCorners = rowCorners(Permutation);
  Id together = 0;
  for (std::uint32_t n = 0; n < count; ++n) {
    std::array<Id, 8> cell;
    for (std::size_t r = 0; r < 4; ++r) {
      cell[kCorners.near[r]] = near[r];
      near[r] = *rows[r];
      cell[kCorners.far[r]] = near[r];
      together |= near[r];
      rows[r] += stride;
    }
    cells[n] = cell;
  }
  return together;
}

/// Both special values of a brick have it, as no vertex of a mesh of usual size has.
template <class Id>
constexpr Id kHighestBit = ~(std::numeric_limits<Id>::max() >> 1);

/// The first corner of a set.
std::size_t memberOf(CellCornerSet corners) {
  return static_cast<std::size_t>(std::countr_zero(corners));
}

/// Whether all corners of a cell are in the brick of its smallest one.
bool isInOneBrick(const ChartPoint& c) {
  constexpr std::uint32_t kLast = kBrickSide - 1;
  return c[0] % kBrickSide != kLast && c[1] % kBrickSide != kLast && c[2] % kBrickSide != kLast;
}

/// The corners of a cell at which the picture shows no vertex.
template <class Id>
CellCornerSet withoutVertex(const std::array<Id, 8>& cell) {
  Id together = 0;
  for (const Id id : cell) together |= id;
  if ((together & kHighestBit<Id>) == 0) return 0;
  CellCornerSet corners = 0;
  for (std::size_t c = 0; c < 8; ++c) {
    corners |= (Brick<Id>::isVertex(cell[c]) ? 0U : 1U) << c;
  }
  return corners;
}

/// What stands for bricks that do not exist: whatever cuts may meet has one.
template <class Id>
const Brick<Id>& noBrick() {
  static const Brick<Id> brick = [] {
    Brick<Id> empty;
    empty.clear();
    return empty;
  }();
  return brick;
}

}  // namespace

template <class Id>
void CellEmitter<Id>::emit(Index tet, std::span<const SweptLine> lines, std::span<Cell> cells) {
  if (cells.empty()) return;
  tet_ = tet;
  chart_ = vertices_.charts().chart[tet];
  const SweepFrame frame(vertices_.charts().gauge(tet), lines.front().axes());
  Job job{frame, CenterOwner(map_.topology, tet), cells.data(), {}, {}, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    if (signOf(frame.along(k)) < 0) job.toSmallest = moved(job.toSmallest, frame.along(k), 1);
  }
  for (std::uint32_t r = 0; r < 4; ++r) {
    job.rows[r] = moved(moved({}, frame.along(0), r % 2), frame.along(1), r / 2);
    job.strides[r] =
        strideInBrick(frame.along(0)) * (r % 2) + strideInBrick(frame.along(1)) * (r / 2);
  }
  for (const SweptLine& line : lines) {
    const auto [first, count] = job.owner.owned(line);
    if (count == 0) continue;
    if (chart_ != Charts::kNoChart) {
      emitLine(job, line, first, count);
      continue;
    }
    for (std::uint32_t i = first; i < first + count; ++i) {
      job.place->fill(Brick<Id>::kEmpty);
      if (emitIrregular(line.point(i), line.simplex(i), kAllCellCorners, *job.place++)) ++traced_;
    }
  }
}

template <class Id>
void CellEmitter<Id>::emitLine(Job& job, const SweptLine& line, std::uint32_t first,
                               std::uint32_t count) {
  Cell* const cells = job.place;
  job.place += count;
  const std::int32_t point = line.first + static_cast<std::int32_t>(first);
  ChartRow row{chart_, job.frame(line.level, line.row, point), job.frame.along(2), count + 1};
  const Flags flags = [&] {
    switch (line.axes.index) {
      case 0:
        return readLine<0>(job, row, cells);
      case 1:
        return readLine<1>(job, row, cells);
      case 2:
        return readLine<2>(job, row, cells);
      case 3:
        return readLine<3>(job, row, cells);
      case 4:
        return readLine<4>(job, row, cells);
      default:
        return readLine<5>(job, row, cells);
    }
  }();
  row.count = count;
  if (flags.cut || flags.special) mendLine(job, line, first, row, flags.special, cells);
}

/// Reads the corners of a line of cells off the picture.
/// @param row  the points of row 0: one more than there are cells
template <class Id>
template <std::size_t Permutation>
typename CellEmitter<Id>::Flags CellEmitter<Id>::readLine(const Job& job, const ChartRow& row,
                                                          Cell* cells) {
  std::array<Id, 4> near;
  Id together = 0;
  bool cut = false;
  row.forEachPart(
      [&](const ChartPoint& c, std::uint32_t offset, std::uint32_t count, std::ptrdiff_t stride) {
        std::array<const Id*, 4> rows = rowsAt(job, c, cut);
        if (offset == 0) {
          for (std::size_t r = 0; r < 4; ++r) {
            near[r] = *rows[r];
            together |= near[r];
            rows[r] += stride;
          }
          --count;
          ++offset;
        }
        together |= readCells<Permutation>(rows, stride, near, cells + (offset - 1), count);
      });
  return {(together & kHighestBit<Id>) != 0, cut};
}

/// The places of the points of the four rows beside point c of row 0.
/// @param cut  becomes true if a brick has cut cells
template <class Id>
std::array<const Id*, 4> CellEmitter<Id>::rowsAt(const Job& job, const ChartPoint& c, bool& cut) {
  std::array<const Id*, 4> rows;
  const auto look = [&](std::size_t r, const ChartPoint& point) {
    const Brick<Id>* brick = cache_.find(chart_, point);
    if (brick == nullptr) brick = &noBrick<Id>();
    cut = cut || brick->cuts != nullptr;
    rows[r] = brick->ids.data() + placeInBrick(point);
  };
  look(0, c);
  const ChartPoint last = plus(c, job.rows[3]);
  if (((last[0] ^ c[0]) | (last[1] ^ c[1]) | (last[2] ^ c[2])) < kBrickSide) {
    // All are in one brick.
    for (std::size_t r = 1; r < 4; ++r) rows[r] = rows[0] + job.strides[r];
    return rows;
  }
  for (std::size_t r = 1; r < 4; ++r) look(r, plus(c, job.rows[r]));
  return rows;
}

/// Looks at each cell of a line that was read.
/// @param special  whether there are corners that are no vertices
template <class Id>
void CellEmitter<Id>::mendLine(const Job& job, const SweptLine& line, std::uint32_t first,
                               ChartRow row, bool special, Cell* cells) {
  row.start = plus(row.start, job.toSmallest);
  row.forEachPart(
      [&](const ChartPoint& c, std::uint32_t offset, std::uint32_t count, std::ptrdiff_t stride) {
        const Brick<Id>* brick = cache_.find(chart_, c);
        if (brick == nullptr) brick = &noBrick<Id>();
        const CutCells* const cuts = brick->cuts;
        if (cuts == nullptr && !special) return;
        auto place = static_cast<std::ptrdiff_t>(placeInBrick(c));
        for (std::uint32_t i = 0; i < count; ++i, place += stride) {
          const auto at = static_cast<std::size_t>(place);
          Cell& cell = cells[offset + i];
          bool hidden = false;
          CellCornerSet left = 0;
          if (cuts != nullptr && cuts->cells[at].isCut()) {
            left = lookAcross(moved(c, row.along, i), cuts->cells[at], cell, hidden);
          }
          if (special) left |= withoutVertex(cell);
          if (left != 0) {
            const std::uint32_t n = first + offset + i;
            hidden |= emitIrregular(line.point(n), line.simplex(n), left, cell);
          }
          traced_ += hidden ? 1 : 0;
        }
      });
}

/// Takes corners behind a cut from the picture on its other side, if there is just one cut on the
/// way. It then ends on either side; if only one of the pictures has a vertex there, on that one.
/// Where there are more cuts, the corner is walked to. Without this look, whole extractions take
/// 29 % longer on s17c_sphere_r10 and 16 % on a sphere with a random chart per tet.
/// @param c       the cell's smallest corner in the chart
/// @param hidden  becomes true if a vertex is found on the other side
/// @return the corners that are still in question, in terms of the tet's own chart
template <class Id>
CellCornerSet CellEmitter<Id>::lookAcross(const ChartPoint& c, const CutCell& cut, Cell& cell,
                                          bool& hidden) {
  const Rotation toOwn = vertices_.charts().gauge(tet_).rotation.inverse();
  CellCornerSet left = 0;
  OtherSide other;
  for (CellCornerSet corners = cut.corners(); corners != 0; corners &= corners - 1) {
    const std::size_t corner = memberOf(corners);
    const std::size_t own = turnedCorner(toOwn, corner);
    const JumpId id = cut.jump(corner);
    if (id != other.jump) other = otherSide(c, id);
    const Id there = vertexBeyond(other, turnedCorner(other.rotation, corner));
    Id& here = cell[own];
    const bool isHere = Brick<Id>::isVertex(here);
    const bool isThere = Brick<Id>::isVertex(there);
    if (there == Brick<Id>::kContested || isHere == isThere) {
      if (here != there) left |= CellCornerSet{1} << own;
    } else if (isThere) {
      here = there;
      hidden = true;
    }
  }
  return left;
}

/// The image of a cell on the other side of a cut.
template <class Id>
typename CellEmitter<Id>::OtherSide CellEmitter<Id>::otherSide(const ChartPoint& c, JumpId id) {
  OtherSide other;
  other.jump = id;
  if (id == kManyJumps) return other;
  const Jump& jump = jumps_[id];
  const ChartPoint image = jump.map.cell(c);
  const Brick<Id>* const brick = cache_.find(jump.to, image);
  if (brick == nullptr || brick->cuts == nullptr) return other;
  return {id,
          jump.inverse,
          jump.map.rotation,
          jump.to,
          image,
          brick,
          brick->cuts->cells[placeInBrick(image)],
          isInOneBrick(image)};
}

/// What the picture on the other side shows at a corner, of the image; "contested" if there are
/// further cuts on the way.
template <class Id>
Id CellEmitter<Id>::vertexBeyond(const OtherSide& other, std::size_t corner) {
  if (other.brick == nullptr) return Brick<Id>::kContested;
  if (other.cut.jump(corner) != other.back) return Brick<Id>::kContested;
  const ChartPoint point = plus(other.cell, kCellCorners[corner]);
  const Brick<Id>* const brick = other.inOneBrick ? other.brick : cache_.find(other.chart, point);
  return brick != nullptr ? brick->ids[placeInBrick(point)] : Brick<Id>::kEmpty;
}

/// Walks to some corners of a cell, and leaves what the picture shows of those to which a straight
/// way without a cut leads.
/// @return whether the picture does not show one of the others
template <class Id>
bool CellEmitter<Id>::emitIrregular(const GridPoint& z, CornerMask generator, CellCornerSet corners,
                                    Cell& cell) {
  bool hidden = false;
  const auto set = [&](std::size_t corner, Id vertex) {
    hidden = hidden || cell[corner] != vertex;
    cell[corner] = vertex;
  };
  const CellCornerSet missed =
      walker_.run(tet_, z, corners, [&](const CellWalker::Stop& stop, CellCornerSet arrived) {
        if (stop.inSight) return;
        for (; arrived != 0; arrived &= arrived - 1) {
          const auto c = memberOf(arrived);
          GridPoint corner = z;
          for (std::size_t k = 0; k < 3; ++k) corner[k] += kCellCorners[c][k];
          set(c, vertices_.vertexAt(stop.tet, stop.toTet(corner), cache_));
        }
      });
  if (missed != 0) tracer_.enter(tet_, z, generator);
  for (std::size_t c = 0; missed >> c != 0; ++c) {
    if (((missed >> c) & 1U) == 0) continue;
    const CornerPlace place = tracer_.trace(kCellCorners[c]);
    set(c, vertices_.vertexAt(place.tet, place.z, cache_));
  }
  return hidden;
}

template class CellEmitter<std::uint32_t>;
template class CellEmitter<std::uint64_t>;

}  // namespace hexhex
