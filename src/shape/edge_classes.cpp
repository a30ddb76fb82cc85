#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include <adjacency/vertex_lists.hpp>
#include <shape/edge_classes.hpp>

#include <base/disjoint_sets.hpp>
#include <base/sorted.hpp>

namespace hexhex::shape {
namespace {

using Triangle = std::array<Index, 3>;  // by edges

/// Decides the classes of edges, one after the other.
class Spreading {
 public:
  Spreading(std::size_t edgeCount, const std::vector<Triangle>& triangles, Stage& stage)
      : triangles_(triangles),
        trianglesAt_(edgeCount, stage,
                     [&](const auto& enter) {
                       for (Index t = 0; t < triangles.size(); ++t) {
                         for (const Index edge : triangles[t]) enter(edge, t);
                       }
                     }),
        classes_(edgeCount),
        isKnown_(edgeCount),
        unknown_(triangles.size(), 3) {}

  void decide(Index edge, HomologyClass sum) {
    classes_[edge] = std::move(sum);
    isKnown_[edge] = true;
    fresh_.push_back(edge);
  }

  /// Decides what follows.
  void spread() {
    while (!fresh_.empty()) {
      const Index from = fresh_.back();
      fresh_.pop_back();
      for (const Index t : trianglesAt_(from)) {
        if (--unknown_[t] < 2) close(triangles_[t]);
      }
    }
  }

  [[nodiscard]] bool isKnown(Index edge) const { return isKnown_[edge]; }

  [[nodiscard]] std::vector<HomologyClass> take() && {
    for (HomologyClass& each : classes_) each = relations_.reduced(std::move(each));
    return std::move(classes_);
  }

 private:
  /// At most one edge is not known.
  void close(const Triangle& triangle) {
    HomologyClass sum;
    Index last = kNone;
    for (const Index edge : triangle) {
      if (isKnown_[edge]) {
        sum = sumOf(sum, classes_[edge]);
      } else {
        last = edge;
      }
    }
    if (last != kNone) {
      decide(last, std::move(sum));
    } else {
      relations_.add(sum);
    }
  }

  const std::vector<Triangle>& triangles_;
  adjacency::VertexLists<Index> trianglesAt_;  ///< per edge
  std::vector<HomologyClass> classes_;         ///< per edge
  std::vector<bool> isKnown_;                  ///< per edge
  std::vector<Index> unknown_;                 ///< per triangle: edges that have not been visited
  std::vector<Index> fresh_;                   ///< edges that are known, but not yet visited
  ClassBasis relations_;
};

}  // namespace

HomologyClass sumOf(const HomologyClass& a, const HomologyClass& b) {
  HomologyClass sum;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(sum));
  return sum;
}

HomologyClass ClassBasis::reduced(HomologyClass sum) const {
  for (std::size_t i = sum.size(); i-- > 0;) {
    const Index last = sum[i];
    const auto row = rows_.find(last);
    if (row == rows_.end()) continue;
    sum = sumOf(sum, row->second);  // changes no later generator
    i = static_cast<std::size_t>(std::lower_bound(sum.begin(), sum.end(), last) - sum.begin());
  }
  return sum;
}

bool ClassBasis::add(const HomologyClass& sum) {
  HomologyClass rest = reduced(sum);
  if (rest.empty()) return false;
  const Index last = rest.back();
  rows_.emplace(last, std::move(rest));
  return true;
}

EdgeClasses::EdgeClasses(const std::vector<Tet>& tets, std::size_t pointCount, Stage& stage) {
  edges_.reserve(6 * tets.size());
  for (const Tet& tet : tets) {
    tetmap::forEachEdgeOf(tet, [&](const tetmap::VertexPair& edge,
                                   lattice::CornerMask /*corners*/) { edges_.push_back(edge); });
  }
  sortUnique(edges_);
  std::vector<Triangle> triangles;
  triangles.reserve(4 * tets.size());
  for (const Tet& tet : tets) {
    for (std::size_t opposite = 0; opposite < 4; ++opposite) {
      const Index a = tet[(opposite + 1) % 4];
      const Index b = tet[(opposite + 2) % 4];
      const Index c = tet[(opposite + 3) % 4];
      triangles.push_back({numberOf(a, b), numberOf(b, c), numberOf(c, a)});
    }
  }
  Spreading spreading(edges_.size(), triangles, stage);
  DisjointSets forest(pointCount);
  for (Index edge = 0; edge < edges_.size(); ++edge) {
    const auto [a, b] = edges_[edge];
    if (forest.find(a) == forest.find(b)) continue;
    forest.unite(a, b);
    spreading.decide(edge, {});
  }
  spreading.spread();
  Index generators = 0;
  for (Index edge = 0; edge < edges_.size(); ++edge) {
    if (spreading.isKnown(edge)) continue;
    stage.context().throwIfCancelled();
    spreading.decide(edge, {generators++});
    spreading.spread();
  }
  classes_ = std::move(spreading).take();
}

Index EdgeClasses::numberOf(Index a, Index b) const {
  const auto at = std::lower_bound(edges_.begin(), edges_.end(), tetmap::pairOf(a, b));
  return static_cast<Index>(at - edges_.begin());
}

}  // namespace hexhex::shape
