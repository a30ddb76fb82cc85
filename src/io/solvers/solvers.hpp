// Formats of programs for simulations; groups that are written are those of mesh_groups.hpp.
//
// All writers throw Error FileWrite, and InvalidArgument for features that are not in the mesh.
#pragma once

#include <cstdint>
#include <filesystem>

#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

#include <io/core/cell_mesh.hpp>
#include <io/core/input_file.hpp>
#include <io/solvers/element_lists.hpp>

namespace hexhex::io {

/// `.inp`: Abaqus and CalculiX input. Writes nodes and elements of type C3D8, numbered from 1, and
/// for each group of vertices, edges and quads a node set, and for each group of boundary quads an
/// element surface. Names are in upper case: element set HEXAHEDRA, node sets N_BOUNDARY,
/// N_SURFACE_7, N_CURVE_3, N_POINT_1, surfaces S_BOUNDARY, S_SURFACE_7.
///
/// Numbers take at most 20 characters, since programs cut longer ones off: they read back to the
/// same double where 20 characters suffice, which is so for most; others are rounded, to at least
/// 13 significant digits.
void writeAbaqus(const HexMesh& mesh, const std::filesystem::path& file,
                 const WriteOptions& options, Context& context);

/// Reads them: nodes; elements C3D8 and their variants, continuum shells, and hexahedra with 20
/// nodes as curved cells; other volume elements are counted. A region is a set that *ELEMENT or
/// *SOLID SECTION names; an element surface is tagged quads. The tag is what a name of this library
/// says, or the number of the set in its order. *INCLUDE is followed.
/// @throws Error FileNotFound, FileSyntax (with the line), FileUnsupported, IndexOutOfRange,
///         NotFinite, TooLarge
[[nodiscard]] ElementLists readAbaqus(const Input& input, ElementParts parts, Stage& stage);
using AbaqusFormat = ElementFormat<readAbaqus>;

/// `.cgns`: the CFD General Notation System, in HDF5; only in builds with HDF5
/// (HEXHEX_HAS_HDF5). Writes one base with one unstructured zone: a section HEXA_8 for each region,
/// QUAD_4 for each group of boundary quads and tagged quads inside, BAR_2 and NODE for the tags of
/// edges and vertices, named as their groups; and a boundary condition, of the type
/// FamilySpecified, for each group of boundary quads. The cells are in order of their regions.
/// @throws Error  also InvalidArgument for an empty mesh
void writeCgns(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
               Context& context);

/// `.exo`, `.e`: Exodus II, for the codes of Sandia and MOOSE. Writes an element block HEX8 for
/// each region, a side set for each group of boundary quads, and node sets for the tags of edges
/// and vertices; sets and blocks are named as their groups. Side sets and blocks have the numbers
/// of their groups. Tagged quads inside the mesh are left out. The cells are in order of their
/// regions.
///
/// NetCDF's classic format with 64-bit offsets; its newest variant, with 64-bit sizes, for meshes
/// that need it.
/// @param mostBytes  of an array before that: 4 GB, and less in tests
/// @throws Error  also TooLarge for more than 2^31 - 1 vertices or cells
void writeExodus(const HexMesh& mesh, const std::filesystem::path& file,
                 const WriteOptions& options, Context& context,
                 std::uint64_t mostBytes = 0xffff'fff0);

/// Reads them, in any of NetCDF's classic layouts: blocks are regions, side sets tagged quads, node
/// sets as hexMeshOf() has them. The tag is what a name of this library says, or the ID. Hexahedra
/// with 20 and 27 nodes are curved cells; other volume elements are counted.
/// @throws Error FileNotFound, FileSyntax (with the byte), FileUnsupported, IndexOutOfRange,
///         NotFinite, TooLarge
[[nodiscard]] ElementLists readExodus(const Input& input, ElementParts parts, Stage& stage);
using ExodusFormat = ElementFormat<readExodus>;

/// MFEM mesh v1.0, only by the name of the format, since MFEM's files have the extension of
/// MEDIT's. Writes cells (attribute 1), boundary quads and tagged quads inside (attribute: the
/// number of their group), and vertices. Numbers have the fewest digits (at most 17) that read back
/// to the same double.
void writeMfem(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
               Context& context);

/// OpenFOAM's `polyMesh`, a folder of text files. Writes points, faces, owner, neighbour and
/// boundary: inner faces in upper-triangular order, then a patch for each group of boundary quads,
/// named as the group; and a cell zone for each region. Numbers have the fewest digits (at most 17)
/// that read back to the same double. Tagged vertices, edges and quads inside the mesh are left
/// out.
/// @param file  `CASE/X.foam`, which becomes an empty file, as ParaView opens it, next to
///              `CASE/constant/polyMesh`; or the name of the folder `polyMesh` itself. Folders are
///              created. `polyMesh` is replaced as a whole, in one step; what else was in it is in
///              the new one, too.
/// @throws Error  also InvalidArgument for faces of more than two cells, and TooLarge for more than
///         2^31 - 1 vertices, faces or cells
void writeOpenFoam(const HexMesh& mesh, const std::filesystem::path& file,
                   const WriteOptions& options, Context& context);

}  // namespace hexhex::io
