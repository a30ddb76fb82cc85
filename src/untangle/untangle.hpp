// Foldover-free maps under linear constraints: moves unknowns until the Jacobian determinants of
// all elements are positive.
//
//     untangle::Problem problem = ...;          // problem.hpp says what elements are
//     untangle::Solver solver(problem, stage);
//     solver.start();                           // or put a map that is good in most places into x
//     const untangle::Result result = solver.run({});
//
// V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov, "Foldover-free maps in
// 50 lines of code", ACM Transactions on Graphics 40 (2021): a penalty for flipped elements grows
// as fast as the energy can follow. Each penalty gets a few steps of a quasi-Newton method whose
// metric is the Laplacian of the elements, inverted by multigrid: a step takes a time proportional
// to the number of elements. It ends when flipped elements vanish so slowly, over the last 8
// penalties (16 if it is to be patient), that some would be left after 150 of them. (Newton's
// method with a semidefinite stand-in for the Hessian matrix finds the same maps, but takes half as
// long again over those of docs/quantize.md, and three times as long over the hardest one.)
//
// Where flips stay, flatElements() says which ones no unknowns can mend.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include <untangle/problem.hpp>

#include <base/stage.hpp>

namespace hexhex::untangle {

struct Options {
  /// Of the penalty at first: 1 from anywhere, 1e-3 where few elements are flipped and the others
  /// are to stay as they are.
  double epsilon = 1;
  /// Steps, at most, that lower the energy once no element is flipped. None is flipped again.
  int polishing = 60;
  /// Whether the penalty grows slowly, and flips may stay for longer: for maps of which nothing is
  /// fixed, whose parts have to find their places first. Takes up to three times as many steps.
  bool isPatient = false;
  /// Of a round or two more, as it ends between rounds; without polishing.
  int mostSteps = std::numeric_limits<int>::max();
};

enum class End : unsigned char {
  Positive,  ///< no element is flipped
  Stalled,   ///< there were hardly fewer flipped elements, or none fewer, over many steps
             ///< or steps ran out
};

struct Result {
  std::vector<std::size_t> flipped;  ///< elements whose determinant is not positive, ascending
  double leastDeterminant = std::numeric_limits<double>::infinity();
  double energy =
      0;  ///< infinite if an element is flipped; 5 per weight where nothing is distorted
  int steps = 0;
  End end = End::Positive;
};

/// Deterministic with any number of threads. Cancellation takes effect within a step.
class Solver {
 public:
  /// @param problem  must outlive this and keep its elements; x and pull may change between calls
  Solver(Problem& problem, Stage& stage);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  /// Moves the unknowns to where Jacobian matrices are as near as possible to their targets,
  /// flipped or not: a linear problem, which does not depend on where they are.
  void start();

  /// Untangles from where the unknowns are. Never ends with more flipped elements than before.
  Result run(const Options& options);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Elements whose determinant vanishes wherever the unknowns are, ascending: their corners are
/// bound to one plane, say. Found at random unknowns, up to rounding.
[[nodiscard]] std::vector<std::size_t> flatElements(const Problem& problem);

}  // namespace hexhex::untangle
