// Common charts for pieces that each have a chart of their own, such as tets or blocks: those of
// the roots of breadth-first trees, found by composing the motions between neighbours.
#pragma once

#include <vector>

#include <hexhex/types.hpp>

namespace hexhex::lattice {

template <class Motion>
struct TreeCharts {
  std::vector<Motion> motions;  ///< per piece: from its chart into that of its tree
  std::vector<Index> tree;      ///< per piece; trees are in the order of their roots
  std::vector<Index> order;     ///< in the order of the search
  Index trees = 0;
};

/// Each piece that no earlier tree has reached becomes the root of a new one.
/// @param begin            begin(root): from its chart into that of its tree
/// @param forEachNeighbour forEachNeighbour(piece, visit) calls visit(neighbour, toTree), in any
///                         order, for each neighbour that is to share the chart: toTree(motion of
///                         the piece) is the neighbour's motion, called only if the neighbour is
///                         new
template <class Motion, class Begin, class ForEachNeighbour>
[[nodiscard]] TreeCharts<Motion> chartsAlongTrees(std::size_t pieces, const Begin& begin,
                                                  const ForEachNeighbour& forEachNeighbour) {
  TreeCharts<Motion> charts{std::vector<Motion>(pieces), std::vector<Index>(pieces, kNone), {}, 0};
  charts.order.reserve(pieces);
  for (Index root = 0; root < pieces; ++root) {
    if (charts.tree[root] != kNone) continue;
    charts.tree[root] = charts.trees;
    charts.motions[root] = begin(root);
    std::size_t next = charts.order.size();
    charts.order.push_back(root);
    for (; next < charts.order.size(); ++next) {
      const Index here = charts.order[next];
      forEachNeighbour(here, [&](Index there, const auto& toTree) {
        if (charts.tree[there] != kNone) return;
        charts.tree[there] = charts.trees;
        charts.motions[there] = toTree(charts.motions[here]);
        charts.order.push_back(there);
      });
    }
    ++charts.trees;
  }
  return charts;
}

/// The same in the roots' own charts.
template <class Motion, class ForEachNeighbour>
[[nodiscard]] TreeCharts<Motion> chartsAlongTrees(std::size_t pieces,
                                                  const ForEachNeighbour& forEachNeighbour) {
  return chartsAlongTrees<Motion>(
      pieces, [](Index /*root*/) { return Motion{}; }, forEachNeighbour);
}

}  // namespace hexhex::lattice
