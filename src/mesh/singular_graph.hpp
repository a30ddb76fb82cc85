// Chains of singular edges, and the vertices on them, by type.
#pragma once

#include <span>

#include <hexhex/base_complex.hpp>
#include <hexhex/structure.hpp>

#include <base/stage.hpp>

namespace hexhex::mesh {

/// Fills in curves and irregular vertices.
/// @param mates     per half-face, 6 * cell + face: kNone on the boundary
/// @param singular  all singular edges of the mesh
void findSingularGraph(const HexMesh& mesh, std::span<const Index> mates,
                       std::span<const SingularHexEdge> singular, Stage& stage,
                       BaseComplex& result);

}  // namespace hexhex::mesh
