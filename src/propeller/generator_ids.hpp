// Where each hex vertex came from, in terms of the caller's mesh.
#pragma once

#include <hexhex/types.hpp>

#include <propeller/hex_vertices.hpp>

namespace hexhex {

/// Fills generatorTet and generatorCorners of a mesh.
void describeGenerators(const PreparedMap& map, const HexVertices& vertices, HexMesh& mesh,
                        Stage& stage);

}  // namespace hexhex
