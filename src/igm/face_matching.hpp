// Finds the neighbour of each tet across each of its faces.
#pragma once

#include <igm/tet_topology.hpp>

namespace hexhex {

/// Fills `mate` and `vertexTet`. False if a triangle belongs to more than two tets, or if two tets
/// at one do not see it with opposite orientation; nothing may then be made of the result but a
/// list of defects.
[[nodiscard]] bool matchFaces(TetTopology& topology, Stage& stage);

}  // namespace hexhex
