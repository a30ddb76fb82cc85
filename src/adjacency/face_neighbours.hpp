// Which cell is on the other side of each face: what formats that list faces need to know.
#pragma once

#include <array>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex {

/// Per cell and face (row of kHexFaces): the cell on the other side, kNone on the boundary.
using FaceNeighbours = Array<std::array<Index, 6>>;

/// @param mesh  whose corners are vertices of the mesh
/// @throws Error InvalidArgument for a face with more than two cells
[[nodiscard]] FaceNeighbours findFaceNeighbours(const HexMesh& mesh, Stage& stage);

}  // namespace hexhex
