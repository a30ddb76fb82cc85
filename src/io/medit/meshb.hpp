// `.meshb`: the binary form of MEDIT's format (Gamma Mesh Format).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <io/core/cell_mesh.hpp>

namespace hexhex {

/// Reads vertices and hexahedra of versions 1 to 4; other sections and references are ignored.
/// @throws Error FileNotFound, FileSyntax (with byte), FileUnsupported (also files of computers
/// with
///         the other byte order), IndexOutOfRange, NotFinite, TooLarge
[[nodiscard]] HexMesh readMeshb(const std::filesystem::path& file, Context& context);

/// The same from memory.
/// @param fileName  for error messages
[[nodiscard]] HexMesh parseMeshb(std::string_view text, const std::string& fileName,
                                 Context& context);

/// The same for tetrahedra instead of hexahedra.
[[nodiscard]] TetCells readMeshbTets(const std::filesystem::path& file, Context& context);
[[nodiscard]] TetCells parseMeshbTets(std::string_view text, const std::string& fileName,
                                      Context& context);

/// Writes the sections Vertices, Edges (tagged ones), Quadrilaterals (the boundary, facing
/// outwards, and tagged quads), Hexahedra. References are the numbers of groups of mesh_groups.hpp:
/// 0 for vertices without a tag; 1 for cells. The version is the smallest that holds the file: 2
/// below 2^31 bytes, 3 (positions of 64 bits) above, 4 (all integers of 64 bits) from 2^31 vertices
/// or elements on.
/// @throws Error FileWrite; InvalidArgument for features that are not in the mesh
void writeMeshb(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context);

// Exposed for tests: a large file is too large for them.
/// The same as a given version, 2 to 4, that must hold the mesh.
void writeMeshbVersion(const HexMesh& mesh, const std::filesystem::path& file,
                       std::uint32_t version, Context& context);

/// Codes of sections.
enum class MeshbKeyword : std::uint32_t {
  Dimension = 3,
  Vertices = 4,
  Edges = 5,
  Quadrilaterals = 7,
  Hexahedra = 10,
  End = 54
};

/// Writes vertices and hexahedra as writeMeshb() does, but no boundary.
[[nodiscard]] std::unique_ptr<MeshSink> openMeshbSink(const std::filesystem::path& file,
                                                      Context& context);

}  // namespace hexhex
