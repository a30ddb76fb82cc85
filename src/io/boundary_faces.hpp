// The boundary of a hexahedral mesh for writers: the same quads as boundaryQuads() of
// mesh/hex_topology.hpp, with little memory and several times faster, since nothing else is asked.
#pragma once

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// The faces that belong to one cell only, facing outwards, in order of (cell, face of the cell).
/// @param mesh  whose corners are vertices of the mesh
[[nodiscard]] Array<Quad> findBoundaryQuads(const HexMesh& mesh, Stage& stage);

}  // namespace hexhex
