// Does a mesh have as many faces, edges and components as its map demands? A second opinion beside
// the proof, which looks at the mesh alone: faces and edges are what has the same vertices.
#pragma once

#include <verify/comparisons.hpp>

#include <hexhex/check.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::verification {

/// Compares a mesh, with corners in range, with what is expected of it. Says nothing where a map is
/// so coarse that different edges or faces have the same vertices: where cells meet themselves, or
/// another one twice.
void compareSums(const Expectation& expected, const HexMesh& mesh, Stage& stage,
                 Comparisons& comparisons);

}  // namespace hexhex::verification
