// Cells of higher order that are positive where straight cells are.
#pragma once

#include <vector>

#include <hexhex/curved.hpp>

#include <base/stage.hpp>

namespace hexhex::curved {

/// Leaves nodes of the boundary, between regions and of tagged edges and quads where they are, and
/// blends all others between them. Where a cell is not positive, but straight it is, its nodes
/// inside stay where they are, too; where that does not help, nodes leave the surface towards the
/// straight cell by halves, until it is.
/// @param mesh  its nodes are on the image of the map
/// @return the cells with nodes that have left the surface, ascending
[[nodiscard]] std::vector<Index> blendNodes(LagrangeMesh& mesh, Stage& stage);

}  // namespace hexhex::curved
