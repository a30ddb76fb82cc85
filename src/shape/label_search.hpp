// Optimizes labels by random local changes: simulated annealing (Kirkpatrick et al. 1983). Evocube
// (Dumery et al. 2022) evolves whole labellings instead.
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
  std::uint64_t moves = 0;  ///< number of attempted moves
};

/// At faults and borders, labels of a small disk are drawn or cut anew under random conditions;
/// improvements are kept, and sometimes changes for the worse.
class LabelSearch {
 public:
  LabelSearch(const Surface& surface, const LabelCosts& costs, Random random);

  /// Ends after a number of moves, which is smaller once labels are valid.
  /// @param mostMoves  limit while labels are invalid
  [[nodiscard]] CheckedLabels improve(const Labels& start, std::uint64_t mostMoves,
                                      Context& context);

 private:
  void move(Labels& labels, const Verdict& verdict);
  [[nodiscard]] Index drawPlace(const Labels& labels, const Verdict& verdict);
  [[nodiscard]] lattice::Direction drawLabel(Index triangle);
  [[nodiscard]] Compactness drawCompactness();
  /// The connected triangles around one with centroids closer than the radius.
  [[nodiscard]] std::vector<Index> disk(Index centre, double radius);
  void changeChart(Labels& labels, Index place);
  void cutWithout(Labels& labels, std::vector<Index> chart);
  void cutAgain(Labels& labels, Index place, double radius, double kind);

  /// @return whether the triangle was not marked before
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
