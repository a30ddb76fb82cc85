// MFEM mesh v1.0, for simulations. Written only, and only by the name of the format, since MFEM's
// files have the extension of MEDIT's.
#pragma once

#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

/// Writes cells (attribute 1), boundary quads and tagged quads inside (attribute: the number of
/// their group, see mesh_groups.hpp), and vertices. Numbers have the fewest digits (at most 17)
/// that read back to the same double.
/// @throws Error FileWrite; InvalidArgument for features that are not in the mesh
void writeMfem(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
               Context& context);

}  // namespace hexhex
