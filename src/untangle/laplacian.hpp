// The weighted Laplacian of all elements: the Hessian of the sum of weight / 2 |J - target|^2.
#pragma once

#include <Eigen/SparseCore>
#include <untangle/foldover_energy.hpp>

namespace hexhex::untangle {

/// Stores both triangles. A slight shift fixes what the elements leave undetermined, such as a
/// translation.
[[nodiscard]] Eigen::SparseMatrix<double> laplacian(const Problem& problem, const Uses& uses);

/// The right-hand side for which the solution brings Jacobian matrices as close as possible to
/// their targets.
[[nodiscard]] Vector targetForces(const Problem& problem, const Uses& uses);

}  // namespace hexhex::untangle
