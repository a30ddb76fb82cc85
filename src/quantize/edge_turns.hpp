// Does a bent map turn around each edge as often as its reference? Positive tets alone do not
// ensure that: around an inner edge they may wind twice, which would make it singular.
#pragma once

#include <span>
#include <vector>

#include <adjacency/tet_topology.hpp>

namespace hexhex {

/// Tets at edges where the sums of dihedral angles in both maps differ, ascending. Both maps have
/// the same rotations between charts, and boundary triangles along planes of the grid, so sums that
/// differ do so by a right angle at least. Needs the stars of the topology.
[[nodiscard]] std::vector<Index> tetsAtOtherTurns(const TetTopology& topology,
                                                  std::span<const TetParameters> reference,
                                                  std::span<const TetParameters> bent,
                                                  Stage& stage);

}  // namespace hexhex
