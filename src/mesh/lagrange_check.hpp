// Whether the arrays of cells of higher order fit each other.
#pragma once

#include <hexhex/curved.hpp>

namespace hexhex::mesh {

/// Before anything else looks at them.
/// @throws Error InvalidArgument unless the order is legal, cells are complete and name nodes that
///         exist, their corners are among the first `vertexCount` nodes, and generators are one per
///         node or none
void requireConsistent(const LagrangeMesh& mesh);

}  // namespace hexhex::mesh
