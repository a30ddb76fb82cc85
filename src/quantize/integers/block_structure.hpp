// The blocks of a map, and the choice of integers for their arcs.
#pragma once

#include <optional>
#include <vector>

#include <quantize/integers/arc_integers.hpp>
#include <quantize/seamless/seamless_map.hpp>

#include <hexhex/context.hpp>

namespace hexhex::quantization {

/// Integers of all arcs at one scale.
struct Choice {
  double scale = 0;  ///< of the seamless map
  std::vector<std::int64_t> integers;
  double cells = 0;
};

/// A motorcycle complex with the constraints on integers of its arcs. Immutable.
class BlockStructure {
 public:
  /// @param map  must outlive this
  /// @param reduced  whether unnecessary walls are removed
  BlockStructure(const SeamlessMap& map, bool reduced, Context& context);

  [[nodiscard]] const MotorcycleComplex& complex() const noexcept { return complex_; }

  /// Searches for integers with a number of cells close to the target.
  /// @return nothing if the solver finds none
  [[nodiscard]] std::optional<Choice> choose(double cells, const IntegerSolver& solver,
                                             Context& context) const;

 private:
  const SeamlessMap& map_;
  MotorcycleComplex complex_;
  IntegerProgram program_;  ///< without lengths
};

}  // namespace hexhex::quantization
