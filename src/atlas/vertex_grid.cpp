#include <algorithm>

#include <atlas/brick_box.hpp>
#include <atlas/vertex_grid.hpp>

namespace hexhex {

namespace {

/// Tets of which each may take long.
constexpr std::size_t kFewTets = 16;

ChartRow rowOf(const VertexRun& run, const SweepFrame& frame, Index chart) {
  const SweptLine& line = *run.line;
  const std::int32_t first = line.first + static_cast<std::int32_t>(run.offset);
  return {chart, frame(line.level, line.row, first), frame.along(2), run.count};
}

template <class Id>
std::atomic_ref<Id> entry(Brick<Id>& brick, std::size_t place, std::ptrdiff_t offset) {
  return std::atomic_ref(
      brick.ids[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(place) + offset)]);
}

}  // namespace

template <class Id>
std::span<const SweptLine> VertexGrid<Id>::linesOf(Index tet,
                                                   std::vector<SweptLine>& scratch) const {
  if (stored_) return stored_->of(tet);
  scratch.clear();
  TetSweep(map_.exact, tet, SweptGrid::Vertices).run(map_.exact.unit, scratch);
  return scratch;
}

template <class Id>
void VertexGrid<Id>::sweep(CellSeeds& cells, Stage& stage) {
  const std::size_t tets = map_.topology.tetCount();
  VertexCounter counter(map_, numbers_);
  keys_.resize(blockCount(tets, kSweepBlock));
  parallelBlocks(stage, tets, kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t block) {
                   BlockLines lines(stored_.has_value());
                   BlockLines centers(cells.lines.has_value());
                   KeyFilter filter;
                   for (std::size_t t = begin; t < end; ++t) {
                     const auto tet = static_cast<Index>(t);
                     sweepBoth(map_.exact, tet, lines.next(), centers.next());
                     const std::span<const SweptLine> own = centers.last();
                     cells.begin[t] = own.empty() ? 0 : countOwned(map_.topology, tet, own);
                     counter.count(block, tet, lines.last());
                     if (!lines.last().empty())
                       collectKeys(tet, lines.last(), filter, keys_[block]);
                   }
                   if (stored_) stored_->store(block, lines);
                   if (cells.lines) cells.lines->store(block, centers);
                 });
  counter.finish();
  exclusiveScan(std::span(cells.begin));
}

/// Lists the bricks that the tet's points are in, and some beside them.
template <class Id>
void VertexGrid<Id>::collectKeys(Index tet, std::span<const SweptLine> lines, KeyFilter& filter,
                                 std::vector<BrickKey>& keys) const {
  constexpr std::uint64_t kMaxBricks = 8;
  const Index chart = charts_.chart[tet];
  const auto collect = [&](const ChartPoint& c) {
    const BrickKey key = brickKey(chart, c);
    if (filter.isNew(key, c)) keys.push_back(key);
  };
  const Gauge& gauge = charts_.gauge(tet);
  const BrickBox box(lines, gauge);
  if (box.count() <= kMaxBricks) {
    box.forEach(collect);
    return;
  }
  const SweepFrame frame(gauge, lines.front().axes());
  for (const SweptLine& line : lines) {
    const ChartRow row{chart, frame(line.level, line.row, line.first), frame.along(2), line.count};
    row.forEachPart(
        [&](const ChartPoint& c, std::uint32_t, std::uint32_t, std::ptrdiff_t) { collect(c); });
  }
}

