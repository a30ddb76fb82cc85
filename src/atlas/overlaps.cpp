// Finds contested points, and moves their tets to further charts (docs/developer/atlas.md).
#include <atomic>
#include <cassert>

#include <atlas/overlaps.hpp>
#include <base/parallel.hpp>

namespace hexhex::atlas {

namespace {

/// Calls visit(entry of the grid, vertex) for all points that a tet claims.
/// @param brickAt  the brick that holds a point, or null: points without a brick are left out
template <class Id, class BrickAt, class Visit>
void forEachEntry(const TetClaims& tet, const BrickAt& brickAt, const Visit& visit) {
  for (const Claim& claim : tet.claims) {
    claim.row.forEachPart([&](const lattice::ChartPoint& c, std::uint32_t offset,
                              std::uint32_t count, std::ptrdiff_t stride) {
      Brick<Id>* const brick = brickAt(c);
      if (brick == nullptr) return;
      auto place = static_cast<std::ptrdiff_t>(placeInBrick(c));
      for (std::uint32_t i = 0; i < count; ++i, place += stride) {
        visit(brick->ids[static_cast<std::size_t>(place)],
              static_cast<Id>(claim.first + offset + i));
      }
    });
  }
}

}  // namespace

// Not in an unnamed namespace: closures in explicitly instantiated templates have linkage, and so
// must the types that they capture.
namespace detail {

/// Moves tets to other charts.
template <class Id>
class TetMover {
 public:
  TetMover(const igm::PreparedMap& map, Charts& charts, BrickGrid<Id>& grid)
      : map_(map), charts_(charts), grid_(grid) {}

  /// Takes tets out of their charts, then puts them into charts again, one sheet after the other:
  /// the first sheet may stay, so that only the borders of the others are cut anew.
  void run(const std::vector<const TetClaims*>& contested) {
    contested_ = contested;
    pending_.assign(map_.topology.tetCount(), kNone);
    std::vector<Index> before;
    for (std::size_t i = 0; i < contested_.size(); ++i) {
      const Index tet = contested_[i]->tet;
      assert(pending_[tet] == kNone && charts_.chart[tet] != Charts::kNoChart);
      pending_[tet] = static_cast<Index>(i);
      before.push_back(charts_.chart[tet]);
      charts_.chart[tet] = Charts::kNoChart;
    }
    for (std::size_t i = 0; i < contested_.size(); ++i) {
      if (pending_[contested_[i]->tet] != kNone) fill(before[i], i);
    }
    for (std::size_t i = 0; i < contested_.size(); ++i) {
      if (pending_[contested_[i]->tet] == kNone) continue;
      // Only a tet that overlaps itself does not fit into an empty chart.
      fill(charts_.count++, i);
      pending_[contested_[i]->tet] = kNone;
    }
  }

 private:
  /// Puts pending tets into a chart, breadth first, as long as they fit.
  void fill(Index chart, std::size_t start) {
    if (!tryClaim(*contested_[start], chart)) return;
    std::vector<Index> queue(1, contested_[start]->tet);
    for (std::size_t head = 0; head < queue.size(); ++head) {
      for (int face = 0; face < 4; ++face) {
        const adjacency::HalfFace halfFace = adjacency::halfFaceOf(queue[head], face);
        const adjacency::HalfFace mate = map_.topology.mate[halfFace];
        if (mate == kNone || pending_[adjacency::tetOf(mate)] == kNone) continue;
        if (!charts_.gaugesAgree(map_.topology, map_.exact.transitions, halfFace)) continue;
        if (tryClaim(*contested_[pending_[adjacency::tetOf(mate)]], chart))
          queue.push_back(adjacency::tetOf(mate));
      }
    }
  }

