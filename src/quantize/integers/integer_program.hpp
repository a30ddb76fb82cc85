// The integer program of quantization (Brückler et al. 2022), and its solvers.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

namespace hexhex::quantization {

/// A signed sum of arcs that must be zero: arc and factor, ascending.
using ArcEquation = std::vector<std::pair<Index, int>>;

/// Integers n that satisfy the equations and are not below their bounds, with the least sum of |n -
/// l| / max(l, 1).
struct IntegerProgram {
  std::vector<double> lengths;  ///< l
  std::vector<int> least;       ///< bounds: 1, or 0 for arcs whose length is mere noise
  std::vector<ArcEquation> equations;
};

struct IntegerSolver {
  const char* name = nullptr;  ///< "HiGHS", "rounding"; nullptr: there is none

  /// Deterministic, and ends soon after it is cancelled.
  /// @return empty if there is no solution, or none is found
  /// @throws std::bad_alloc, Error Cancelled
  std::vector<std::int64_t> (*solve)(const IntegerProgram& program,
                                     const Context& context) = nullptr;
};

/// HiGHS (Huangfu and Hall 2018, "Parallelizing the dual revised simplex method"), if it can be
/// loaded: from the file named by the environment variable HEXHEX_HIGHS, from where it was
/// installed with hexhex or when hexhex was built, or from the system's search path. It gets within
/// 1 % of the minimum, unless that takes too long.
/// @throws Error FileUnsupported if it exists but cannot be loaded
[[nodiscard]] IntegerSolver highsSolver();

/// Rounds the nearest real solution, then improves it step by step along integer solutions of the
/// equations. Finds good solutions for large lengths, and sometimes none for small ones.
[[nodiscard]] IntegerSolver roundingSolver();

/// HiGHS, if available.
[[nodiscard]] IntegerSolver integerSolver();

}  // namespace hexhex::quantization
