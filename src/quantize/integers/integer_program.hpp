// The integer program of quantization, and what solves it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

namespace hexhex::quantization {

/// A sum of arcs, with signs, that has to be zero: arc and factor, ascending.
using ArcEquation = std::vector<std::pair<Index, int>>;

/// Integers n that fulfil the equations and are not below their bounds, with the least sum of |n -
/// l| / max(l, 1).
struct IntegerProgram {
  std::vector<double> lengths;  ///< l
  std::vector<int> least;       ///< bounds: 1, or 0 for what has no length but noise
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
/// loaded: from the file that the environment names in HEXHEX_HIGHS, or from where it was installed
/// with hexhex or when hexhex was built, or from where the system looks. It comes to within 1 % of
/// the minimum, unless it takes too long.
/// @throws Error FileUnsupported if it is there, but cannot be loaded
[[nodiscard]] IntegerSolver highsSolver();

/// Rounds the nearest real solution, and then changes it step by step along integer solutions of
/// the equations. Finds good solutions where lengths are large, and none in some cases where they
/// are small.
[[nodiscard]] IntegerSolver roundingSolver();

/// HiGHS, if it is there.
[[nodiscard]] IntegerSolver integerSolver();

}  // namespace hexhex::quantization
