// Foldover-free optimization of a patch.
//
// V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov, "Foldover-free maps in
// 50 lines of code", ACM Transactions on Graphics 40 (2021).
#pragma once

#include <array>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// Corners are affine functions of the unknowns: coordinate k of one is
/// constant[k] + sign[k] * x[unknown[k]], or constant[k] alone where unknown[k] is negative.
struct UntangleCorner {
  Vec3 constant{};
  std::array<int, 3> unknown = {-1, -1, -1};
  std::array<double, 3> sign{};
};

struct UntangleTet {
  std::array<UntangleCorner, 4> corners;
  /// The ideal shape: row i of the inverse of its edge matrix, whose columns are the edges from
  /// corner 0; scaled such that the tet's Jacobian matrix is about a rotation.
  std::array<Vec3, 3> inverseShape{};
  double weight = 1;
};

struct UntangleProblem {
  std::vector<UntangleTet> tets;
  std::vector<double> x;  ///< the unknowns: where they are, and where they are to go
};

/// Moves the unknowns until the Jacobian determinants of all tets are positive. The penalty of bad
/// tets grows until none is left.
/// @param[in,out] problem  unknowns; changed for the better even if not all tets become positive
/// @return the smallest Jacobian determinant in the end
[[nodiscard]] double untangle(UntangleProblem& problem, Stage& stage);

/// Whether this build has the solver.
[[nodiscard]] bool canUntangle() noexcept;

}  // namespace hexhex
