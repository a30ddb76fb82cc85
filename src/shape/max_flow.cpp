#include <algorithm>

#include <shape/max_flow.hpp>

namespace hexhex::shape {

void MaxFlow::reset(std::size_t nodes) {
  supply_.assign(nodes, 0);
  edges_.clear();
}

void MaxFlow::buildArcs() {
  firstArc_.assign(supply_.size() + 1, 0);
  for (const Edge& edge : edges_) {
    ++firstArc_[edge.from];
    ++firstArc_[edge.to];
  }
  Index sum = 0;
  for (Index& first : firstArc_) sum += std::exchange(first, sum);
  current_.assign(firstArc_.begin(), firstArc_.end() - 1);
  arcs_.resize(2 * edges_.size());
  for (const Edge& edge : edges_) {
    const Index there = current_[edge.from]++;
    const Index back = current_[edge.to]++;
    arcs_[there] = {edge.to, back, edge.capacity};
    arcs_[back] = {edge.from, there, 0};
  }
}

bool MaxFlow::findLevels() {
  levels_.assign(supply_.size(), -1);
  queue_.clear();
  for (Index node = 0; node < supply_.size(); ++node) {
    if (supply_[node] <= 0) continue;
    levels_[node] = 0;
    queue_.push_back(node);
  }
  bool reaches = false;
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    const Index node = queue_[i];
    reaches = reaches || supply_[node] < 0;
    for (Index a = firstArc_[node]; a < firstArc_[node + 1]; ++a) {
      const Arc& arc = arcs_[a];
      if (arc.capacity == 0 || levels_[arc.to] >= 0) continue;
      levels_[arc.to] = levels_[node] + 1;
      queue_.push_back(arc.to);
    }
  }
  return reaches;
}

bool MaxFlow::advance(Index end) {
  for (Index& a = current_[end]; a < firstArc_[end + 1]; ++a) {
    const Arc& arc = arcs_[a];
    if (arc.capacity == 0 || levels_[arc.to] != levels_[end] + 1) continue;
    path_.push_back(a);
    return true;
  }
  return false;
}

/// Pushes as much as the path, the supply and the demand allow, and truncates the path before the
/// first saturated arc.
void MaxFlow::push(Index source, Index end) {
  std::int64_t amount = std::min(supply_[source], -supply_[end]);
  for (const Index a : path_) amount = std::min(amount, arcs_[a].capacity);
  supply_[source] -= amount;
  supply_[end] += amount;
  std::size_t left = path_.size();
  for (std::size_t i = path_.size(); i > 0; --i) {
    Arc& arc = arcs_[path_[i - 1]];
    arc.capacity -= amount;
    arcs_[arc.reverse].capacity += amount;
    if (arc.capacity == 0) left = i - 1;
  }
  path_.resize(left);
}

void MaxFlow::augmentFrom(Index source) {
  path_.clear();
  while (supply_[source] > 0) {
    const Index end = path_.empty() ? source : arcs_[path_.back()].to;
    if (supply_[end] < 0) {
      push(source, end);
    } else if (!advance(end)) {
      if (path_.empty()) return;
      ++current_[arcs_[arcs_[path_.back()].reverse].to];  // a dead end
      path_.pop_back();
    }
  }
}

void MaxFlow::run() {
  buildArcs();
  std::vector<Index> sources;
  while (findLevels()) {
    current_.assign(firstArc_.begin(), firstArc_.end() - 1);
    sources.clear();
    for (const Index node : queue_) {
      if (levels_[node] > 0) break;
      sources.push_back(node);
    }
    for (const Index source : sources) augmentFrom(source);
  }
}

}  // namespace hexhex::shape
