// Verification against expectations that are given: the part of verify() that does not examine the
// map's combinatorics. Whether the vertices of a hex mesh lie on lattice points of a map is found
// out in space: a vertex is located in the tets, and the parameters of the tet are interpolated at
// it.
#pragma once

#include <cstdint>

#include <hexhex/check.hpp>
#include <hexhex/verify.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// Compares a mesh with what is expected of it. The mesh may be anything, even have corners out of
/// range.
/// @param map  valid; its tets and parameters tell where lattice points are in space
[[nodiscard]] VerifyReport verifyAgainst(const Expectation& expected, const TetMapView& map,
                                         const HexMesh& mesh, const VerifyOptions& options,
                                         Stage& stage);

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
