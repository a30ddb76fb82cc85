// Exact maximum flow and minimum cut with integer capacities (Dinic 1970).
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex::shape {

/// A network in which each node has an implicit arc from the source or to the sink.
class MaxFlow {
 public:
  /// Starts a new network; keeps memory.
  void reset(std::size_t nodes);

  /// Adds the capacity of the arc from the source if positive, or to the sink if negative.
  void addTerminal(Index node, std::int64_t fromSource) { supply_[node] += fromSource; }
  void addEdge(Index from, Index to, std::int64_t capacity) {
    edges_.push_back({from, to, capacity});
  }

  /// Computes the flow. Call once per network.
  void run();
  /// Whether a node is on the source's side of the minimum cut; of several minimum cuts, that with
  /// the fewest such nodes.
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
  /// Computes distances from nodes with supply.
  /// @return whether a node with demand is reached
  bool findLevels();
  void augmentFrom(Index source);
  /// @return whether an arc could be appended to the path, which ends at a node
  bool advance(Index end);
  void push(Index source, Index end);

  std::vector<std::int64_t> supply_;  ///< remaining supply if positive, demand if negative
  std::vector<Edge> edges_;
  std::vector<Index> firstArc_;  ///< per node, and one more
  std::vector<Arc> arcs_;
  std::vector<Index> current_;  ///< per node: the arc to try next
  std::vector<std::int32_t> levels_;
  std::vector<Index> queue_;
  std::vector<Index> path_;  ///< arcs
};

}  // namespace hexhex::shape