template <class Id>
template <class VisitRun, class VisitRow>
void VertexGrid<Id>::forEachClaim(Index tet, Faces faces, const VisitRun& visitRun,
                                  const VisitRow& visitRow) const {
  std::vector<SweptLine> scratch;
  const std::span<const SweptLine> lines = linesOf(tet, scratch);
  if (lines.empty()) return;
  const SweepAxes axes = lines.front().axes;
  const SweepFrame frame(charts_.gauge(tet), axes());
  const Index chart = charts_.chart[tet];
  TetNumbering numbering(map_, numbers_, tet, axes);
  numbering.run(lines, [&](const VertexRun& run) {
    visitRun(run);
    visitRow(rowOf(run, frame, chart), run.first);
  });
  if (faces == Faces::Owned) return;
  for (int face = 0; face < 4; ++face) {
    if (((numbering.foreignFaces() >> face) & 1U) == 0) continue;
    // The owner enters the points of a glued face at the same places.
    if (faces == Faces::All ||
        !charts_.isGlued(map_.topology, map_.exact.transitions, halfFaceOf(tet, face))) {
      forEachForeignClaim(tet, face, visitRow);
    }
  }
}

/// The points of a face that another tet owns are numbered in the order of the owner's sweep.
template <class Id>
template <class VisitRow>
void VertexGrid<Id>::forEachForeignClaim(Index tet, int face, const VisitRow& visitRow) const {
  const HalfFace ownersHalfFace = map_.topology.mate[halfFaceOf(tet, face)];
  const Index owner = tetOf(ownersHalfFace);
  const Gauge gauge = charts_.gauge(tet) * map_.exact.transitions.across(ownersHalfFace);
  std::vector<SweptLine> scratch;
  const std::span<const SweptLine> lines = linesOf(owner, scratch);
  const SweepAxes axes = lines.front().axes;
  const SweepFrame frame(gauge, axes());
  TetNumbering(map_, numbers_, owner, axes).run(lines, [&](const VertexRun& run) {
    if (run.simplex != faceMask(localOf(ownersHalfFace))) return;
    visitRow(rowOf(run, frame, charts_.chart[tet]), run.first);
  });
}

template <class Id>
void VertexGrid<Id>::write(const VertexRun& run, Index tet, std::optional<TetPositions>& positions,
                           const VertexArrays& arrays) const {
  if (!run.owned || arrays.points == nullptr) return;
  const SweptLine& line = *run.line;
  if (!positions) {
    positions.emplace(map_, tet, gridBox(map_.exact.corners[tet], map_.exact.unit), line.axes);
  }
  const std::size_t at = run.first - arrays.first;
  if (run.simplex == kWholeTet) {
    positions->alongLine(line.level, line.row, line.first + static_cast<std::int32_t>(run.offset),
                         run.count, arrays.points + at);
  } else {
    for (std::uint32_t i = 0; i < run.count; ++i) {
      arrays.points[at + i] = positions->at(run.simplex, line.point(run.offset + i));
    }
  }
  std::fill_n(arrays.tets + at, run.count, tet);
  std::fill_n(arrays.corners + at, run.count, map_.input.callersCorners(run.simplex));
}

template <class Id>
void VertexGrid<Id>::fill(const VertexArrays& arrays, Stage& stage) {
  grid_.build(keys_, stage);
  keys_ = {};
  // One thread alone sees every claim before its own; of several, one that exchanges does.
  std::atomic<bool> overlaps{false};
  const auto fillBlock = [&](std::size_t begin, std::size_t end, const auto& replace) {
    BrickCache<Id> cache(grid_);
    bool overlapsHere = false;
    const auto enter = [&](const ChartRow& row, std::uint64_t first) {
      row.forEachPart([&](const ChartPoint& c, std::uint32_t offset, std::uint32_t count,
                          std::ptrdiff_t stride) {
        Bricks& brick = *cache.find(row.chart, c);
        const std::size_t place = placeInBrick(c);
        for (std::uint32_t i = 0; i < count; ++i) {
          const auto id = static_cast<Id>(first + offset + i);
          const Id before = replace(entry(brick, place, i * stride), id);
          if (before == Bricks::kEmpty || before == id) continue;
          overlapsHere = true;
          std::atomic_ref(brick.contested).store(1, std::memory_order_relaxed);
        }
      });
    };
    for (std::size_t t = begin; t < end; ++t) {
      const auto tet = static_cast<Index>(t);
      if (stored_ && stored_->areEmpty(tet)) continue;
      std::optional<TetPositions> positions;
      forEachClaim(
          tet, Faces::OwnedAndCut,
          [&](const VertexRun& run) { write(run, tet, positions, arrays); }, enter);
    }
    if (overlapsHere) overlaps.store(true, std::memory_order_relaxed);
  };
  const bool alone = currentThreads() == 1;
  parallelBlocks(stage, map_.topology.tetCount(), kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                   if (alone) {
                     fillBlock(begin, end, [](const std::atomic_ref<Id>& at, Id id) {
                       const Id before = at.load(std::memory_order_relaxed);
                       at.store(id, std::memory_order_relaxed);
                       return before;
                     });
                   } else {
                     fillBlock(begin, end, [](const std::atomic_ref<Id>& at, Id id) {
                       return at.exchange(id, std::memory_order_relaxed);
                     });
                   }
                 });
  overlaps_ = overlaps.load();
}

