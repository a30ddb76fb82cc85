// The volume of a tet, by plain arithmetic of its own.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <hexhex/types.hpp>

namespace hexhex::test {

/// Six times the volume; positive for tets in the usual order.
inline double sixfoldVolume(const std::vector<Vec3>& points, const Tet& tet) {
  std::array<Vec3, 3> e{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) e[i][k] = points[tet[i + 1]][k] - points[tet[0]][k];
  }
  return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
         e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
         e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

}  // namespace hexhex::test
