// Checks that cells refer to existing vertices.
#pragma once

#include <cstddef>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::adjacency {

/// The first cell with a corner that is not a vertex of the mesh, or the number of cells.
[[nodiscard]] std::size_t firstCellOutOfRange(const HexMesh& mesh, Stage& stage);

/// @throws Error InvalidArgument, with the first cell, if a corner is not a vertex of the mesh
void requireCornersInRange(const HexMesh& mesh, Stage& stage);

/// @throws Error IndexOutOfRange, with the first tet, if a corner is not a vertex of the map
void requireCornersInRange(const TetMapView& map, Stage& stage);

}  // namespace hexhex::adjacency