template <class Id>
void VertexGrid<Id>::describe(Index tet, const VertexArrays& arrays) const {
  std::optional<TetPositions> positions;
  forEachClaim(
      tet, Faces::Owned, [&](const VertexRun& run) { write(run, tet, positions, arrays); },
      [](const ChartRow&, std::uint64_t) {});
}

/// The tets with a contested point of some brick in their bounding box.
template <class Id>
std::vector<Index> VertexGrid<Id>::tetsNearContested(Stage& stage) const {
  const std::vector<BrickKey> contested = grid_.contested();
  const auto isNear = [&](Index tet, BrickCache<Id>& cache) {
    const GridBox points = gridBox(map_.exact.corners[tet], map_.exact.unit);
    if (points.empty()) return false;
    const BrickBox box(points, charts_.gauge(tet));
    const Index chart = charts_.chart[tet];
    if (contested.size() < box.count()) {
      return std::any_of(contested.begin(), contested.end(),
                         [&](BrickKey key) { return box.mayContain(chart, key); });
    }
    bool found = false;
    box.forEach([&](const ChartPoint& c) {
      const Bricks* const brick = cache.find(chart, c);
      found = found || (brick != nullptr && brick->contested != 0);
    });
    return found;
  };
  return collectFromBlocks<Index>(
      stage, map_.topology.tetCount(), kSweepBlock,
      [&](std::size_t begin, std::size_t end, std::vector<Index>& tets) {
        BrickCache<Id> cache(grid_);
        for (std::size_t t = begin; t < end; ++t) {
          if (isNear(static_cast<Index>(t), cache)) tets.push_back(static_cast<Index>(t));
        }
      });
}

/// Marks all points that two vertices claim. Entries are only ever replaced by "contested", so it
/// does not matter who looks first.
template <class Id>
void VertexGrid<Id>::markContested(const std::vector<Index>& tets, Stage& stage) {
  parallelBlocks(
      stage, tets.size(), kFewTets, [&](std::size_t begin, std::size_t end, std::size_t) {
        BrickCache<Id> cache(grid_);
        for (std::size_t t = begin; t < end; ++t) {
          forEachClaim(
              tets[t], Faces::OwnedAndCut, [](const VertexRun&) {},
              [&](const ChartRow& row, std::uint64_t first) {
                row.forEachPart([&](const ChartPoint& c, std::uint32_t offset, std::uint32_t count,
                                    std::ptrdiff_t stride) {
                  Bricks& brick = *cache.find(row.chart, c);
                  const std::size_t place = placeInBrick(c);
                  for (std::uint32_t i = 0; i < count; ++i) {
                    const auto at = entry(brick, place, i * stride);
                    if (at.load(std::memory_order_relaxed) == static_cast<Id>(first + offset + i)) {
                      continue;
                    }
                    at.store(Bricks::kContested, std::memory_order_relaxed);
                  }
                });
              });
        }
      });
}

