// Newton's method for the energy of a bent map.
#pragma once

#include <Eigen/SparseCholesky>
#include <quantize/bend_energy.hpp>

namespace hexhex {

class NewtonSolver {
 public:
  /// @param energy  must outlive this
  NewtonSolver(const BendEnergy& energy, Stage& stage);

  /// Minimizes the Dirichlet energy.
  void start(Vector& x);

  /// Goes on until no tet is flipped, or nothing helps any more. Never ends with more flipped tets
  /// than it began with.
  /// @param epsilon  of the penalty in the beginning
  /// @return whether no tet is flipped
  bool untangle(Vector& x, double epsilon);

  /// Lowers distortion, and never leaves the set of maps without flipped tets, which x is to be in.
  /// @param steps  at most
  void polish(Vector& x, int steps);

  [[nodiscard]] int iterations() const noexcept { return iterations_; }

 private:
  /// One step's share of the energy that is gone.
  double step(BendEnergyKind kind, Vector& x);
  [[nodiscard]] Vector direction();

  const BendEnergy& energy_;
  Stage& stage_;
  SparseMatrix hessian_;
  Vector gradient_;
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower> cholesky_;
  int iterations_ = 0;
};

}  // namespace hexhex
