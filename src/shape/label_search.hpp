// Better labels by random changes in small places.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <shape/label_check.hpp>
#include <shape/label_expansion.hpp>

#include <base/random.hpp>
#include <base/stage.hpp>

namespace hexhex::shape {

struct CheckedLabels {
  Labels labels;
  Verdict verdict;
  std::uint64_t moves = 0;  ///< that were tried
};

/// Where something is wrong, or at a border, the labels of a small disk are drawn or cut anew,
/// under random conditions; what is better stays, and sometimes what is not (simulated annealing,
/// Kirkpatrick et al. 1983). Evocube (Dumery et al. 2022) evolves whole labellings instead.
class LabelSearch {
 public:
  LabelSearch(const Surface& surface, const LabelCosts& costs, Random random);

  /// Until labels are valid and little is to be gained, or as long as it lasts.
  /// @param mostMoves  if labels do not become valid
  [[nodiscard]] CheckedLabels improve(const Labels& start, std::uint64_t mostMoves,
                                      Context& context);

 private:
  void move(Labels& labels, const Verdict& verdict);
  [[nodiscard]] Index drawPlace(const Labels& labels, const Verdict& verdict);
  [[nodiscard]] lattice::Direction drawLabel(Index triangle);
  [[nodiscard]] Compactness drawCompactness();
  /// Connected triangles around one whose centres are less far away.
  [[nodiscard]] std::vector<Index> disk(Index centre, double radius);
  void changeChart(Labels& labels, Index place);
  void cutWithout(Labels& labels, std::vector<Index> chart);
  void cutAgain(Labels& labels, Index place, double radius, double kind);

  /// Marks a triangle. @return whether it was not marked
  bool mark(Index triangle);
  void unmarkAll() { ++stamp_; }

  const Surface& surface_;
  LabelCheck check_;
  Expansion expansion_;
  Random random_;
  std::vector<std::uint32_t> stamps_;  ///< per triangle
  std::uint32_t stamp_ = 0;
};

}  // namespace hexhex::shape
