// Do the vertices of a hex mesh lie on lattice points of a map? Found out in space: a vertex is
// located in the tets, and the parameters of the tet are interpolated at it.
#pragma once

#include <cstdint>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// Vertices that no tet maps to a lattice point.
struct OffLattice {
  std::uint64_t count = 0;
  Index first = kNone;   ///< the smallest such vertex
  double distance = 0;   ///< its distance from the lattice in hex edges
  bool outside = false;  ///< no tet contains it; `distance` has no meaning
};

/// Checks every vertex. The result does not depend on the number of threads.
/// @param map      valid; charts may be anywhere, tets may be inverted or degenerate in space
/// @param scale    factor of all parameters
/// @param allowed  how far from the lattice a vertex may be, in hex edges (after scaling)
[[nodiscard]] OffLattice findOffLattice(const TetMapView& map, const HexMesh& mesh, int scale,
                                        double allowed, Stage& stage);

}  // namespace hexhex
