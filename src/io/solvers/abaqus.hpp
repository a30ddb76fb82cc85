// `.inp`: Abaqus and CalculiX input, for simulations. Written only.
#pragma once

#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

/// Writes nodes and elements of type C3D8, numbered from 1, and the groups of mesh_groups.hpp: for
/// each group of vertices, edges and quads a node set, and for each group of boundary quads an
/// element surface. Names are in upper case: element set HEXAHEDRA, node sets N_BOUNDARY,
/// N_SURFACE_7, N_CURVE_3, N_POINT_1, surfaces S_BOUNDARY, S_SURFACE_7.
///
/// Numbers take at most 20 characters, since programs cut longer ones off: they read back to the
/// same double where 20 characters suffice, which is so for most; others are rounded, to at least
/// 13 significant digits.
/// @throws Error FileWrite; InvalidArgument for features that are not in the mesh
void writeAbaqus(const HexMesh& mesh, const std::filesystem::path& file,
                 const WriteOptions& options, Context& context);

}  // namespace hexhex
