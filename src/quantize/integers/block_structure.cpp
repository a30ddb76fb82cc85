#include <algorithm>
#include <cmath>
#include <utility>

#include <quantize/integers/block_structure.hpp>

namespace hexhex::quantization {

namespace {

/// Lengths are noise up to this fraction of the map's size, or this multiple of the displacement
/// that made it seamless.
constexpr double kArcNoise = 1e-9;
constexpr double kArcNoiseShare = 16;
constexpr double kLengthUnits = 0x1p20;
/// The search for a scale ends once the number of cells is within this factor of the target.
constexpr double kNearEnough = 1.03;
constexpr int kScaleSteps = 6;

}  // namespace

BlockStructure::BlockStructure(const SeamlessMap& map, bool reduced, Context& context)
    : map_(map), complex_(traceComplex(map, reduced, context)) {
  program_.equations = arcEquations(complex_);
  // Walls separated by noise only may coincide.
  const double noise = std::max(kArcNoise * map.size, kArcNoiseShare * map.maxDisplacement);
  for (const Arc& arc : complex_.arcs) {
    program_.least.push_back(static_cast<double>(arc.length) < noise * map.unit ? 0 : 1);
  }
}

std::optional<Choice> BlockStructure::choose(double cells, const IntegerSolver& solver,
                                             Context& context) const {
  Stage stage(context, "integers");
  std::optional<Choice> best;
  const auto distance = [cells](const Choice& choice) {
    return std::abs(std::log(choice.cells / cells));
  };
  IntegerProgram program = program_;
  double scale = std::cbrt(cells / volumeOf(map_));
  for (int step = 0; step < kScaleSteps; ++step) {
    context.throwIfCancelled();
    program.lengths.clear();
    for (const Arc& arc : complex_.arcs) {
      // Removes noise, which would decide between equally good integers.
      const double length = static_cast<double>(arc.length) / map_.unit * scale;
      program.lengths.push_back(std::round(length * kLengthUnits) / kLengthUnits);
    }
    Choice choice{scale, solver.solve(program, context), 0};
    if (choice.integers.empty()) {
      // Rounding may succeed for longer arcs.
      scale *= 1.2;
      continue;
    }
    choice.cells = BlockIntegers(complex_, choice.integers).cellCount();
    scale *= std::cbrt(cells / choice.cells);
    if (!best || distance(choice) < distance(*best)) best = std::move(choice);
    if (distance(*best) < std::log(kNearEnough)) break;
  }
  return best;
}

}  // namespace hexhex::quantization
