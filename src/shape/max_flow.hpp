// Maximum flow through a network, and the minimum cut (Dinic 1970): integers, so that it is exact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex::shape {

/// A network whose source and sink are beside each node rather than nodes themselves.
class MaxFlow {
 public:
  /// Begins a network anew; memory is kept.
  void reset(std::size_t nodes);

  /// What separates a node from the source, if positive; if negative, from the sink. Adds up.
  void addTerminal(Index node, std::int64_t fromSource) { supply_[node] += fromSource; }
  void addEdge(Index from, Index to, std::int64_t capacity) {
    edges_.push_back({from, to, capacity});
  }

  /// Call once.
  void run();
  /// Whether a node is on the source's side of the smallest cut, that with the fewest such nodes.
  [[nodiscard]] bool isAtSource(Index node) const { return levels_[node] >= 0; }

 private:
  struct Edge {
    Index from;
    Index to;
    std::int64_t capacity;
  };
  struct Arc {
    Index to;
    Index reverse;  ///< the arc back
    std::int64_t capacity;
  };

  void buildArcs();
  /// Distances from nodes with supply. @return whether a node with demand is reached
  bool findLevels();
  void augmentFrom(Index source);
  /// @return whether there is an arc on the way from the end of the path
  bool advance(Index end);
  void push(Index source, Index end);

  std::vector<std::int64_t> supply_;  ///< what is left: positive supply, negative demand
  std::vector<Edge> edges_;
  std::vector<Index> firstArc_;  ///< per node, and one more
  std::vector<Arc> arcs_;
  std::vector<Index> current_;  ///< per node: the arc to try next
  std::vector<std::int32_t> levels_;
  std::vector<Index> queue_;
  std::vector<Index> path_;  ///< of arcs
};

}  // namespace hexhex::shape
