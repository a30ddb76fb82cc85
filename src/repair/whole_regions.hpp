// Defects that are not local: whole parts of the map that are inverted or collapsed.
#pragma once

#include <vector>

#include <adjacency/tet_topology.hpp>

#include <igm/input.hpp>

namespace hexhex {

/// Moving parameters along free coordinates changes no volume. So a component of the mesh without
/// positive volume cannot be repaired; nor can a map of which a large part is bad.
/// @param bad  ascending
/// @throws Error FlippedTet  that says what was found where
void refuseInvertedParts(const TetTopology& topology, const LocalParameters& parameters,
                         const std::vector<Index>& bad);

/// Refuses regions of many bad tets some of which have no good tet around: only a guess would tell
/// what they were meant to be.
/// @param bad  ascending
/// @throws Error FlippedTet  likewise
void refuseInvertedRegions(const TetTopology& topology, const std::vector<Index>& bad);

}  // namespace hexhex
