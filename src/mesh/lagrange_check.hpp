// Whether the arrays of a higher-order mesh are consistent.
#pragma once

#include <hexhex/curved.hpp>

namespace hexhex::mesh {

/// Call before anything else reads them.
/// @throws Error InvalidArgument unless the order is legal, cells are complete and name nodes that
///         exist, their corners are among the first `vertexCount` nodes, and there is one generator
///         per node or none
void requireConsistent(const LagrangeMesh& mesh);

}  // namespace hexhex::mesh
