// Foldover-free maps under linear constraints: moves unknowns until the Jacobian determinants of
// all elements are positive.
//
//     untangle::Problem problem = ...;          // problem.hpp defines elements
//     untangle::Solver solver(problem, stage);
//     solver.start();                           // or set x to a map that is mostly good
//     const untangle::Result result = solver.run({});
//
// V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov, "Foldover-free maps in
// 50 lines of code", ACM Transactions on Graphics 40 (2021): a penalty for flipped elements grows
// as fast as the energy can follow. Each penalty gets a few steps of a quasi-Newton method whose
// metric is the Laplacian of the elements, inverted by multigrid or by one sweep, so that the time
// per step is proportional to the number of elements. The solver stops when flipped elements vanish
// so slowly, over the last 8 penalties (16 in patient mode), that some would be left after 150
// penalties. (Newton's method with a semidefinite approximation of the Hessian finds the same maps,
// but takes 1.5 times as long for those of docs/user/quantize.md, and three times as long for the
// hardest.)
//
// If flips remain, flatElements() lists the elements that no unknowns can make positive.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include <untangle/problem.hpp>

#include <base/stage.hpp>

namespace hexhex::untangle {

struct Options {
  /// Initial regularization of the penalty: 1 from any starting point, 1e-3 if few elements are
  /// flipped and the others should stay as they are.
  double epsilon = 1;
  /// Maximum number of steps that improve the map further once no element is flipped. They never
  /// flip an element again.
  int polishing = 60;
  /// Whether the penalty grows slowly and flips may persist for longer: for maps without fixed
  /// corners, whose parts have to find their places first. Takes up to three times as many steps.
  bool isPatient = false;
  /// Maximum number of steps without polishing. Checked between rounds, so the last round may
  /// exceed it.
  int mostSteps = std::numeric_limits<int>::max();
};

enum class End : unsigned char {
  Positive,  ///< no element is flipped
  Stalled,   ///< flipped elements vanished too slowly, or steps ran out
};

struct Result {
  std::vector<std::size_t> flipped;  ///< elements whose determinant is not positive, ascending
  double leastDeterminant = std::numeric_limits<double>::infinity();
  double energy = 0;  ///< infinite if an element is flipped; 5 per weight if undistorted
  int steps = 0;
  End end = End::Positive;
};

/// How well the Laplacian is inverted.
enum class Inverse : unsigned char {
  Multigrid,    ///< for maps that are far from where they will be
  GaussSeidel,  ///< one symmetric sweep: nothing to set up, enough for a few steps
};

/// Deterministic with any number of threads. Cancellation takes effect within a step.
class Solver {
 public:
  /// @param problem  must outlive this and keep its elements; x and pull may change between calls
  Solver(Problem& problem, Stage& stage, Inverse inverse = Inverse::Multigrid);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  /// Sets the unknowns such that Jacobian matrices are as close as possible to their targets,
  /// flipped or not: a linear least-squares problem, independent of the current unknowns.
  void start();

  /// Untangles from the current unknowns. Never ends with more flipped elements than before.
  Result run(const Options& options);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Elements whose determinant vanishes whatever the unknowns, ascending: e.g. because their corners
/// are constrained to one plane. Tested at random unknowns, up to rounding.
[[nodiscard]] std::vector<std::size_t> flatElements(const Problem& problem);

}  // namespace hexhex::untangle
