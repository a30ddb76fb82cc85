// Which simplices of an integer-grid map lie in grid planes, where meshes have vertices.
#pragma once

#include <cmath>
#include <cstddef>

#include <hexhex/types.hpp>

#include <lattice/tet_geometry.hpp>

namespace hexhex::tetmap {

/// The number of axes along which the given corners of a tet have the same integer coordinate: at
/// least 1 for a triangle that contains quads, 2 for an edge that contains hex edges.
[[nodiscard]] inline int gridPlanes(const TetParameters& u, lattice::CornerMask corners) {
  constexpr double kRounding = 1e-6;  // in maps that other programs wrote
  int count = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double plane = NAN;
    bool isLevel = true;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!lattice::contains(corners, static_cast<int>(i))) continue;
      if (std::isnan(plane)) plane = std::round(u[i][axis]);
      isLevel = isLevel && std::abs(u[i][axis] - plane) <= kRounding;
    }
    if (isLevel) ++count;
  }
  return count;
}

}  // namespace hexhex::tetmap
