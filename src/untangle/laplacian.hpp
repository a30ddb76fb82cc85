// The weighted Laplacian of all elements: the Hessian matrix of the sum of weight / 2 |J -
// target|^2.
#pragma once

#include <Eigen/SparseCore>
#include <untangle/energy.hpp>

namespace hexhex::untangle {

/// Both triangles. What the elements leave free (all may move together, say) is held by a slight
/// shift.
[[nodiscard]] Eigen::SparseMatrix<double> laplacian(const Problem& problem, const Uses& uses);

/// The right side with which its solution is where Jacobian matrices are as near as possible to the
/// targets.
[[nodiscard]] Vector targetForces(const Problem& problem, const Uses& uses);

}  // namespace hexhex::untangle
