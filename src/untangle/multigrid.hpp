// Multigrid by smoothed aggregation with a factored coarsest level: approximates the inverse of a
// weighted Laplacian in linear time.
//
// P. Vaněk, J. Mandel, M. Brezina, "Algebraic multigrid by smoothed aggregation for second and
// fourth order elliptic problems", Computing 56 (1996).
#pragma once

#include <cstddef>
#include <deque>

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <hexhex/context.hpp>

namespace hexhex::untangle {

using Vector = Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

class Multigrid {
 public:
  /// @param matrix  symmetric and positive definite; both triangles
  /// @param mostFactored  a matrix with at most this many rows is factored
  Multigrid(SparseMatrix matrix, Eigen::Index mostFactored, const Context& context);
  /// A single level: a cycle is a symmetric Gauss-Seidel sweep.
  explicit Multigrid(SparseMatrix matrix);

  /// One cycle: a linear map, symmetric and positive definite; the inverse itself if the matrix was
  /// factored.
  [[nodiscard]] Vector cycle(const Vector& v) const { return cycle(0, v); }
  /// The matrix's inverse times a vector, by conjugate gradients.
  [[nodiscard]] Vector solve(const Vector& v) const;

 private:
  struct Level {
    SparseMatrix matrix;
    SparseMatrix prolongation;  ///< from the next coarser level; empty without one
  };
  [[nodiscard]] Vector cycle(std::size_t level, const Vector& v) const;

  std::deque<Level> levels_;  ///< a deque, since Eigen could not move them
  Eigen::SimplicialLDLT<SparseMatrix> factor_;
};

}  // namespace hexhex::untangle
