// Jacobian matrices of Lagrange cells, and how much these are distorted.
#pragma once

#include <array>
#include <vector>

#include <hexhex/types.hpp>

#include <mesh/bezier.hpp>

namespace hexhex::curved {

/// The columns of the Jacobian matrices of cells of one order, at one grid of places.
struct LagrangeColumns {
  /// One per thread.
  struct Values {
    std::array<mesh::Bezier<Vec3>, 3> columns;
    std::vector<Vec3> scratch;
  };

  // Of the Lagrange polynomials: a row per place, a column per polynomial.
  mesh::Matrix<double> value;
  mesh::Matrix<double> derivative;

  /// @param places  in [0, 1], along each axis
  LagrangeColumns(int order, const std::vector<double>& places);

  /// @param nodes  of a cell, the first axis fastest
  void evaluate(const std::vector<Vec3>& nodes, Values& result) const;
};

/// From 0 to 1 in so many steps.
[[nodiscard]] std::vector<double> equidistant(int order);

/// Scaled Jacobians as scaledJacobians() defines them.
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
