// `.vtk`: legacy VTK. Written in the narrow form that every program reads.
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

/// Reads points and hexahedra (cell type 12) of an unstructured grid, ASCII or binary, of versions
/// 1.0 to 5.1. Other cells and all arrays are ignored.
/// @throws Error FileNotFound, FileSyntax (with line, or byte of a binary file), FileUnsupported,
///         IndexOutOfRange, NotFinite, TooLarge
[[nodiscard]] HexMesh readVtkLegacy(const std::filesystem::path& file, Context& context);

/// The same from memory.
/// @param fileName  for error messages
[[nodiscard]] HexMesh parseVtkLegacy(std::string_view text, const std::string& fileName,
                                     Context& context);

/// The same for tetrahedra instead of hexahedra.
[[nodiscard]] TetCells readVtkLegacyTets(const std::filesystem::path& file, Context& context);
[[nodiscard]] TetCells parseVtkLegacyTets(std::string_view text, const std::string& fileName,
                                          Context& context);

/// Reads the map of tets from an array, in one of the two forms of grid_map.hpp.
/// @throws Error as above; FileUnsupported without such an array
[[nodiscard]] TetMap readVtkLegacyMap(const std::filesystem::path& file, const ReadOptions& options,
                                      Context& context);
[[nodiscard]] TetMap parseVtkLegacyMap(std::string_view text, const std::string& fileName,
                                       const ReadOptions& options, Context& context);

/// Write points, tets, and the map as the cell array WriteOptions::mapArray, as ASCII or as bytes
/// of version 2.0.
/// @throws Error FileWrite; InvalidArgument, IndexOutOfRange, NotFinite
void writeVtkLegacyMap(const TetMap& map, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context);
void writeVtkLegacyMapBinary(const TetMap& map, const std::filesystem::path& file,
                             const WriteOptions& options, Context& context);

/// Writes points and hexahedra as ASCII of version 2.0, without arrays: HexaLab, OpenFOAM and MFEM
/// read no other form.
/// @throws Error FileWrite
void writeVtkLegacy(const HexMesh& mesh, const std::filesystem::path& file,
                    const WriteOptions& options, Context& context);

/// The same as bytes, the largest of a number first.
/// @throws Error FileWrite; TooLarge for 2^31 points
void writeVtkLegacyBinary(const HexMesh& mesh, const std::filesystem::path& file,
                          const WriteOptions& options, Context& context);

/// Write the same as writeVtkLegacy() and writeVtkLegacyBinary().
[[nodiscard]] std::unique_ptr<MeshSink> openVtkLegacySink(const std::filesystem::path& file,
                                                          Context& context);
[[nodiscard]] std::unique_ptr<MeshSink> openVtkLegacyBinarySink(const std::filesystem::path& file,
                                                                Context& context);

}  // namespace hexhex
