// Glues tets into charts (docs/developer/atlas.md).
#include <array>
#include <utility>
#include <vector>

#include <atlas/charts.hpp>
#include <base/disjoint_sets.hpp>
#include <base/low_level.hpp>
#include <lattice/charts_along_trees.hpp>

namespace hexhex::atlas {

namespace {

constexpr std::size_t kChartsGrain = 4096;

/// Joins tets across identity transitions, and numbers the resulting patches.
class Patches {
 public:
  Patches(const igm::PreparedMap& map, Stage& stage) : of_(map.topology.tetCount()) {
    const std::size_t tets = map.topology.tetCount();
    const Array<adjacency::HalfFace>& mate = map.topology.mate;
    DisjointSets sets(tets);
    parallelFor(stage, tets, kChartsGrain, [&](std::size_t t) {
      // Only smaller neighbours, as each face must be seen once; listed without branches, which
      // could not be predicted: with them, an extraction of s17c_sphere_r0.1 takes 4 % longer.
      std::array<Index, 4> smaller{};
      std::size_t count = 0;
      const auto first = static_cast<adjacency::HalfFace>(4 * t);
      for (adjacency::HalfFace h = first; h < first + 4; ++h) {
        smaller[count] = adjacency::tetOf(mate[h]);
        count += allOf(mate[h] < first, !map.exact.transitions.isNonTrivial(h)) ? 1 : 0;
      }
      auto patch = static_cast<Index>(t);
      for (std::size_t i = 0; i < count; ++i) patch = sets.unite(patch, smaller[i]);
    });
    const auto representatives =
        collectFromBlocks<Index>(stage, tets, kChartsGrain,
                                 [&](std::size_t begin, std::size_t end, std::vector<Index>& list) {
                                   for (std::size_t t = begin; t < end; ++t) {
                                     of_[t] = sets.find(static_cast<Index>(t));
                                     if (of_[t] == t) list.push_back(static_cast<Index>(t));
                                   }
                                 });
    Array<Index> number(tets);  // of representatives; most of it is never touched
    for (const Index t : representatives) number[t] = count_++;
    parallelFor(stage, tets, kChartsGrain, [&](std::size_t t) { of_[t] = number[of_[t]]; });
  }
  [[nodiscard]] Index of(Index tet) const noexcept { return of_[tet]; }
  [[nodiscard]] Index count() const noexcept { return count_; }
  [[nodiscard]] Array<Index> release() && noexcept { return std::move(of_); }

 private:
  Array<Index> of_;
  Index count_ = 0;
};

/// The half-faces through which patches border on others, by patch.
struct Borders {
  std::vector<adjacency::HalfFace> halfFaces;
  std::vector<std::size_t> begin;  ///< per patch (+1)
};

Borders findBorders(const igm::PreparedMap& map, const Patches& patches) {
  const Array<adjacency::HalfFace>& mate = map.topology.mate;
  const auto isBorder = [&](adjacency::HalfFace halfFace) {
    return halfFace != kNone &&
           patches.of(adjacency::tetOf(halfFace)) != patches.of(adjacency::tetOf(mate[halfFace]));
  };
  Borders borders;
  borders.begin.assign(std::size_t{patches.count()} + 1, 0);
  for (const adjacency::HalfFace halfFace : map.exact.transitions.halfFaces) {
    if (isBorder(halfFace)) ++borders.begin[patches.of(adjacency::tetOf(halfFace))];
  }
  borders.halfFaces.resize(exclusiveScan(std::span(borders.begin)));
  std::vector<std::size_t> next(borders.begin.begin(), borders.begin.end() - 1);
  for (const adjacency::HalfFace halfFace : map.exact.transitions.halfFaces) {
    if (isBorder(halfFace))
      borders.halfFaces[next[patches.of(adjacency::tetOf(halfFace))]++] = halfFace;
  }
  return borders;
}

}  // namespace

Charts buildCharts(const igm::PreparedMap& map, Stage& stage) {
  Patches patches(map, stage);
  const Borders borders = findBorders(map, patches);
  const auto forEachNeighbour = [&](Index patch, const auto& visit) {
    for (std::size_t i = borders.begin[patch]; i < borders.begin[patch + 1]; ++i) {
      const adjacency::HalfFace mate = map.topology.mate[borders.halfFaces[i]];
      visit(patches.of(adjacency::tetOf(mate)), [&](const lattice::Gauge& gauge) {
        return gauge * map.exact.transitions.across(mate);
      });
    }
  };
  auto trees = lattice::chartsAlongTrees<lattice::Gauge>(patches.count(), forEachNeighbour);
  Charts charts;
  charts.gauges = std::move(trees.motions);
  charts.count = trees.trees;
  charts.gaugeOf = std::move(patches).release();
  charts.chart.resize(charts.gaugeOf.size());
  parallelFor(stage, charts.chart.size(), kChartsGrain,
              [&](std::size_t t) { charts.chart[t] = trees.tree[charts.gaugeOf[t]]; });
  return charts;
}

}  // namespace hexhex::atlas
