// Edges of a map are split with all that is known of it.
#pragma once

#include <span>

#include <adjacency/tet_topology.hpp>
#include <tetmap/cut.hpp>

#include <hexhex/types.hpp>

namespace hexhex::tetmap {

/// Puts a vertex in the middle of each edge, in space and in all charts, and cuts the tets at it in
/// two. The map stays the same function. Edges that share a tet with one before them are left out.
/// One of the two tets keeps its number, the others, and the vertices, are appended; what is known
/// about the map (rotations, valences, features, regions) is carried over.
/// @param topology  of the map; must not be used afterwards
/// @return the number of edges that were split
std::size_t splitEdges(TetMap& map, const adjacency::TetTopology& topology,
                       std::span<const EdgeInTet> edges);

}  // namespace hexhex::tetmap
