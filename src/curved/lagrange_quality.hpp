// Jacobian matrices of Lagrange cells, and the distortion of these cells.
#pragma once

#include <array>
#include <vector>

#include <hexhex/types.hpp>

#include <mesh/bezier.hpp>

namespace hexhex::curved {

/// The columns of the Jacobian matrices of cells of one order, evaluated on one grid of points.
struct LagrangeColumns {
  /// One per thread.
  struct Values {
    std::array<mesh::Bezier<Vec3>, 3> columns;
    std::vector<Vec3> scratch;
  };

  // Of the Lagrange polynomials: a row per point, a column per polynomial.
  mesh::Matrix<double> value;
  mesh::Matrix<double> derivative;

  /// @param places  in [0, 1], the same along each axis
  LagrangeColumns(int order, const std::vector<double>& places);

  /// @param nodes  of a cell, the first axis fastest
  void evaluate(const std::vector<Vec3>& nodes, Values& result) const;
};

/// The points from 0 to 1 in `order` equal steps.
[[nodiscard]] std::vector<double> equidistant(int order);

/// Scaled Jacobians as defined by scaledJacobians().
class LagrangeQuality {
 public:
  explicit LagrangeQuality(int order);

  [[nodiscard]] double smallest(const std::vector<Vec3>& nodes,
                                LagrangeColumns::Values& values) const;

 private:
  LagrangeColumns atNodes_;
  LagrangeColumns atGauss_;
};

}  // namespace hexhex::curved
