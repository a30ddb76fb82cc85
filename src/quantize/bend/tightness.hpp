// What keeps tets flipped that no solver could mend: planes, curves and vertices whose places
// follow from the integers.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include <adjacency/tet_topology.hpp>

namespace hexhex::quantization {

struct VertexUnknowns;

/// Tets that are flat wherever their free coordinates are, and what binds them.
struct Tightness {
  std::size_t inPlane = 0;  ///< all corners are bound to one plane
  std::size_t onCurve = 0;  ///< three corners are bound to one line, or two each to parallel ones
  std::size_t atPoint = 0;  ///< two corners are bound to one point
  std::size_t others = 0;   ///< not flat by themselves: what is around them leaves no room
  /// Of those: how many coordinates of their corners are fixed: none, one (on a plane), two (on a
  /// curve), or three (a vertex of the mesh).
  std::array<std::size_t, 4> corners{};
  Index tet = kNone;  ///< one of the first kind that there is

  /// In words, to be appended to a sentence.
  [[nodiscard]] std::string describe() const;
};

/// @param tets  some, that are flipped
[[nodiscard]] Tightness findTightness(const VertexUnknowns& unknowns,
                                      const adjacency::TetTopology& topology,
                                      std::span<const Index> tets);

}  // namespace hexhex::quantization
