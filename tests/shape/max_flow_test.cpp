// Cuts of small networks, compared with all cuts that there are.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <shape/max_flow.hpp>

#include "support/effort.hpp"
#include "support/random.hpp"

namespace hexhex::test {
namespace {

struct Network {
  struct Edge {
    Index from;
    Index to;
    std::int64_t capacity;
  };
  std::vector<std::int64_t> terminals;
  std::vector<Edge> edges;

  /// @param atSource  bit i for node i
  [[nodiscard]] std::int64_t cost(unsigned atSource) const {
    const auto isAtSource = [&](Index node) { return (atSource >> node & 1U) != 0; };
    std::int64_t sum = 0;
    for (Index node = 0; node < terminals.size(); ++node) {
      const std::int64_t terminal = terminals[node];
      sum += isAtSource(node) ? std::max<std::int64_t>(0, -terminal)
                              : std::max<std::int64_t>(0, terminal);
    }
    for (const Edge& edge : edges) {
      if (isAtSource(edge.from) && !isAtSource(edge.to)) sum += edge.capacity;
    }
    return sum;
  }
};

TEST(MaxFlow, FindsTheLeastOfAllCuts) {
  Random random(7);
  shape::MaxFlow flow;
  for (int i = 0; i < cases(2000); ++i) {
    Network network;
    const std::size_t nodes = 1 + random.below(9);
    for (std::size_t n = 0; n < nodes; ++n) network.terminals.push_back(random.between(-9, 9));
    for (std::size_t e = random.below(4 * nodes); e > 0; --e) {
      network.edges.push_back({static_cast<Index>(random.below(nodes)),
                               static_cast<Index>(random.below(nodes)), random.between(0, 9)});
    }
    flow.reset(nodes);
    for (Index n = 0; n < nodes; ++n) {
      // In two pieces, since they add up.
      const std::int64_t piece = random.between(-5, 5);
      flow.addTerminal(n, piece);
      flow.addTerminal(n, network.terminals[n] - piece);
    }
    for (const Network::Edge& edge : network.edges) {
      if (edge.from != edge.to) flow.addEdge(edge.from, edge.to, edge.capacity);
    }
    flow.run();
    unsigned found = 0;
    for (Index n = 0; n < nodes; ++n) found |= flow.isAtSource(n) ? 1U << n : 0U;
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    unsigned inAll = (1U << nodes) - 1;  // that are at the source in each of the least cuts
    for (unsigned cut = 0; cut < 1U << nodes; ++cut) {
      const std::int64_t cost = network.cost(cut);
      if (cost < least) inAll = (1U << nodes) - 1;
      least = std::min(least, cost);
      if (cost == least) inAll &= cut;
    }
    EXPECT_EQ(network.cost(found), least);
    EXPECT_EQ(found, inAll);
  }
}

TEST(MaxFlow, GoesBackWhereItWasWrong) {
  // 0 feeds 3 only if 1 does not: the flow of 1 has to leave by 2.
  shape::MaxFlow flow;
  flow.reset(4);
  flow.addTerminal(0, 1);
  flow.addTerminal(3, -1);
  flow.addTerminal(2, -1);
  flow.addTerminal(1, 1);
  flow.addEdge(0, 3, 1);
  flow.addEdge(1, 3, 1);
  flow.addEdge(1, 2, 1);
  flow.run();
  for (Index n = 0; n < 4; ++n) EXPECT_FALSE(flow.isAtSource(n));
}

}  // namespace
}  // namespace hexhex::test
