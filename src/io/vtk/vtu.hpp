// `.vtu`: VTK XML unstructured grid. Written with raw binary data appended, which ParaView and VTK
// read without conversion.
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

/// Reads points and hexahedra (cell type 12), and the generators of writeVtu(); other cells and
/// arrays are ignored. Data may be appended (raw or base64), inline base64 or ascii, and compressed
/// with zlib, if the library was built with it.
/// @throws Error FileNotFound, FileSyntax, FileUnsupported, IndexOutOfRange, NotFinite
[[nodiscard]] HexMesh readVtu(const std::filesystem::path& file, Context& context);

/// The same from memory.
/// @param fileName  for error messages
[[nodiscard]] HexMesh parseVtu(std::string_view text, const std::string& fileName,
                               Context& context);

/// The same for tetrahedra instead of hexahedra.
[[nodiscard]] TetCells readVtuTets(const std::filesystem::path& file, Context& context);
[[nodiscard]] TetCells parseVtuTets(std::string_view text, const std::string& fileName,
                                    Context& context);

/// Reads the map of tets from an array, in one of the two forms of grid_map.hpp.
/// @throws Error as above; FileUnsupported without such an array
[[nodiscard]] TetMap readVtuMap(const std::filesystem::path& file, const ReadOptions& options,
                                Context& context);
[[nodiscard]] TetMap parseVtuMap(std::string_view text, const std::string& fileName,
                                 const ReadOptions& options, Context& context);

/// Writes points, tets, and the map as the cell array WriteOptions::mapArray (Float64, 12
/// components).
/// @throws Error FileWrite; InvalidArgument, IndexOutOfRange, NotFinite
void writeVtuMap(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
                 Context& context);

/// Reads the same as readVtu(), but hands it over in pieces; with little memory if the file's data
/// are appended and it is no pipe. Then generators, as writeVtu() writes them, are handed over,
/// too.
void readVtuTo(MeshSink& sink, const std::filesystem::path& path, Context& context);

/// Writes points (Float64), hexahedra, the cell array `scaled_jacobian` (Float64) and, if the mesh
/// knows where its vertices came from, the point arrays `generator_kind` (UInt8: 0 vertex, 1 edge,
/// 2 face, 3 cell), `generator_tet` (UInt32) and `generator_corners` (UInt8), as in HexMesh.
/// @throws Error FileWrite
void writeVtu(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
              Context& context);

/// Writes the same as writeVtu() but no array scaled_jacobian: it takes the vertices of all cells.
/// @throws Error FileWrite also for a device or a pipe: arrays are written side by side
[[nodiscard]] std::unique_ptr<MeshSink> openVtuSink(const std::filesystem::path& file,
                                                    Context& context);

}  // namespace hexhex
