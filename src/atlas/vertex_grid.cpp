// Enters the vertices of all tets into the grid (docs/developer/atlas.md).
#include <algorithm>
#include <cassert>

#include <atlas/overlaps.hpp>
#include <atlas/vertex_grid.hpp>
#include <base/workspaces.hpp>

namespace hexhex::atlas {

namespace {

ChartRow rowOf(const sweep::VertexRun& run, const SweepFrame& frame, Index chart) {
  const lattice::SweptLine& line = *run.line;
  const std::int32_t first = line.first + static_cast<std::int32_t>(run.offset);
  return {chart, frame(line.level, line.row, first), frame.along(2), run.count};
}

/// Enters consecutive vertices. Of two that claim the same place, the later one finds the other,
/// and marks the brick.
/// @return whether any did
template <class Id>
bool enterVertices(Brick<Id>& brick, std::size_t place, std::ptrdiff_t stride, std::uint64_t first,
                   std::uint32_t count) {
  Id* entry = brick.ids.data() + place;
  bool overlaps = false;
  for (std::uint32_t i = 0; i < count; ++i, entry += stride) {
    const auto id = static_cast<Id>(first + i);
    overlaps = overlaps || (*entry != Brick<Id>::kEmpty && *entry != id);
    *entry = id;
  }
  if (overlaps) brick.contested = 1;
  return overlaps;
}

}  // namespace

template <class Id>
std::span<const lattice::SweptLine> VertexGrid<Id>::linesOf(
    Index tet, std::vector<lattice::SweptLine>& scratch) const {
  if (stored_) {
    if (region_ == nullptr) return stored_->of(tet);
    const std::vector<Index>& tets = region_->tets;
    const auto at = std::lower_bound(tets.begin(), tets.end(), tet);
    if (at != tets.end() && *at == tet) return stored_->of(static_cast<Index>(at - tets.begin()));
  }
  scratch.clear();
  lattice::TetRasterizer(map_.exact.corners[tet], map_.exact.unit)
      .append(lattice::kVertexGrid, scratch);
  return scratch;
}

template <class Id>
void VertexGrid<Id>::sweep(sweep::CellCenters& cells, Stage& stage, sweep::SweepObserver* observer,
                           bool fewPoints) {
  const std::size_t tets = map_.topology.tetCount();
  sweep::VertexCounter counter(map_, *swept_);
  keys_.resize(blockCount(tets, sweep::kSweepBlock));
  const auto makeLines = [&] {
    return SweptLines{sweep::BlockLines(stored_.has_value()),
                      sweep::BlockLines(cells.lines.has_value())};
  };
  const auto sweepBlock = [&](std::size_t begin, std::size_t end, std::size_t block,
                              SweptLines& swept) {
    auto& [lines, centers] = swept;
    lines.clear();
    centers.clear();
    KeyFilter filter;
    keys_[block].reserve(sweep::kSweepBlock / 16);
    for (std::size_t t = begin; t < end; ++t) {
      const auto tet = static_cast<Index>(t);
      std::vector<lattice::SweptLine>& ofVertices = lines.next();
      std::vector<lattice::SweptLine>& ofCenters = centers.next();
      lattice::TetRasterizer rasterizer(map_.exact.corners[t], map_.exact.unit, 0, fewPoints);
      rasterizer.append(lattice::kVertexGrid, ofVertices);
      rasterizer.append(lattice::kCenterGrid, ofCenters);
      if (observer != nullptr) observer->add(block, tet, rasterizer);
      cells.begin[t] = 0;
      counter.countNothing(tet);
      if (const auto own = centers.last(); !own.empty()) {
        cells.begin[t] = sweep::countOwned(map_.topology, tet, own);
      }
      if (const auto own = lines.last(); !own.empty()) {
        counter.count(block, tet, own);
        collectKeys(tet, own, filter, keys_[block]);
      }
    }
    if (stored_) stored_->store(block, lines);
    if (cells.lines) cells.lines->store(block, centers);
    lines.shrink();
    centers.shrink();
  };
  parallelBlocksWith(stage, tets, sweep::kSweepBlock, makeLines, sweepBlock);
  counter.finish();
  exclusiveScan(std::span(cells.begin));
}

/// Sweeps the tets of a region, and lists its bricks. Only these are made, which leaves out most
/// claims beyond the boxes.
template <class Id>
void VertexGrid<Id>::collectRegion(Stage& stage) {
  assert(std::is_sorted(region_->tets.begin(), region_->tets.end()));
  assert(region_->begin.size() == region_->tets.size() + 1);
  const std::size_t tets = tetCount();
  keys_.resize(blockCount(tets, sweep::kSweepBlock));
  stored_.emplace(tets);
  parallelBlocks(stage, tets, sweep::kSweepBlock,
                 [&](std::size_t begin, std::size_t end, std::size_t b) {
                   KeyFilter filter;
                   sweep::BlockLines lines(true);
                   std::vector<lattice::SweptLine> clipped;
                   for (std::size_t i = begin; i < end; ++i) {
                     lattice::TetRasterizer(map_.exact.corners[tetAt(i)], map_.exact.unit)
                         .append(lattice::kVertexGrid, lines.next());
                     clipped.clear();
                     BoxedLines boxed(region_->boxesOf(i), 0);
                     for (const lattice::SweptLine& line : lines.last()) {
                       for (const auto& [first, count] : boxed.of(line)) {
                         clipped.push_back(line);
                         clipped.back().first += static_cast<std::int32_t>(first);
                         clipped.back().count = count;
                       }
                     }
                     collectKeys(tetAt(i), clipped, filter, keys_[b]);
                   }
                   stored_->store(b, lines);
                 });
}

/// Calls visit(ChartPoint) for the first point of each row of the tet's points in each brick.
template <class Id>
template <class Visit>
void VertexGrid<Id>::forEachBrick(Index tet, std::span<const lattice::SweptLine> lines,
                                  const Visit& visit) const {
  if (lines.empty()) return;
  const SweepFrame frame(charts_.gauge(tet), lines.front().axes());
  for (const lattice::SweptLine& line : lines) {
    const ChartRow row{charts_.chart[tet], frame(line.level, line.row, line.first), frame.along(2),
                       line.count};
    row.forEachPart([&](const lattice::ChartPoint& c, std::uint32_t, std::uint32_t,
                        std::ptrdiff_t) { visit(c); });
  }
}

/// Lists the bricks that contain the tet's points.
template <class Id>
void VertexGrid<Id>::collectKeys(Index tet, std::span<const lattice::SweptLine> lines,
                                 KeyFilter& filter, std::vector<BrickKey>& keys) const {
  forEachBrick(tet, lines, [&](const lattice::ChartPoint& c) {
    const BrickKey key = brickKey(charts_.chart[tet], c);
    if (filter.isNew(key, c)) keys.push_back(key);
  });
}

template <class Id>
template <class VisitRun, class VisitRow>
void VertexGrid<Id>::forEachClaim(Index tet, Faces faces, const VisitRun& visitRun,
                                  const VisitRow& visitRow) const {
  std::vector<lattice::SweptLine> scratch;
  const std::span<const lattice::SweptLine> lines = linesOf(tet, scratch);
  if (lines.empty()) return;
  const lattice::SweepAxes axes = lines.front().axes;
  const SweepFrame frame(charts_.gauge(tet), axes());
  const Index chart = charts_.chart[tet];
  sweep::TetNumbering numbering(map_, numbers_, tet, axes);
  numbering.run(lines, [&](const sweep::VertexRun& run) {
    visitRun(run);
    visitRow(rowOf(run, frame, chart), run.first);
  });
  if (faces == Faces::Owned) return;
  for (int face = 0; face < 4; ++face) {
    if (((numbering.foreignFaces() >> face) & 1U) == 0) continue;
    // The owner enters the points of a glued face in the same places.
    if (faces == Faces::All ||
        !charts_.isGlued(map_.topology, map_.exact.transitions, adjacency::halfFaceOf(tet, face))) {
      forEachForeignClaim(tet, face, visitRow);
    }
  }
}

/// The points of a face owned by another tet are numbered in the order of the owner's sweep.
template <class Id>
template <class VisitRow>
void VertexGrid<Id>::forEachForeignClaim(Index tet, int face, const VisitRow& visitRow) const {
  const adjacency::HalfFace ownersHalfFace = map_.topology.mate[adjacency::halfFaceOf(tet, face)];
  const Index owner = adjacency::tetOf(ownersHalfFace);
  const lattice::Gauge gauge = charts_.gauge(tet) * map_.exact.transitions.across(ownersHalfFace);
  std::vector<lattice::SweptLine> scratch;
  const std::span<const lattice::SweptLine> lines = linesOf(owner, scratch);
  const lattice::SweepAxes axes = lines.front().axes;
  const SweepFrame frame(gauge, axes());
  sweep::TetNumbering(map_, numbers_, owner, axes).run(lines, [&](const sweep::VertexRun& run) {
    if (run.simplex != lattice::faceMask(adjacency::localOf(ownersHalfFace))) return;
    visitRow(rowOf(run, frame, charts_.chart[tet]), run.first);
  });
}

template <class Id>
void VertexGrid<Id>::write(const sweep::VertexRun& run, Index tet,
                           std::optional<sweep::TetPositions>& positions,
                           const VertexArrays& arrays) const {
  if (!run.owned || arrays.points == nullptr) return;
  const lattice::SweptLine& line = *run.line;
  if (!positions) positions.emplace(map_, tet, line.axes);
  const std::size_t at = run.first - arrays.first;
  if (run.simplex == lattice::kWholeTet) {
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
  std::atomic<bool> overlaps{false};
  const auto fillBlock = [&](std::size_t begin, std::size_t end, std::size_t /*block*/,
                             BrickCache<Id>& cache) {
    bool overlapsHere = false;
    const auto enter = [&](const ChartRow& row, std::uint64_t first) {
      row.forEachPart([&](const lattice::ChartPoint& c, std::uint32_t offset, std::uint32_t count,
                          std::ptrdiff_t stride) {
        Bricks* const brick = cache.find(row.chart, c);
        if (brick == nullptr) return;  // beyond the region
        const BrickLock<Id> lock(*brick);
        overlapsHere |= enterVertices(*brick, placeInBrick(c), stride, first + offset, count);
      });
    };
    for (std::size_t i = begin; i < end; ++i) {
      const Index tet = tetAt(i);
      if (stored_ && stored_->areEmpty(static_cast<Index>(i))) continue;
      std::optional<sweep::TetPositions> positions;
      forEachClaim(
          tet, Faces::OwnedAndCut,
          [&](const sweep::VertexRun& run) { write(run, tet, positions, arrays); }, enter);
    }
    if (overlapsHere) overlaps.store(true, std::memory_order_relaxed);
  };
  parallelBlocksWith(
      stage, tetCount(), sweep::kSweepBlock, [this] { return BrickCache<Id>(grid_); }, fillBlock);
  overlaps_ = overlaps.load();
}

template <class Id>
void VertexGrid<Id>::describe(Index tet, const VertexArrays& arrays) const {
  std::optional<sweep::TetPositions> positions;
  forEachClaim(
      tet, Faces::Owned, [&](const sweep::VertexRun& run) { write(run, tet, positions, arrays); },
      [](const ChartRow&, std::uint64_t) {});
}

template <class Id>
std::uint64_t VertexGrid<Id>::resolveOverlaps(Stage& stage) {
  if (!overlaps_) return 0;
  const auto isNearContested = [&](Index tet, std::vector<lattice::SweptLine>& scratch,
                                   BrickCache<Id>& cache) {
    bool isNear = false;
    forEachBrick(tet, linesOf(tet, scratch), [&](const lattice::ChartPoint& c) {
      isNear = isNear || cache.at(charts_.chart[tet], c).contested != 0;
    });
    return isNear;
  };
  const auto listTets = [&](std::size_t begin, std::size_t end, std::vector<std::size_t>& list) {
    const std::vector<BrickKey>& keys = keys_[begin / sweep::kSweepBlock];
    if (std::none_of(keys.begin(), keys.end(),
                     [this](BrickKey key) { return grid_.find(key)->contested != 0; })) {
      return;
    }
    BrickCache<Id> cache(grid_);
    std::vector<lattice::SweptLine> scratch;
    for (std::size_t i = begin; i < end; ++i) {
      if (isNearContested(tetAt(i), scratch, cache)) list.push_back(i);
    }
  };
  const auto tets = collectFromBlocks<std::size_t>(stage, tetCount(), sweep::kSweepBlock, listTets);
  // Listed once, as finding the owners of vertices takes longer than everything after that.
  std::vector<TetClaims> claims(tets.size());
  constexpr std::size_t kListedTets = 64;
  struct Listing {
    BrickCache<Id> cache;
    std::vector<Claim> claims;
  };
  const auto list = [&](std::size_t i, Listing& listing) {
    std::vector<Claim>& listed = listing.claims;
    listed.clear();
    forEachClaim(
        tetAt(tets[i]), Faces::All, [](const sweep::VertexRun&) {},
        [&](const ChartRow& row, std::uint64_t first) {
          if (region_ == nullptr) {
            listed.push_back({row, first});
            return;
          }
          // No more than the region needs, since a tet that moves gets bricks for all its claims.
          row.forEachPart([&](const lattice::ChartPoint& c, std::uint32_t offset,
                              std::uint32_t count, std::ptrdiff_t /*stride*/) {
            if (listing.cache.find(row.chart, c) == nullptr) return;
            ChartRow part = row;
            part.start = c;
            part.count = count;
            listed.push_back({part, first + offset});
          });
        });
    claims[i] = {tetAt(tets[i]), listed};
  };
  parallelForWith(
      stage, tets.size(), kListedTets,
      [this] {
        return Listing{BrickCache<Id>(grid_), {}};
      },
      list);
  return atlas::resolveOverlaps(map_, claims, charts_, grid_, stage);
}

template <class Id>
Id VertexGrid<Id>::vertexAt(Index tet, const lattice::GridPoint& z, BrickCache<Id>& cache) const {
  if (charts_.chart[tet] != Charts::kNoChart) {
    const Id id = cache.idAt(charts_.chart[tet], charts_.gauge(tet)(z));
    if (Bricks::isVertex(id)) return id;
  }
  return static_cast<Id>(exactNumber(tet, z));
}

template <class Id>
std::uint64_t VertexGrid<Id>::exactNumber(Index tet, const lattice::GridPoint& z) const {
  std::vector<lattice::SweptLine> scratch;
  const std::span<const lattice::SweptLine> lines = linesOf(tet, scratch);
  const lattice::SweepAxes order = lines.empty() ? lattice::SweepAxes{} : lines.front().axes;
  const std::array<std::uint8_t, 3>& axes = order();
  std::optional<std::uint64_t> found;
  sweep::TetNumbering numbering(map_, numbers_, tet, order);
  numbering.run(lines, [&](const sweep::VertexRun& run) {
    if (run.line->level != z[axes[0]] || run.line->row != z[axes[1]]) return;
    const auto offset = static_cast<std::uint32_t>(z[axes[2]] - run.line->first) - run.offset;
    if (offset < run.count) found = run.first + offset;
  });
  if (found) return *found;
  for (int face = 0; face < 4; ++face) {
    if (((numbering.foreignFaces() >> face) & 1U) == 0) continue;
    const adjacency::HalfFace halfFace = adjacency::halfFaceOf(tet, face);
    const Index owner = adjacency::tetOf(map_.topology.mate[halfFace]);
    if (lattice::simplexOf(map_.exact.corners[tet], z, map_.exact.unit) != lattice::faceMask(face))
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

}  // namespace hexhex::atlas
