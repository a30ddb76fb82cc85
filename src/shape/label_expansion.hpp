// Optimizes labels by graph cuts: alpha expansion (Boykov, Veksler, Zabih 2001, "Fast Approximate
// Energy Minimization via Graph Cuts").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <shape/label_costs.hpp>
#include <shape/max_flow.hpp>

#include <base/random.hpp>

namespace hexhex::shape {

/// The triangles whose labels may change.
struct Region {
  std::vector<Index> triangles;
  /// Per triangle: bit i is set if label i is (practically) forbidden. Empty if no labels are.
  std::vector<std::uint8_t> forbidden;
};

/// For each label in turn, the triangles that take it are those that minimize the total cost, until
/// nothing changes.
class Expansion {
 public:
  Expansion(const Surface& surface, const LabelCosts& costs);

  /// @param sweeps  maximum number of passes over all labels
  /// @param random  for the order of labels
  void run(Labels& labels, const Region& region, const Compactness& compactness, int sweeps,
           Random& random);

 private:
  /// @return whether any triangle took the label
  bool expand(Labels& labels, const Region& region, const Compactness& compactness,
              lattice::Direction label);
  void addSides(const Labels& labels, Index triangle, const Compactness& compactness,
                lattice::Direction label);

  const Surface& surface_;
  const LabelCosts& costs_;
  MaxFlow flow_;
  std::vector<Index> nodes_;      ///< per triangle: its node in the network, or kNone
  std::vector<Index> triangles_;  ///< per node
};

}  // namespace hexhex::shape
