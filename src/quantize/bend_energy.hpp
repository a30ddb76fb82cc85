// The energy of a bent map as a function of its unknowns, with gradient and a positive semidefinite
// stand-in for the Hessian matrix.
//
// V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov, "Foldover-free maps in
// 50 lines of code", ACM Transactions on Graphics 40 (2021).
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <quantize/vertex_unknowns.hpp>

namespace hexhex {

using SparseMatrix = Eigen::SparseMatrix<double>;  ///< the lower triangle of a symmetric one
using Vector = Eigen::VectorXd;

/// Which energy: of the Jacobian matrix J of a tet, from its reference to its bent shape.
struct BendEnergyKind {
  enum class Name : std::uint8_t {
    Dirichlet,    ///< |J - 1|^2: quadratic, blind to flipped tets
    FoldoverFree  ///< |J|^2 / chi^(2/3) + (det^2 + 1) / chi: angles, and volumes
  };
  Name name = Name::Dirichlet;
  /// Of chi, the positive stand-in for the determinant. With 0 it is the determinant itself, and
  /// the energy infinite unless that is positive.
  double epsilon = 0;
};

/// A positive stand-in for a determinant: near it if it is positive, near 0 if it is negative.
[[nodiscard]] double regularized(double epsilon, double det) noexcept;

/// How far a map is from one without flipped tets.
struct Folding {
  double leastDeterminant = std::numeric_limits<double>::infinity();
  Index flippedTets = 0;  ///< or flat
};

class BendEnergy {
 public:
  /// All arguments must outlive this. Needs the stars of the topology.
  BendEnergy(const TetTopology& topology, std::span<const TetParameters> reference,
             const VertexUnknowns& unknowns);

  /// The unknowns that are the coordinates of a vertex's representative; -1: fixed.
  [[nodiscard]] const std::array<int, 3>& unknownsOf(Index vertex) const noexcept {
    return numbers_[vertex];
  }
  [[nodiscard]] int unknownCount() const noexcept { return count_; }

  /// Corners of a tet in its chart, as columns.
  [[nodiscard]] Eigen::Matrix<double, 3, 4> corners(Index tet, const Vector& x) const;

  [[nodiscard]] Folding folding(const Vector& x, Stage& stage) const;

  /// Makes the reference as large as the bent map, whose volume follows from its integers alone: at
  /// low densities that is several times as much, and tets would fight for their size.
  void adaptScale(const Vector& x);

  /// Mean over the reference volume.
  [[nodiscard]] double value(BendEnergyKind kind, const Vector& x, Stage& stage) const;

  /// All pairs of unknowns of one edge or vertex.
  [[nodiscard]] SparseMatrix emptyHessian() const;

  /// @param[out] gradient  by unknown
  /// @param[out] hessian   with the entries of emptyHessian(): without the terms that come from the
  ///                       curvature of determinants and of chi
  void derivatives(BendEnergyKind kind, const Vector& x, Vector& gradient,
                   SparseMatrix& hessian) const;

 private:
  struct Shape {
    /// Row i: how the Jacobian matrix depends on corner i.
    Eigen::Matrix<double, 4, 3> gradients;
    double weight = 0;
  };

  void numberUnknowns();
  /// Computed anew each time: all of them would be the largest array of a quantization.
  [[nodiscard]] Shape shape(Index tet) const;

  const TetTopology& topology_;
  std::span<const TetParameters> reference_;
  const VertexUnknowns& unknowns_;
  std::vector<std::array<int, 3>> numbers_;  ///< per vertex
  int count_ = 0;
  double volume_ = 0;  ///< of the reference
  double scale_ = 1;   ///< by which the reference is to be enlarged
};

}  // namespace hexhex
