// MEDIT's formats (Gamma Mesh Format): `.mesh`, text, and `.meshb`, bytes. Sections of vertices and
// elements, which are numbered from 1; each has a reference, which is one integer.
//
// This library writes the numbers of groups (mesh_groups.hpp) as references, 0 where there is no
// tag beside others; and 1 for all quads of a boundary and all cells if none of them has a tag.
// Other programs do likewise. What is read with references that are not all 0 or all 1 has these
// as tags and regions; vertices have tags where the file says that they are corners
// (vertex_tags.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <io/core/cell_mesh.hpp>
#include <io/core/input_file.hpp>

namespace hexhex::io {

/// Reads vertices, hexahedra, edges, quads and corners; other sections and comments ('#') are
/// ignored.
/// @throws Error FileNotFound, FileSyntax, FileUnsupported, IndexOutOfRange, NotFinite, TooLarge
[[nodiscard]] HexMesh readMedit(const Input& input, Context& context);
/// The same of a binary file of version 1 to 4, of which no more than a few kilobytes are in
/// memory.
/// @throws Error  the same, with a byte instead of a line; FileUnsupported also for files of
///         computers with the other byte order
[[nodiscard]] HexMesh readMeshb(const Input& input, Context& context);

/// The same in pieces, of files with one section Vertices in front of one section Hexahedra and
/// without comments; of other files as a whole.
void readMeditTo(MeshSink& sink, const Input& input, Context& context);
void readMeshbTo(MeshSink& sink, const Input& input, Context& context);

/// The same for tetrahedra instead of hexahedra.
[[nodiscard]] TetCells readMeditTets(const Input& input, Context& context);
[[nodiscard]] TetCells readMeshbTets(const Input& input, Context& context);

/// Writes the sections Vertices, Quadrilaterals (the boundary, facing outwards, and tagged quads)
/// and Hexahedra. Numbers have the fewest digits (at most 17) that read back to the same double.
/// Tagged edges stay out: viewers that read no more than what they show stumble over the section.
/// @throws Error FileWrite; InvalidArgument for features that are not in the mesh
void writeMedit(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context);
/// Writes the same sections and tagged edges as bytes. The version is the smallest that holds the
/// file: 2 below 2^31 bytes, 3 (positions of 64 bits) above, 4 (all integers of 64 bits) from 2^31
/// vertices or elements on.
/// @throws Error  the same
void writeMeshb(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context);

// Exposed for tests: a large file is too large for them.
/// The same as a given version, 2 to 4, that must hold the mesh.
void writeMeshbVersion(const HexMesh& mesh, const std::filesystem::path& file,
                       std::uint32_t version, Context& context);

/// Write the same for meshes in pieces, but vertices and hexahedra only: the boundary is not known
/// before the last cell came.
[[nodiscard]] std::unique_ptr<MeshSink> openMeditSink(const std::filesystem::path& file,
                                                      Context& context);
[[nodiscard]] std::unique_ptr<MeshSink> openMeshbSink(const std::filesystem::path& file,
                                                      Context& context);

/// Sections, and their codes in binary files.
enum class MeditSection : std::uint32_t {
  Dimension = 3,
  Vertices = 4,
  Edges = 5,
  Quadrilaterals = 7,
  Tetrahedra = 8,
  Hexahedra = 10,
  Corners = 13,
  RequiredVertices = 15,
  End = 54
};

/// What sections are called in text.
inline constexpr std::array<std::pair<MeditSection, std::string_view>, 9> kMeditKeywords = {
    {{MeditSection::Dimension, "Dimension"},
     {MeditSection::Vertices, "Vertices"},
     {MeditSection::Edges, "Edges"},
     {MeditSection::Quadrilaterals, "Quadrilaterals"},
     {MeditSection::Tetrahedra, "Tetrahedra"},
     {MeditSection::Hexahedra, "Hexahedra"},
     {MeditSection::Corners, "Corners"},
     {MeditSection::RequiredVertices, "RequiredVertices"},
     {MeditSection::End, "End"}}};

}  // namespace hexhex::io
