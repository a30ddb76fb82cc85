// Higher-order cells that are positive wherever the straight cells are.
#pragma once

#include <vector>

#include <hexhex/curved.hpp>

#include <base/stage.hpp>

namespace hexhex::curved {

/// Keeps the nodes on the boundary, between regions, and on tagged edges and quads; blends all
/// others between them. Where a cell is not positive but its straight version is, its interior
/// nodes stay on the map as well; where that does not help, nodes leave the surface towards the
/// straight cell by halves until the cell is positive.
/// @param mesh  its nodes are on the image of the map
/// @return the cells with nodes that have left the surface, ascending
[[nodiscard]] std::vector<Index> blendNodes(LagrangeMesh& mesh, Stage& stage);

}  // namespace hexhex::curved
