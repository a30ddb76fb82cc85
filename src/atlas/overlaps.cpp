#include <algorithm>
#include <atomic>

#include <atlas/brick_box.hpp>
#include <atlas/overlaps.hpp>
#include <base/parallel.hpp>

namespace hexhex {

namespace {

/// Tets of which each may take long.
constexpr std::size_t kFewTets = 64;

/// Calls visit(entry, id) for all points of a row in one brick.
/// @param first  id of the first one
template <class Id, class Visit>
void forEachEntry(Brick<Id>& brick, const ChartPoint& c, std::uint64_t first, std::uint32_t count,
                  std::ptrdiff_t stride, const Visit& visit) {
  auto place = static_cast<std::ptrdiff_t>(placeInBrick(c));
  for (std::uint32_t i = 0; i < count; ++i, place += stride) {
    visit(std::atomic_ref(brick.ids[static_cast<std::size_t>(place)]), static_cast<Id>(first + i));
  }
}

/// The same for all points of a claim in its chart, whose bricks exist.
template <class Id, class Visit>
void forEachEntry(const Claim& claim, BrickCache<Id>& cache, const Visit& visit) {
  claim.row.forEachPart([&](const ChartPoint& c, std::uint32_t offset, std::uint32_t count,
                            std::ptrdiff_t stride) {
    forEachEntry(*cache.find(claim.row.chart, c), c, claim.first + offset, count, stride, visit);
  });
}

}  // namespace

/// The tets with a contested point of some brick in their bounding box.
template <class Id>
std::vector<Index> Overlaps<Id>::tetsNearContested(Stage& stage) const {
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

/// Lists claims once, as finding the owners of vertices takes longer than all that follows.
template <class Id>
std::vector<typename Overlaps<Id>::ClaimBlock> Overlaps<Id>::claimsOf(std::span<const Index> tets,
                                                                      Stage& stage) const {
  std::vector<ClaimBlock> blocks(blockCount(tets.size(), kFewTets));
  parallelBlocks(stage, tets.size(), kFewTets,
                 [&](std::size_t begin, std::size_t end, std::size_t b) {
                   ClaimBlock& block = blocks[b];
                   for (const Index tet : tets.subspan(begin, end - begin)) {
                     listClaims_(tet, block.claims);
                     block.tets.push_back(tet);
                     block.ends.push_back(block.claims.size());
                   }
                 });
  return blocks;
}

/// Marks all points that two vertices claim. Entries are only ever replaced by "contested", so it
/// does not matter who looks first.
template <class Id>
void Overlaps<Id>::mark(const ClaimBlock& block) {
  BrickCache<Id> cache(grid_);
  for (const Claim& claim : block.claims) {
    forEachEntry(claim, cache, [](const std::atomic_ref<Id>& entry, Id id) {
      if (entry.load(std::memory_order_relaxed) == id) return;
      entry.store(Bricks::kContested, std::memory_order_relaxed);
    });
  }
}

/// The tets that claim a contested point.
template <class Id>
std::vector<typename Overlaps<Id>::ClaimingTet> Overlaps<Id>::contestedOf(
    const ClaimBlock& block) const {
  BrickCache<Id> cache(grid_);
  std::vector<ClaimingTet> tets;
  for (std::size_t i = 0; i < block.tets.size(); ++i) {
    const ClaimingTet tet = block.at(i);
    bool contested = false;
    for (const Claim& claim : tet.claims) {
      forEachEntry(claim, cache, [&contested](const std::atomic_ref<Id>& entry, Id /*id*/) {
        contested = contested || entry.load(std::memory_order_relaxed) == Bricks::kContested;
      });
    }
    if (contested) tets.push_back(tet);
  }
  return tets;
}

template <class Id>
void Overlaps<Id>::clear(const ClaimingTet& tet, BrickCache<Id>& cache) {
  for (const Claim& claim : tet.claims) {
    forEachEntry(claim, cache, [](const std::atomic_ref<Id>& entry, Id /*id*/) {
      if (entry.load(std::memory_order_relaxed) != Bricks::kContested) return;
      entry.store(Bricks::kEmpty, std::memory_order_relaxed);
    });
  }
}

/// Claims all points of a tet in a chart if none of them belongs to another vertex.
template <class Id>
bool Overlaps<Id>::tryClaim(const ClaimingTet& tet, Index chart) {
  const auto forEachPart = [&](const auto& visit) {
    for (const Claim& claim : tet.claims) {
      claim.row.forEachPart([&](const ChartPoint& c, std::uint32_t offset, std::uint32_t count,
                                std::ptrdiff_t stride) {
        visit(brickKey(chart, c), c, claim.first + offset, count, stride);
      });
    }
  };
  bool free = true;
  forEachPart([&](BrickKey key, const ChartPoint& c, std::uint64_t first, std::uint32_t count,
                  std::ptrdiff_t stride) {
    Bricks* const brick = free ? grid_.find(key) : nullptr;
    if (brick == nullptr) return;
    forEachEntry(*brick, c, first, count, stride, [&free](const std::atomic_ref<Id>& entry, Id id) {
      const Id found = entry.load(std::memory_order_relaxed);
      free = free && (found == Bricks::kEmpty || found == id);
    });
  });
  if (!free) return false;
  forEachPart([&](BrickKey key, const ChartPoint& c, std::uint64_t first, std::uint32_t count,
                  std::ptrdiff_t stride) {
    forEachEntry(grid_.add(key), c, first, count, stride,
                 [](const std::atomic_ref<Id>& entry, Id id) {
                   entry.store(id, std::memory_order_relaxed);
                 });
  });
  charts_.chart[tet.tet] = chart;
  pending_[tet.tet] = kNone;
  return true;
}

/// Takes pending tets into a chart, breadth first, as long as they fit.
template <class Id>
void Overlaps<Id>::grow(std::size_t seed, Index chart) {
  if (!tryClaim(contested_[seed], chart)) return;
  std::vector<Index> queue(1, contested_[seed].tet);
  for (std::size_t head = 0; head < queue.size(); ++head) {
    for (int face = 0; face < 4; ++face) {
      const HalfFace halfFace = halfFaceOf(queue[head], face);
      const HalfFace mate = map_.topology.mate[halfFace];
      if (mate == kNone || pending_[tetOf(mate)] == kNone) continue;
      if (!charts_.gaugesAgree(map_.topology, map_.exact.transitions, halfFace)) continue;
      if (tryClaim(contested_[pending_[tetOf(mate)]], chart)) queue.push_back(tetOf(mate));
    }
  }
}

template <class Id>
OverlapCounts Overlaps<Id>::resolve(Stage& stage) {
  const std::vector<ClaimBlock> blocks = claimsOf(tetsNearContested(stage), stage);
  parallelFor(stage, blocks.size(), 1, [&](std::size_t b) { mark(blocks[b]); });
  contested_ = collectFromBlocks<ClaimingTet>(
      stage, blocks.size(), 1,
      [&](std::size_t b, std::size_t /*end*/, std::vector<ClaimingTet>& tets) {
        tets = contestedOf(blocks[b]);
      });
  parallelBlocks(stage, contested_.size(), kFewTets,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   BrickCache<Id> cache(grid_);
                   for (std::size_t i = begin; i < end; ++i) clear(contested_[i], cache);
                 });
  pending_.assign(map_.topology.tetCount(), kNone);
  std::vector<Index> before;
  for (std::size_t i = 0; i < contested_.size(); ++i) {
    const Index tet = contested_[i].tet;
    pending_[tet] = static_cast<Index>(i);
    before.push_back(charts_.chart[tet]);
    charts_.chart[tet] = Charts::kNoChart;
  }
  OverlapCounts counts;
  counts.tets = contested_.size();
  // One sheet after the other: the first may stay, so that the border of the others is all that is
  // cut anew.
  for (std::size_t i = 0; i < contested_.size(); ++i) {
    if (pending_[contested_[i].tet] != kNone) grow(i, before[i]);
  }
  for (std::size_t i = 0; i < contested_.size(); ++i) {
    const Index tet = contested_[i].tet;
    if (pending_[tet] == kNone) continue;
    grow(i, charts_.count);
    ++charts_.count;
    ++counts.charts;
    // Only a tet that overlaps itself (modulo 2^19 grid units) does not fit an empty chart.
    if (pending_[tet] != kNone) ++counts.homelessTets;
    pending_[tet] = kNone;
  }
  return counts;
}

template class Overlaps<std::uint32_t>;
template class Overlaps<std::uint64_t>;

}  // namespace hexhex
