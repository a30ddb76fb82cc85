// Triangles without area, which CAD programs write where edges of faces have vertices of their own.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <hexhex/fill.hpp>

namespace hexhex::fill {

/// A side of a triangle. Side i of triangle t, from its corner i to the next, has the number 3 t +
/// i.
struct Side {
  std::array<Index, 2> ends;  ///< ascending
  Index side;
  auto operator<=>(const Side&) const = default;
};

/// All sides, those of an edge in succession.
[[nodiscard]] std::vector<Side> sortedSides(const TriangleMesh& surface);

/// Removes triangles without area, which leaves the surface in space as it is. If two corners are
/// the same, the triangle goes; otherwise its middle corner splits the triangle beside its longest
/// edge. Those without a single such neighbour stay.
/// @param surface  its triangles name points, and these are finite
/// @return how many were removed
std::size_t removeFlatTriangles(TriangleMesh& surface);

}  // namespace hexhex::fill
