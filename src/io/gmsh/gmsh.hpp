// `.msh`: Gmsh. Written as MSH 4.1 (binary or ASCII) and MSH 2.2 (ASCII), with the boundary and all
// features as physical groups.
#pragma once

#include <filesystem>
#include <memory>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <io/core/cell_mesh.hpp>
#include <io/core/input_file.hpp>

namespace hexhex::io {

/// Reads nodes and hexahedra (element type 5) of MSH 1, 2.x, 4.0 and 4.1, ASCII and binary. Other
/// elements and sections are ignored. Vertices are in the order of the file, whatever their tags.
/// @throws Error FileNotFound, FileSyntax (with line, or byte of a binary file), FileUnsupported,
///         IndexOutOfRange, NotFinite, TooLarge
[[nodiscard]] HexMesh readGmsh(const Input& input, Context& context);
/// The same in pieces, of binary files of version 4.1 with one block of nodes, which are numbered
/// from 1, and one of hexahedra; of other files as a whole.
void readGmshTo(MeshSink& sink, const Input& input, Context& context);
/// The same for tetrahedra instead of hexahedra.
[[nodiscard]] TetCells readGmshTets(const Input& input, Context& context);

// Node i has the tag i + 1. Elements are tagged vertices (type 15), tagged edges (type 1), boundary
// and tagged quads (type 3), then all cells (type 5), numbered from 1 in this order. Each group of
// mesh_groups.hpp is an entity (of vertices: each vertex is one) and a physical group, both with
// the group's number; the cells are volume 1, physical group "hexahedra".
/// @throws Error FileWrite; InvalidArgument for features that are not in the mesh
void writeGmsh41Binary(const HexMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context);
void writeGmsh41Text(const HexMesh& mesh, const std::filesystem::path& file,
                     const WriteOptions& options, Context& context);
/// @throws Error  the same, and TooLarge for 2^31 nodes or elements, which MSH 2.2 cannot number
void writeGmsh22Text(const HexMesh& mesh, const std::filesystem::path& file,
                     const WriteOptions& options, Context& context);

/// Writes nodes and hexahedra as writeGmsh41Binary() does, but no boundary.
/// @throws Error FileWrite also for a device or a pipe
[[nodiscard]] std::unique_ptr<MeshSink> openGmsh41BinarySink(const std::filesystem::path& file,
                                                             Context& context);

// Types of elements in files of all versions.
inline constexpr unsigned kGmshLine = 1;
inline constexpr unsigned kGmshQuad = 3;
inline constexpr unsigned kGmshHexahedron = 5;
inline constexpr unsigned kGmshPoint = 15;

}  // namespace hexhex::io
