// The integer program of quantization (Brückler et al. 2022), and its solvers.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

namespace hexhex::quantization {

/// A signed sum of arcs that must vanish, as arcs with factors, ascending.
using ArcEquation = std::vector<std::pair<Index, int>>;

/// Finds integers n that satisfy the equations and their lower bounds and minimize the sum of |n -
/// l| / max(l, 1).
struct IntegerProgram {
  std::vector<double> lengths;  ///< l
  std::vector<int> least;       ///< lower bounds: 1, or 0 for arcs whose length is noise
  std::vector<ArcEquation> equations;
};

struct IntegerSolver {
  const char* name = nullptr;  ///< "HiGHS" or "rounding"; nullptr if not available

  /// Deterministic; returns soon after cancellation.
  /// @return empty if no solution exists or is found
  /// @throws std::bad_alloc, Error Cancelled
  std::vector<std::int64_t> (*solve)(const IntegerProgram& program,
                                     const Context& context) = nullptr;
};

/// HiGHS (Huangfu and Hall 2018, "Parallelizing the dual revised simplex method"), loaded from the
/// file that the environment variable HEXHEX_HIGHS names, or else from where it was installed with
/// hexhex or when hexhex was built, or else from the system's search path. Gets within 1 % of the
/// optimum unless that takes too long.
/// @return a solver without name if there is no HiGHS
/// @throws Error FileUnsupported if it exists but cannot be loaded
[[nodiscard]] IntegerSolver highsSolver();

/// Rounds the nearest real solution, then improves it greedily along integer solutions of the
/// equations. Finds good solutions for large lengths, and sometimes none for small ones.
[[nodiscard]] IntegerSolver roundingSolver();

/// HiGHS if available, else rounding.
[[nodiscard]] IntegerSolver integerSolver();

}  // namespace hexhex::quantization
