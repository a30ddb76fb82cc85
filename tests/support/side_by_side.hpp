// Maps of several components.
#pragma once

#include <hexhex/types.hpp>

namespace hexhex::test {

/// Adds another map, moved in space along x; its parameters stay as they are.
inline void addBeside(TetMap& map, const TetMap& other, double distance) {
  const auto first = static_cast<Index>(map.points.size());
  for (const Vec3& p : other.points) map.points.push_back({p[0] + distance, p[1], p[2]});
  for (Tet tet : other.tets) {
    for (Index& vertex : tet) vertex += first;
    map.tets.push_back(tet);
  }
  map.parameters.insert(map.parameters.end(), other.parameters.begin(), other.parameters.end());
}

[[nodiscard]] inline TetMap sideBySide(TetMap map, const TetMap& other) {
  addBeside(map, other, 10);
  return map;
}

}  // namespace hexhex::test