/// Whether a tet has a contested point.
template <class Id>
bool VertexGrid<Id>::isContested(Index tet, BrickCache<Id>& cache) const {
  bool contested = false;
  forEachClaim(
      tet, Faces::All, [](const VertexRun&) {},
      [&](const ChartRow& row, std::uint64_t) {
        row.forEachPart(
            [&](const ChartPoint& c, std::uint32_t, std::uint32_t count, std::ptrdiff_t stride) {
              Bricks& brick = *cache.find(row.chart, c);
              const std::size_t place = placeInBrick(c);
              for (std::uint32_t i = 0; i < count; ++i) {
                contested =
                    contested || entry(brick, place, i * stride).load(std::memory_order_relaxed) ==
                                     Bricks::kContested;
              }
            });
      });
  return contested;
}

template <class Id>
void VertexGrid<Id>::clearContested(const std::vector<Index>& tets) {
  for (const Index tet : tets) {
    forEachClaim(
        tet, Faces::All, [](const VertexRun&) {},
        [&](const ChartRow& row, std::uint64_t) {
          row.forEachPart(
              [&](const ChartPoint& c, std::uint32_t, std::uint32_t count, std::ptrdiff_t stride) {
                Bricks& brick = *grid_.find(brickKey(row.chart, c));
                const std::size_t place = placeInBrick(c);
                for (std::uint32_t i = 0; i < count; ++i) {
                  const auto at = entry(brick, place, i * stride);
                  if (at.load(std::memory_order_relaxed) == Bricks::kContested) {
                    at.store(Bricks::kEmpty, std::memory_order_relaxed);
                  }
                }
              });
        });
  }
}

/// Claims all points of a tet in a chart if none of them belongs to another vertex.
template <class Id>
bool VertexGrid<Id>::tryClaim(Index tet, Index chart) {
  bool free = true;
  const auto forEachEntry = [&](const auto& visit) {
    forEachClaim(
        tet, Faces::All, [](const VertexRun&) {},
        [&](const ChartRow& row, std::uint64_t first) {
          row.forEachPart([&](const ChartPoint& c, std::uint32_t offset, std::uint32_t count,
                              std::ptrdiff_t stride) { visit(c, first + offset, count, stride); });
        });
  };
  forEachEntry(
      [&](const ChartPoint& c, std::uint64_t first, std::uint32_t count, std::ptrdiff_t stride) {
        Bricks* const brick = free ? grid_.find(brickKey(chart, c)) : nullptr;
        if (brick == nullptr) return;
        const std::size_t place = placeInBrick(c);
        for (std::uint32_t i = 0; i < count; ++i) {
          const Id found = entry(*brick, place, i * stride).load(std::memory_order_relaxed);
          free = free && (found == Bricks::kEmpty || found == static_cast<Id>(first + i));
        }
      });
  if (!free) return false;
  forEachEntry([&](const ChartPoint& c, std::uint64_t first, std::uint32_t count,
                   std::ptrdiff_t stride) {
    Bricks& brick = grid_.add(brickKey(chart, c));
    const std::size_t place = placeInBrick(c);
    for (std::uint32_t i = 0; i < count; ++i) {
      entry(brick, place, i * stride).store(static_cast<Id>(first + i), std::memory_order_relaxed);
    }
  });
  return true;
}

/// Takes pending tets into a chart, breadth first, as long as they fit.
template <class Id>
void VertexGrid<Id>::grow(Index seed, Index chart, Array<std::uint8_t>& pending) {
  if (!tryClaim(seed, chart)) return;
  std::vector<Index> queue(1, seed);
  pending[seed] = 0;
  charts_.chart[seed] = chart;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    for (int face = 0; face < 4; ++face) {
      const HalfFace halfFace = halfFaceOf(queue[head], face);
      const HalfFace mate = map_.topology.mate[halfFace];
      if (mate == kNone || pending[tetOf(mate)] == 0) continue;
      if (!charts_.gaugesAgree(map_.topology, map_.exact.transitions, halfFace)) continue;
      if (!tryClaim(tetOf(mate), chart)) continue;
      pending[tetOf(mate)] = 0;
      charts_.chart[tetOf(mate)] = chart;
      queue.push_back(tetOf(mate));
    }
  }
}

