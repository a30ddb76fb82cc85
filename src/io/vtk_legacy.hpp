// `.vtk`: legacy VTK. Written in the narrow form that every program reads.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/types.hpp>

namespace hexhex {

/// Reads points and hexahedra (cell type 12) of an unstructured grid, ASCII or binary, of versions
/// 1.0 to 5.1. Other cells and all arrays are ignored.
/// @throws Error FileNotFound, FileSyntax (with line, or byte of a binary file), FileUnsupported,
///         IndexOutOfRange, NotFinite, TooLarge
[[nodiscard]] HexMesh readVtkLegacy(const std::filesystem::path& file, Context& context);

/// The same from memory.
/// @param fileName  for error messages
[[nodiscard]] HexMesh parseVtkLegacy(std::string_view text, const std::string& fileName,
                                     Context& context);

/// Writes points and hexahedra as ASCII of version 2.0, without arrays: HexaLab, OpenFOAM and MFEM
/// read no other form.
/// @throws Error FileWrite
void writeVtkLegacy(const HexMesh& mesh, const std::filesystem::path& file,
                    const WriteOptions& options, Context& context);

}  // namespace hexhex
