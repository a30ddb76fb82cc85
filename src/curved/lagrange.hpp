// Cells of higher order: groups of the vertices of a refined grid.
#pragma once

#include <hexhex/curved.hpp>

#include <igm/prepare.hpp>

namespace hexhex {

/// @param mesh  of the map as it is scaled now; its vertices become the first nodes
/// @param map   receives the scale of the nodes, `order` times what it had
[[nodiscard]] LagrangeMesh groupNodes(const HexMesh& mesh, PreparedMap& map, int order,
                                      Context& context);

}  // namespace hexhex
