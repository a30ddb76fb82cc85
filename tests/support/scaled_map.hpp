#pragma once

#include <hexhex/types.hpp>

namespace hexhex::test {

/// The map with its parameters multiplied.
inline TetMap scaled(TetMap map, double factor) {
  for (TetParameters& tet : map.parameters) {
    for (Vec3& u : tet) {
      for (double& x : u) x *= factor;
    }
  }
  return map;
}

}  // namespace hexhex::test
