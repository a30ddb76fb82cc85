// `.cgns`: the CFD General Notation System, in HDF5. Written only, and only by builds with its
// library (HEXHEX_HAS_CGNS).
#pragma once

#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

/// Writes one base with one unstructured zone: a section HEXA_8 for each region, QUAD_4 for each
/// group of boundary quads and tagged quads inside, BAR_2 and NODE for the tags of edges and
/// vertices, named as mesh_groups.hpp says; and a boundary condition, of the type FamilySpecified,
/// for each group of boundary quads. The cells are in order of their regions.
/// @throws Error FileWrite; InvalidArgument for features that are not in the mesh, and for an empty
///         mesh; TooLarge for
///         more elements than the library's integers can number
void writeCgns(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
               Context& context);

}  // namespace hexhex
