// OpenFOAM's `polyMesh`: a folder of text files. Written only.
#pragma once

#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

/// Writes points, faces, owner, neighbour and boundary: inner faces in upper-triangular order, then
/// a patch for each group of boundary quads, named as mesh_groups.hpp says; and a cell zone
/// for each region. Numbers have the fewest digits (at most 17) that read back to the same double.
/// Tagged vertices, edges and quads inside the mesh are left out.
/// @param file  `CASE/X.foam`, which becomes an empty file, as ParaView opens it, next to
///              `CASE/constant/polyMesh`; or the name of the folder `polyMesh` itself. Folders are
///              created; other files in them stay. Each file appears complete or not at all, and
///              all at the end.
/// @throws Error FileWrite; InvalidArgument for features that are not in the mesh and faces of more
///         than two cells; TooLarge for more than 2^31 - 1 vertices, faces or cells
void writeOpenFoam(const HexMesh& mesh, const std::filesystem::path& file,
                   const WriteOptions& options, Context& context);

}  // namespace hexhex
