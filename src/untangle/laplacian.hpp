// The weighted Laplacian of all elements: the Hessian matrix of the sum of weight / 2 |J -
// target|^2.
#pragma once

#include <Eigen/SparseCore>
#include <untangle/foldover_energy.hpp>

namespace hexhex::untangle {

/// Contains both triangles. What the elements leave undetermined (such as moving everything
/// together) is fixed by a slight shift.
[[nodiscard]] Eigen::SparseMatrix<double> laplacian(const Problem& problem, const Uses& uses);

/// The right-hand side for which the solution brings Jacobian matrices as close as possible to
/// their targets.
[[nodiscard]] Vector targetForces(const Problem& problem, const Uses& uses);

}  // namespace hexhex::untangle
