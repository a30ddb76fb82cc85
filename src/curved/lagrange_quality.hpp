// The distortion of Lagrange cells.
#pragma once

#include <array>

#include <curved/lagrange_columns.hpp>

namespace hexhex::curved {

/// Scaled Jacobians as defined by scaledJacobians().
class LagrangeQuality {
 public:
  explicit LagrangeQuality(int order);

  [[nodiscard]] std::array<double, kCellLanes> smallest(const LagrangeCells& cells,
                                                        LagrangeScratch& scratch) const;

 private:
  LagrangeColumns atNodes_;
  LagrangeColumns atGauss_;
};

}  // namespace hexhex::curved
