#include <algorithm>

#include <improve/merit.hpp>

namespace hexhex::improvement {

double meritOf(const ImproveReport& report) {
  constexpr double kGood = 0.3;        // no credit for a higher minimum
  constexpr double kNear = 5e-3;       // distance in diagonals that halves the merit
  constexpr double kUnfollowed = 0.5;  // factor for a mesh that follows no curve
  constexpr double kGrown = 2;         // layers may multiply cells by this without penalty
  if (!report.after.allPositive()) return -1;
  const double quality = std::min(1.0, report.after.quality.minimum / kGood);
  // Never 0: of two distant meshes, the nearer one wins.
  const double distance = report.distanceAfter.hausdorff() / kNear;
  const double nearness = 1 / (1 + distance * distance);
  const auto cells = static_cast<double>(report.after.positive);
  const double size = std::min(1.0, kGrown * (1 - static_cast<double>(report.addedCells) / cells));
  return quality * nearness * size * (kUnfollowed + (1 - kUnfollowed) * report.curvesFollowed);
}

}  // namespace hexhex::improvement
