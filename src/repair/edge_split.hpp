// Refines the tet mesh of a map: the last resort where moving parameters cannot work.
#pragma once

#include <array>
#include <span>

#include <adjacency/tet_topology.hpp>

#include <hexhex/types.hpp>

#include <repair/map_backup.hpp>

namespace hexhex {

/// Puts a vertex in the middle of each edge, in space and in all charts, and cuts the tets at it in
/// two. The map stays the same function. Edges that share a tet with one before them are left out.
/// One of the two tets keeps its number, the others, and the vertices, are appended; what is known
/// about the map (rotations, valences, features) is carried over.
/// @param topology  of the map; must not be used afterwards
/// @param backup  keeps what is changed
/// @return the number of edges that were split
std::size_t splitEdges(TetMap& map, const TetTopology& topology,
                       std::span<const std::array<Index, 2>> edges, MapBackup& backup);

}  // namespace hexhex
