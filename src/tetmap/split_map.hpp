// Splits edges of a map, with everything that is known about it.
#pragma once

#include <span>

#include <adjacency/tet_topology.hpp>
#include <tetmap/cut.hpp>

#include <hexhex/types.hpp>

namespace hexhex::tetmap {

/// Inserts a vertex at the midpoint of each edge, in space and in all charts, and cuts the tets at
/// it in two. The map stays the same function. Edges that share a tet with an earlier one are left
/// out. One half of each tet keeps its number; the other halves, and the vertices, are appended.
/// What is known about the map (rotations, valences, features, regions) is carried over.
/// @param topology  of the map; must not be used afterwards
/// @return the number of edges that were split
std::size_t splitEdges(TetMap& map, const adjacency::TetTopology& topology,
                       std::span<const EdgeInTet> edges);

}  // namespace hexhex::tetmap