  /// Claims all points of a tet in a chart if none of them belongs to another vertex, be it another
  /// one of the tet's own.
  bool tryClaim(const TetClaims& tet, Index chart) {
    assert(charts_.chart[tet.tet] == Charts::kNoChart);
    const auto brickAt = [&](const lattice::ChartPoint& c) {
      return grid_.find(brickKey(chart, c));
    };
    bool isFree = true;
    forEachEntry<Id>(
        tet, [&](const lattice::ChartPoint& c) { return isFree ? brickAt(c) : nullptr; },
        [&](Id entry, Id vertex) {
          isFree = isFree && (!Brick<Id>::isVertex(entry) || entry == vertex);
        });
    if (!isFree) return false;
    forEachEntry<Id>(
        tet, [&](const lattice::ChartPoint& c) { return &grid_.add(brickKey(chart, c)); },
        [](Id& entry, Id vertex) { entry = vertex; });
    forEachEntry<Id>(tet, brickAt,
                     [&](Id entry, Id vertex) { isFree = isFree && entry == vertex; });
    if (!isFree) {
      forEachEntry<Id>(tet, brickAt,
                       [](Id& entry, Id /*vertex*/) { entry = Brick<Id>::kContested; });
      return false;
    }
    charts_.chart[tet.tet] = chart;
    pending_[tet.tet] = kNone;
    return true;
  }

  const igm::PreparedMap& map_;
  Charts& charts_;
  BrickGrid<Id>& grid_;
  std::vector<const TetClaims*> contested_;
  Array<Index> pending_;  ///< per tet: its index in `contested_`, or kNone if it has a chart
};

}  // namespace detail

template <class Id>
std::uint64_t resolveOverlaps(const igm::PreparedMap& map, const std::vector<TetClaims>& claims,
                              Charts& charts, BrickGrid<Id>& grid, Stage& stage) {
  constexpr std::size_t kClaimingTets = 64;  // each of which may take long
  const auto forEachOf = [&](BrickCache<Id>& cache, const TetClaims& tet, const auto& visit) {
    const Index chart = charts.chart[tet.tet];
    forEachEntry<Id>(
        tet, [&](const lattice::ChartPoint& c) { return cache.find(chart, c); }, visit);
  };
  // Entries only ever change to "contested", so it does not matter who looks first.
  parallelBlocks(stage, claims.size(), kClaimingTets,
                 [&](std::size_t begin, std::size_t end, std::size_t /*block*/) {
                   BrickCache<Id> cache(grid);
                   for (std::size_t i = begin; i < end; ++i) {
                     forEachOf(cache, claims[i], [](Id& shared, Id vertex) {
                       const std::atomic_ref entry(shared);
                       const Id claimed = entry.load(std::memory_order_relaxed);
                       // Beyond the boxes of a region, claims may be missing.
                       if (claimed == vertex || claimed == Brick<Id>::kEmpty) return;
                       entry.store(Brick<Id>::kContested, std::memory_order_relaxed);
                     });
                   }
                 });
  const auto contested = collectFromBlocks<const TetClaims*>(
      stage, claims.size(), kClaimingTets,
      [&](std::size_t begin, std::size_t end, std::vector<const TetClaims*>& list) {
        BrickCache<Id> cache(grid);
        for (std::size_t i = begin; i < end; ++i) {
          bool isContested = false;
          forEachOf(cache, claims[i], [&](Id entry, Id /*vertex*/) {
            isContested = isContested || entry == Brick<Id>::kContested;
          });
          if (isContested) list.push_back(&claims[i]);
        }
      });
  detail::TetMover<Id>(map, charts, grid).run(contested);
  return contested.size();
}

template std::uint64_t resolveOverlaps(const igm::PreparedMap&, const std::vector<TetClaims>&,
                                       Charts&, BrickGrid<std::uint32_t>&, Stage&);
template std::uint64_t resolveOverlaps(const igm::PreparedMap&, const std::vector<TetClaims>&,
                                       Charts&, BrickGrid<std::uint64_t>&, Stage&);

}  // namespace hexhex::atlas
