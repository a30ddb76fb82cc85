// Sanitization of vertices that are decided by their stars.
#pragma once

#include <span>
#include <vector>

#include <igm/exact_map.hpp>
#include <igm/vertex_star.hpp>

namespace hexhex {

/// Makes the corners of one irregular vertex after the other what its star demands, in map.corners.
class VertexSanitizer {
 public:
  /// @param defects  gets vertices that move by more than the tolerance, and those whose stars do
  /// not reproduce the value
  VertexSanitizer(const LocalParameters& parameters, const Singularities& singularities,
                  double tolerance, DefectCollector& defects, ExactMap& map)
      : parameters_(parameters),
        singularities_(singularities),
        tolerance_(tolerance),
        defects_(defects),
        map_(map),
        resolution_(1 / static_cast<double>(map.unit)) {}

  /// @param star  with rotations
  /// @param planes  of the boundary faces, in the chart of the star's first member: bit k across
  /// axis k
  void run(Index v, std::span<const VertexStar::Member> star, unsigned planes);

  [[nodiscard]] double maxDisplacement() const noexcept { return maxDisplacement_; }

 private:
  [[nodiscard]] AxisSet fixedAxes(Index v, std::span<const VertexStar::Member> star,
                                  AxisSet planes) const;
  [[nodiscard]] LatticePoint snapped(CornerIndex corner, AxisSet fixed) const;
  [[nodiscard]] bool spread(std::span<const VertexStar::Member> star);
  [[nodiscard]] LatticePoint carried(const LatticePoint& value, Index transition) const;
  [[nodiscard]] double assign(CornerIndex corner, const LatticePoint& value);
  [[nodiscard]] ErrorCode causeOfDisplacement(Index v, AxisSet planes) const;

  const LocalParameters& parameters_;
  const Singularities& singularities_;
  double tolerance_;
  DefectCollector& defects_;
  ExactMap& map_;
  double resolution_;
  double maxDisplacement_ = 0;
  std::vector<LatticePoint> values_;  ///< per member of a star
};

}  // namespace hexhex
