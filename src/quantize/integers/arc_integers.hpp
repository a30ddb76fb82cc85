// Numbers of hexahedra along the arcs of a motorcycle complex (Brückler et al. 2022, "Volume
// Parametrization Quantization for Hexahedral Meshing").
#pragma once

#include <cstdint>
#include <vector>

#include <quantize/complex/motorcycle_complex.hpp>
#include <quantize/integers/integer_program.hpp>

namespace hexhex::quantization {

/// The equations that make opposite sides of each patch equally long.
[[nodiscard]] std::vector<ArcEquation> arcEquations(const MotorcycleComplex& complex);

/// Maps positions of the nodes on the border of a block to integer positions.
class BlockIntegers {
 public:
  /// @param integers  per arc
  BlockIntegers(const MotorcycleComplex& complex, const std::vector<std::int64_t>& integers);

  /// The integer position of a node of a block, given its position in the block's chart.
  [[nodiscard]] const lattice::LatticePoint& operator()(
      Index block, const lattice::LatticePoint& position) const {
    return positions_[block].at(position);
  }
  /// The motion across a half-face, between the integer charts of the blocks on its sides.
  [[nodiscard]] lattice::LatticeMotion across(const MotorcycleComplex& complex,
                                              adjacency::HalfFace h) const {
    return complex.mesh.isWall[h] ? across_[complex.patchOf[h]] : lattice::LatticeMotion{};
  }
  [[nodiscard]] double cellCount() const noexcept { return cells_; }

 private:
  void findPositions(const MotorcycleComplex& complex, const std::vector<std::int64_t>& integers);
  void findTransitions(const MotorcycleComplex& complex);

  std::vector<std::map<lattice::LatticePoint, lattice::LatticePoint>> positions_;  ///< per block
  std::vector<lattice::LatticeMotion> across_;  ///< per side of a patch
  double cells_ = 0;
};

}  // namespace hexhex::quantization
