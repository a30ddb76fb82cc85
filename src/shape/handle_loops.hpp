// Loops around the handles of a surface.
#pragma once

#include <cstdint>
#include <vector>

#include <shape/surface.hpp>

#include <hexhex/context.hpp>

namespace hexhex::shape {

/// A closed strip of adjacent triangles.
struct HandleLoop {
  std::vector<Index> triangles;
  double length = 0;  ///< through the centres
  Vec3 area{};        ///< vector area of what it bounds: it runs counterclockwise around this
};

/// Finds disjoint loops, one per handle, that do not separate the surface together: what remains is
/// a sphere with holes. Short loops come first; one around a hole is preferred to one around the
/// solid beside it.
/// @param seed  for the triangles where the search starts
[[nodiscard]] std::vector<HandleLoop> handleLoops(const Surface& surface, std::uint64_t seed,
                                                  Context& context);

}  // namespace hexhex::shape
