// What a mesh must be before moving its vertices can make it right.
#pragma once

#include <cstddef>

#include <hexhex/quality.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::improvement {

/// @param mesh   with corners in range
/// @param parts  cells of the mesh for each that errors count
/// @throws Error RepeatedVertex for a cell that names a vertex twice; NonManifoldFace for a face of
///         more than two cells; Orientation where two cells pass their common face in the same
///         direction, and for cells that list their corners the other way round
void requireSoundCells(const HexMesh& mesh, std::size_t parts, Context& context);

/// Of cells that are not certified, those which share with another cell two faces that meet at an
/// edge: at its ends, the determinants of the two are opposite numbers, so that one of them is not
/// positive wherever vertices are. Ascending.
/// @param parts  as above
[[nodiscard]] Array<std::uint64_t> cellsThatCannotBePositive(const HexMesh& mesh, std::size_t parts,
                                                             const Certificate& certificate,
                                                             Stage& stage);

/// Compares positions with generators. Vertices may have moved since the mesh was extracted, but no
/// farther than their cells are long.
/// @param mesh  with generators in the map
/// @throws Error InvalidArgument if more than a tenth of the cells are farther from them
void requireSameObject(const HexMesh& mesh, const TetMapView& map, Stage& stage);

}  // namespace hexhex::improvement
