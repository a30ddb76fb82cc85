// Looks at a map as slowly and plainly as possible, sharing no code with the generator: what the
// tests of samples compare with the known answers.
#pragma once

#include <cstdint>
#include <map>

#include <hexhex/types.hpp>

namespace hexhex::test {

struct Inspection {
  /// Every triangle in one or two tets; if in two, in opposite directions; no repeated vertices,
  /// every point used.
  bool conforming = true;
  double leastDeterminantInMap = 0;    ///< over all tets
  double leastDeterminantInSpace = 0;  ///< likewise
  double volume = 0;                   ///< in the map
  double boundaryArea = 0;             ///< in the map
  /// Parametric length of edges whose angle sum is not regular, by angle sum in right angles.
  std::map<int, double> innerSingularLength;
  std::map<int, double> boundarySingularLength;
  double worstAngle = 0;  ///< distance of an angle sum from a multiple of a right angle
  /// Violations of the conditions of integer-grid maps, in parameter units: best rotation and
  /// integer translation between neighbours, boundary triangles and integer planes, singular edges
  /// and integer lines.
  double worstTransition = 0;
  double worstBoundary = 0;
  double worstSingularity = 0;
  std::uint64_t innerFaces = 0;
  std::uint64_t chartJumps = 0;  ///< inner faces where the parameters of the two tets differ
  std::uint64_t integerCoordinates = 0;  ///< among all corners
  std::int64_t eulerCharacteristic = 0;
  std::uint64_t components = 0;
  std::uint64_t boundaryComponents = 0;
};

[[nodiscard]] Inspection inspect(const TetMap& map);

}  // namespace hexhex::test
