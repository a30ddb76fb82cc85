// What a mesh must be before moving its vertices can make it right.
#pragma once

#include <cstddef>

#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::improvement {

/// @param mesh   with corners in range
/// @param parts  cells of the mesh for each that errors count
/// @throws Error RepeatedVertex for a cell that names a vertex twice; NonManifoldFace for a face of
///         more than two cells; Orientation where two cells pass their common face in the same
///         direction, and for cells that list their corners the other way round
void requireSoundCells(const HexMesh& mesh, std::size_t parts, Context& context);

/// Compares positions with generators. Vertices may have moved since the mesh was extracted, but no
/// farther than their cells are long.
/// @param mesh  with generators in the map
/// @throws Error InvalidArgument if more than a tenth of the cells are farther from them
void requireSameObject(const HexMesh& mesh, const TetMapView& map, Stage& stage);

}  // namespace hexhex::improvement
