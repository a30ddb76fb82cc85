// Tets as hexahedra, for a page that shows where a part cannot be meshed.
#pragma once

#include <cstdint>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

namespace hexhex::view {

/// Regions of cells.
inline constexpr std::int32_t kAtPlace = 1;
inline constexpr std::int32_t kElsewhere = 2;

/// Each tet cut into four hexahedra: one per corner, with the midpoints of edges and the centroids
/// of triangles and of the tet.
/// @param place  a vertex, edge, face or tet: its edges (of a vertex, those that end there) become
///        tagged edges, and tets that touch it are in a region of their own
/// @throws Error EmptyMesh, IndexOutOfRange
[[nodiscard]] HexMesh cutTets(const TetMesh& tets, const Place& place);

}  // namespace hexhex::view