template <class Id>
OverlapCounts VertexGrid<Id>::resolveOverlaps(Stage& stage) {
  OverlapCounts counts;
  if (!overlaps_) return counts;
  const std::vector<Index> near = tetsNearContested(stage);
  markContested(near, stage);
  const auto tets = collectFromBlocks<Index>(
      stage, near.size(), kFewTets,
      [&](std::size_t begin, std::size_t end, std::vector<Index>& contested) {
        BrickCache<Id> cache(grid_);
        for (std::size_t i = begin; i < end; ++i) {
          if (isContested(near[i], cache)) contested.push_back(near[i]);
        }
      });
  counts.tets = tets.size();
  clearContested(tets);
  Array<std::uint8_t> pending(map_.topology.tetCount(), 0);
  std::vector<Index> before;
  for (const Index tet : tets) {
    pending[tet] = 1;
    before.push_back(charts_.chart[tet]);
    charts_.chart[tet] = Charts::kNoChart;
  }
  // One sheet after the other: the first may stay, so that the border of the others is all that is
  // cut anew.
  for (std::size_t i = 0; i < tets.size(); ++i) {
    if (pending[tets[i]] != 0) grow(tets[i], before[i], pending);
  }
  for (const Index tet : tets) {
    if (pending[tet] == 0) continue;
    grow(tet, charts_.count, pending);
    ++charts_.count;
    ++counts.charts;
    // Only a tet that overlaps itself (modulo 2^19 grid units) does not fit an empty chart.
    if (pending[tet] != 0) ++counts.homelessTets;
    pending[tet] = 0;
  }
  return counts;
}

template <class Id>
Id VertexGrid<Id>::vertexAt(Index tet, const GridPoint& z, BrickCache<Id>& cache) const {
  if (charts_.chart[tet] != Charts::kNoChart) {
    const ChartPoint c = charts_.gauge(tet)(z);
    Bricks* const brick = cache.find(charts_.chart[tet], c);
    if (brick != nullptr) {
      const Id id = brick->ids[placeInBrick(c)];
      if (Bricks::isVertex(id)) return id;
    }
  }
  return static_cast<Id>(exactNumber(tet, z));
}

template <class Id>
std::uint64_t VertexGrid<Id>::exactNumber(Index tet, const GridPoint& z) const {
  std::vector<SweptLine> scratch;
  const std::span<const SweptLine> lines = linesOf(tet, scratch);
  const SweepAxes order = lines.empty() ? SweepAxes{} : lines.front().axes;
  const std::array<std::uint8_t, 3>& axes = order();
  std::optional<std::uint64_t> found;
  TetNumbering numbering(map_, numbers_, tet, order);
  numbering.run(lines, [&](const VertexRun& run) {
    if (run.line->level != z[axes[0]] || run.line->row != z[axes[1]]) return;
    const auto offset = static_cast<std::uint32_t>(z[axes[2]] - run.line->first) - run.offset;
    if (offset < run.count) found = run.first + offset;
  });
  if (found) return *found;
  for (int face = 0; face < 4; ++face) {
    if (((numbering.foreignFaces() >> face) & 1U) == 0) continue;
    const HalfFace halfFace = halfFaceOf(tet, face);
    const Index owner = tetOf(map_.topology.mate[halfFace]);
    if (TetPlanes(map_.exact.corners[tet], map_.exact.unit).generator(z) != faceMask(face))
      continue;
    return exactNumber(owner, map_.exact.transitions.across(halfFace)(z));
  }
  throw Error(ErrorCode::Internal,
              "A corner of a cell is no hex vertex. The map passed all checks, so this is a bug; "
              "please report it with the map.",
              {PlaceKind::Tet, tet});
}

template class VertexGrid<std::uint32_t>;
template class VertexGrid<std::uint64_t>;

}  // namespace hexhex
