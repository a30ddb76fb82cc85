// `.mesh`: MEDIT ASCII. Keywords with sections of numbers, 1-based, each element with a reference
// number that this library writes as 0 (vertices) or 1 and ignores when it reads.
#pragma once

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

/// Reads vertices and hexahedra; other sections and comments ('#') are ignored.
/// @throws Error FileNotFound, FileSyntax, FileUnsupported, IndexOutOfRange, NotFinite, TooLarge
[[nodiscard]] HexMesh readMedit(const std::filesystem::path& file, Context& context);

/// The same from memory.
/// @param fileName  for error messages
[[nodiscard]] HexMesh parseMedit(std::string_view text, const std::string& fileName,
                                 Context& context);

/// The same for tetrahedra instead of hexahedra.
[[nodiscard]] TetCells readMeditTets(const std::filesystem::path& file, Context& context);
[[nodiscard]] TetCells parseMeditTets(std::string_view text, const std::string& fileName,
                                      Context& context);

/// Writes the sections Vertices, Quadrilaterals (the boundary, facing outwards), Hexahedra. Numbers
/// have the fewest digits (at most 17) that read back to the same double.
/// @throws Error FileWrite
void writeMedit(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context);

/// Writes the same as writeMedit() but no section Quadrilaterals: that the boundary is not known
/// before the last cell came.
[[nodiscard]] std::unique_ptr<MeshSink> openMeditSink(const std::filesystem::path& file,
                                                      Context& context);

}  // namespace hexhex
