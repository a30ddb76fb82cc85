// Integers of arcs without a solver: rounds the nearest real solution, then improves it greedily
// along integer solutions of the equations.
#include <algorithm>
#include <cmath>
#include <limits>

#include <quantize/integers/integer_program.hpp>
#include <quantize/seamless/integer_form.hpp>

namespace hexhex::quantization {

namespace {

/// Cost of a number below its bound, per unit; exceeds the cost of any distance.
constexpr double kTooSmall = 1e6;

double cost(std::int64_t integer, double length, int least) {
  const double distance = std::abs(static_cast<double>(integer) - length) / std::max(length, 1.0);
  return distance + kTooSmall * static_cast<double>(std::max<std::int64_t>(least - integer, 0));
}

/// A change of integers that preserves all equations.
struct Move {
  std::vector<std::pair<Index, std::int64_t>> arcs;
};

/// The smallest change of each free variable, with what follows for other variables.
std::vector<Move> movesOf(const IntegerSystem& system, std::size_t arcCount) {
  std::vector<Move> moves;
  for (const Index free : system.freeVariables()) {
    std::vector<double> direction(arcCount);
    // Doubles the step while it would make another variable fractional.
    for (std::int64_t step = 1; step <= 4; step *= 2) {
      direction[free] = static_cast<double>(step);
      const std::vector<std::int64_t> values = system.roundedTo(direction, 1);
      if (values.empty()) continue;
      Move move;
      for (Index a = 0; a < arcCount; ++a) {
        if (values[a] != 0) move.arcs.emplace_back(a, values[a]);
      }
      moves.push_back(std::move(move));
      break;
    }
  }
  return moves;
}

std::vector<std::int64_t> solveByRounding(const IntegerProgram& program, const Context& context) {
  std::vector<IntegerForm> forms;
  for (const ArcEquation& equation : program.equations) {
    IntegerForm form;
    for (const auto& [arc, factor] : equation) form.add({arc, 1}, factor);
    forms.push_back(std::move(form));
  }
  const std::size_t n = program.lengths.size();
  const IntegerSystem system(n, std::move(forms));
  std::vector<std::int64_t> integers;
  for (std::int64_t step = 1; integers.empty() && step <= 4; step *= 2) {
    integers = system.roundedTo(program.lengths, step);
  }
  if (integers.empty()) return {};
  const std::vector<Move> moves = movesOf(system, n);
  // Steepest descent: applies the best move until none reduces the cost.
  while (true) {
    context.throwIfCancelled();
    double bestGain = 1e-9;
    const Move* best = nullptr;
    int bestSign = 0;
    for (const Move& move : moves) {
      for (const int sign : {1, -1}) {
        double gain = 0;
        for (const auto& [arc, by] : move.arcs) {
          const double length = program.lengths[arc];
          const int least = program.least[arc];
          gain +=
              cost(integers[arc], length, least) - cost(integers[arc] + sign * by, length, least);
        }
        if (gain <= bestGain) continue;
        bestGain = gain;
        best = &move;
        bestSign = sign;
      }
    }
    if (best == nullptr) break;
    for (const auto& [arc, by] : best->arcs) integers[arc] += bestSign * by;
  }
  for (std::size_t a = 0; a < n; ++a) {
    if (integers[a] < program.least[a]) return {};
  }
  return integers;
}

}  // namespace

IntegerSolver roundingSolver() { return {"rounding", solveByRounding}; }

IntegerSolver integerSolver() {
  const IntegerSolver highs = highsSolver();
  return highs.name != nullptr ? highs : roundingSolver();
}

}  // namespace hexhex::quantization
