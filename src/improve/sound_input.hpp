// Requirements on a mesh without which moving its vertices cannot make it valid.
#pragma once

#include <cstddef>

#include <hexhex/quality.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>

namespace hexhex::improvement {

/// @param mesh   with corners in range
/// @param parts  number of cells of the mesh per cell that errors refer to
/// @throws Error RepeatedVertex for a cell that names a vertex twice; NonManifoldFace for a face of
///         more than two cells; Orientation if two cells traverse their common face in the same
///         direction, and for mirrored cells
void requireSoundCells(const HexMesh& mesh, std::size_t parts, Context& context);

/// Uncertified cells that share two adjacent faces with another cell, ascending: at the ends of the
/// common edge of these faces, the determinants of the two cells are opposite, so one of the cells
/// is not positive wherever vertices are.
/// @param parts  as above
[[nodiscard]] Array<std::uint64_t> cellsThatCannotBePositive(const HexMesh& mesh, std::size_t parts,
                                                             const Certificate& certificate,
                                                             Stage& stage);

/// Compares the positions of vertices with their generators. Vertices may have moved since
/// extraction, but by no more than the size of their cells.
/// @param mesh  with generators in the map
/// @throws Error InvalidArgument if more than a tenth of the cells are farther away
void requireSameObject(const HexMesh& mesh, const TetMapView& map, Stage& stage);

}  // namespace hexhex::improvement
