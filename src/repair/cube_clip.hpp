// Pieces of tets and triangles in the unit cube, by floating point.
#pragma once

#include <array>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex {

/// Volume of the part of a positive tet in [0, 1]^3.
[[nodiscard]] double volumeInCube(const std::array<Vec3, 4>& tet);

/// The part of a triangle in [0, 1]^3.
struct ClippedTriangle {
  double area = 0;
  Vec3 centre{};  ///< if the area is not 0
};
[[nodiscard]] ClippedTriangle clipToCube(const std::array<Vec3, 3>& triangle);

}  // namespace hexhex
