// `.vtkhdf`: VTK's format in HDF5, for ParaView from 5.10 on. Written only, and only by builds with
// HDF5 (HEXHEX_HAS_HDF5).
#pragma once

#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

/// Writes an unstructured grid, version 1.0 of the format, with the same arrays as `.vtu` has:
/// generators, `scaled_jacobian`, `region`, `feature_vertex`, and the field arrays `feature_edges`
/// (two vertices and the tag) and `feature_quads` (four and the tag).
/// @throws Error FileWrite; InvalidArgument for features with vertices that do not exist
void writeVtkHdf(const HexMesh& mesh, const std::filesystem::path& file,
                 const WriteOptions& options, Context& context);

}  // namespace hexhex
