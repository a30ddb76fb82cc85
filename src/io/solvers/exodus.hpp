// `.exo`, `.e`: Exodus II, for the codes of Sandia and MOOSE. Written only, and only by builds with
// its library (HEXHEX_HAS_EXODUS).
#pragma once

#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

/// Writes an element block HEX8 for each region, a side set for each group of boundary quads, and
/// node sets for the tags of edges and vertices; sets and blocks are named as mesh_groups.hpp says.
/// Side sets and blocks have the numbers of their groups. Tagged quads inside the mesh are left
/// out. The cells are in order of their regions.
///
/// NetCDF with 64-bit offsets; NetCDF 4, which takes larger arrays, for meshes that need it.
/// @throws Error FileWrite; InvalidArgument for features that are not in the mesh; TooLarge for
///         more than 2^31 - 1 vertices or cells
void writeExodus(const HexMesh& mesh, const std::filesystem::path& file,
                 const WriteOptions& options, Context& context);

}  // namespace hexhex
