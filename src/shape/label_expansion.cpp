#include <algorithm>
#include <array>
#include <utility>

#include <shape/label_expansion.hpp>

namespace hexhex::shape {

namespace {

/// Per triangle; not outweighed by any compactness.
constexpr auto kForbidden = static_cast<std::int64_t>(50 * kCostUnit);

std::int64_t penalty(const Region& region, std::size_t i, lattice::Direction label) {
  if (region.forbidden.empty()) return 0;
  return (region.forbidden[i] >> label & 1) != 0 ? kForbidden : 0;
}

}  // namespace

Expansion::Expansion(const Surface& surface, const LabelCosts& costs)
    : surface_(surface), costs_(costs), nodes_(surface.triangleCount(), kNone) {}

void Expansion::run(Labels& labels, const Region& region, const Compactness& compactness,
                    int sweeps, Random& random) {
  std::array<lattice::Direction, lattice::kDirections> order = {0, 1, 2, 3, 4, 5};
  int idle = 0;  // number of labels in a row that changed nothing
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    for (const lattice::Direction label : order) {
      idle = expand(labels, region, compactness, label) ? 0 : idle + 1;
      if (idle == lattice::kDirections) return;
    }
  }
}

bool Expansion::expand(Labels& labels, const Region& region, const Compactness& compactness,
                       lattice::Direction label) {
  triangles_.clear();
  for (const Index t : region.triangles) {
    if (labels[t] == label) continue;
    nodes_[t] = static_cast<Index>(triangles_.size());
    triangles_.push_back(t);
  }
  flow_.reset(triangles_.size());
  for (std::size_t i = 0; i < region.triangles.size(); ++i) {
    const Index t = region.triangles[i];
    if (labels[t] == label) continue;
    // Nodes on the source's side take the label.
    flow_.addTerminal(nodes_[t], costs_.ofTriangle(t, labels[t]) + penalty(region, i, labels[t]) -
                                     costs_.ofTriangle(t, label) - penalty(region, i, label));
    addSides(labels, t, compactness, label);
  }
  flow_.run();
  bool anyChange = false;
  for (const Index t : triangles_) {
    if (flow_.isAtSource(nodes_[t])) {
      labels[t] = label;
      anyChange = true;
    }
    nodes_[t] = kNone;
  }
  return anyChange;
}

void Expansion::addSides(const Labels& labels, Index triangle, const Compactness& compactness,
                         lattice::Direction label) {
  const Index node = nodes_[triangle];
  for (Side side = 3 * triangle; side < 3 * triangle + 3; ++side) {
    const Index beyond = surface_.beyond(side);
    const auto cost = [&](lattice::Direction a, lattice::Direction b) {
      return costs_.ofSide(side, a, b, compactness);
    };
    if (nodes_[beyond] == kNone) {
      flow_.addTerminal(node, cost(labels[triangle], labels[beyond]) - cost(label, labels[beyond]));
    } else if (triangle < beyond) {
      // With x and y for whether the triangle here and the one beyond take the label, the cost is
      // E(keep, keep) + (E(take, keep) - E(keep, keep)) x - E(take, keep) y + rest (1 - x) y.
      const std::int64_t onlyHere = cost(label, labels[beyond]);
      const std::int64_t onlyBeyond = cost(labels[triangle], label);
      // Straightness may violate the triangle inequality; truncating this cost keeps the energy
      // submodular.
      const std::int64_t none =
          std::min(cost(labels[triangle], labels[beyond]), onlyHere + onlyBeyond);
      flow_.addTerminal(node, none - onlyHere);
      flow_.addTerminal(nodes_[beyond], onlyHere);
      const std::int64_t rest = onlyHere + onlyBeyond - none;
      if (rest > 0) flow_.addEdge(nodes_[beyond], node, rest);
    }
  }
}

}  // namespace hexhex::shape
