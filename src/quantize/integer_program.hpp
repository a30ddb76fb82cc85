// The integer program of quantization, for whatever solves it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// A sum of arcs, with signs, that has to be zero: arc and factor, ascending.
using ArcEquation = std::vector<std::pair<Index, int>>;

/// Integers n that fulfil the equations and are not below their bounds, with the least sum of |n -
/// l| / max(l, 1).
struct IntegerProgram {
  std::vector<double> lengths;  ///< l
  std::vector<int> least;       ///< bounds: 1, or 0 for what has no length but noise
  std::vector<ArcEquation> equations;
};

/// Whether CBC (Forrest et al., COIN-OR branch and cut) was there when the library was built, and
/// can be loaded.
[[nodiscard]] bool canLoadCbc();

/// By CBC, in a process of its own, to within 1 % of the minimum. Deterministic: its limit is one
/// of nodes.
/// @return empty if there is no solution, or none is found. @pre canLoadCbc()
/// @throws Error OutOfMemory if it crashes; Cancelled
[[nodiscard]] std::vector<std::int64_t> solveByCbc(const IntegerProgram& program,
                                                   const Context& context);

/// By rounding the nearest real solution and then changing it step by step along integer solutions
/// of the equations. Finds good solutions where lengths are large, and none in some cases where
/// they are small.
[[nodiscard]] std::vector<std::int64_t> solveGreedily(const IntegerProgram& program, Stage& stage);

}  // namespace hexhex
