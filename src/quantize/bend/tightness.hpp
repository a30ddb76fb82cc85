// Diagnoses why tets remain flipped whatever the solver does: planes, curves and vertices whose
// positions the integers determine.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include <adjacency/tet_topology.hpp>

namespace hexhex::quantization {

struct VertexUnknowns;

/// Counts of flipped tets by cause.
struct Tightness {
  std::size_t inPlane = 0;  ///< all corners are bound to one plane
  std::size_t onCurve = 0;  ///< three corners are bound to one line, or two pairs to parallel lines
  std::size_t atPoint = 0;  ///< two corners are bound to one point
  std::size_t others = 0;   ///< not flat by themselves: their surroundings leave no room
  /// Of `others`: number of corners with none, one (on a plane), two (on a curve) or three (a
  /// vertex of the mesh) fixed coordinates.
  std::array<std::size_t, 4> corners{};
  Index tet = kNone;  ///< an example of the first kind with any tets

  /// A phrase to append to a sentence.
  [[nodiscard]] std::string describe() const;
};

/// @param tets  flipped ones
[[nodiscard]] Tightness findTightness(const VertexUnknowns& unknowns,
                                      const adjacency::TetTopology& topology,
                                      std::span<const Index> tets);

}  // namespace hexhex::quantization
