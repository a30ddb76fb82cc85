// Better labels by graph cuts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <shape/label_costs.hpp>
#include <shape/max_flow.hpp>

#include <base/random.hpp>

namespace hexhex::shape {

/// Where labels may change.
struct Region {
  std::vector<Index> triangles;
  /// Per triangle: bit i where label i is as good as forbidden. Empty: nowhere.
  std::vector<std::uint8_t> forbidden;
};

/// Alpha expansion (Boykov, Veksler, Zabih 2001): as long as it helps, each label in turn takes all
/// triangles of a region that lower the costs together.
class Expansion {
 public:
  Expansion(const Surface& surface, const LabelCosts& costs);

  /// @param sweeps  over all labels, at most
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
  std::vector<Index> nodes_;      ///< per triangle: in the network, or kNone
  std::vector<Index> triangles_;  ///< per node
};

}  // namespace hexhex::shape
