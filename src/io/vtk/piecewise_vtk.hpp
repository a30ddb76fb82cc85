// Arcs and patches as `.vtu`, or as `.vtp` if the file is named so.
#pragma once

#include <filesystem>

#include <hexhex/curved.hpp>

namespace hexhex {

/// A line per segment. Point arrays: `hex_edge` (Int32; -1 at hex vertices), `parameter` (Float64
/// along the hex edge; 0 at hex vertices), `generator_kind`, `generator_tet`, `generator_corners`
/// as in meshes. Cell arrays: `hex_edge`, and `tet_kind`, `tet`, `tet_corners` for the simplex that
/// the segment lies in.
void writeArcsVtk(const PiecewiseLinearMesh& mesh, const std::filesystem::path& path,
                  Context& context);

/// A polygon per tet or triangle. Point arrays: `point_kind` (UInt8: 0 hex vertex, 1 of an arc, 2
/// of a patch) and `generator_...` as above. Cell arrays: `hex_face`, `tet_kind`, `tet`,
/// `tet_corners`. Field array `corner_uv` (Float64, 2 components): (u, v) of the corners of all
/// polygons, in the order of their connectivity.
void writePatchesVtk(const PiecewiseLinearMesh& mesh, const std::filesystem::path& path,
                     Context& context);

}  // namespace hexhex
