#include <algorithm>
#include <cstddef>

#include <curved/arc_order.hpp>

#include <base/parallel.hpp>
#include <base/shared_counts.hpp>

namespace hexhex {

namespace {

class ArcOrderer {
 public:
  ArcOrderer(const PreparedMap& map, std::span<const BlockArcs> blocks,
             std::span<const Index> counts)
      : map_(map), blocks_(blocks), begin_(counts.size() + 1) {
    std::copy(counts.begin(), counts.end(), begin_.begin());
    begin_.back() = 0;
    order_.places.resize(exclusiveScan(std::span(begin_)));
    order_.pointBegin.resize(order_.places.size() + 1);
  }

  ArcOrder run(Stage& stage) {
    collectByTet(stage);
    constexpr std::size_t kTets = 256;
    parallelBlocks(stage, map_.topology.tetCount(), kTets,
                   [&](std::size_t first, std::size_t end, std::size_t) {
                     ArcSorter sorter;
                     for (std::size_t t = first; t < end; ++t) {
                       sortTet(static_cast<Index>(t), sorter);
                     }
                   });
    order_.pointBegin.back() = 0;
    exclusiveScan(std::span(order_.pointBegin));
    return std::move(order_);
  }

 private:
  /// In any order, those of each tet.
  void collectByTet(Stage& stage) {
    Array<Index> filled(map_.topology.tetCount());
    std::fill(filled.begin(), filled.end(), 0);
    const SharedCounts counts(filled);
    parallelFor(stage, blocks_.size(), 1, [&](std::size_t block) {
      Index number = 0;
      for (const EdgeKey& key : blocks_[block].keys) {
        order_.places[begin_[key.tet] + counts.increase(key.tet)] = {static_cast<Index>(block),
                                                                     number++};
      }
    });
  }
  void sortTet(Index tet, ArcSorter& sorter) {
    const std::uint64_t first = begin_[tet];
    const auto own = std::span(order_.places).subspan(first, begin_[tet + 1] - first);
    if (own.size() > 1) {
      sorter.enter(map_.exact.corners[tet], map_.exact.unit);
      sorter.sort(own, [&](const ArcPlace& place) -> const EdgeKey& {
        return blocks_[place.block].keys[place.number];
      });
    }
    for (std::size_t i = 0; i < own.size(); ++i) {
      order_.pointBegin[first + i] = blocks_[own[i].block].pieces.pointsOf(own[i].number);
    }
  }

  const PreparedMap& map_;
  std::span<const BlockArcs> blocks_;
  Array<std::uint64_t> begin_;  ///< per tet (+1): its first arc
  ArcOrder order_;
};

}  // namespace

ArcOrder orderArcs(const PreparedMap& map, std::span<const BlockArcs> blocks,
                   std::span<const Index> counts, Stage& stage) {
  return ArcOrderer(map, blocks, counts).run(stage);
}

}  // namespace hexhex
