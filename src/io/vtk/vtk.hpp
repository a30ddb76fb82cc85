// The formats of VTK: `.vtu` and `.vtp` (XML), `.vtk` (legacy) and `.vtkhdf`.
#pragma once

#include <filesystem>
#include <memory>

#include <hexhex/context.hpp>
#include <hexhex/curved.hpp>
#include <hexhex/io.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <io/core/cell_mesh.hpp>
#include <io/core/input_file.hpp>

namespace hexhex::io {

// `.vtu`: an unstructured grid. Data may be appended (raw or base64), inline base64 or ascii, and
// compressed with zlib, if the library was built with it. They are written as raw bytes, appended,
// which ParaView and VTK read without conversion.

/// Reads points and hexahedra (cell type 12), and the generators, tags and regions of writeVtu();
/// other cells and arrays are ignored.
/// @throws Error FileNotFound, FileSyntax, FileUnsupported, IndexOutOfRange, NotFinite
[[nodiscard]] HexMesh readVtu(const Input& input, Context& context);

/// Reads tetrahedra (cell type 10) instead of hexahedra.
[[nodiscard]] TetCells readVtuTets(const Input& input, Context& context);

/// Reads the map of tets from an array, as readVtkMap() finds it.
/// @throws Error as above; FileUnsupported without such an array
[[nodiscard]] TetMap readVtuMap(const Input& input, const ReadOptions& options, Context& context);

/// Reads the same as readVtu(), but hands it over in pieces; with little memory if the file's data
/// are appended and it is no pipe. Then generators, as writeVtu() writes them, are handed over,
/// too.
void readVtuTo(MeshSink& sink, const Input& input, Context& context);

/// Writes points (Float64), hexahedra, the cell array `scaled_jacobian` (Float64) and, if the mesh
/// knows where its vertices came from, the point arrays `generator_kind` (UInt8: 0 vertex, 1 edge,
/// 2 face, 3 cell), `generator_tet` (UInt32) and `generator_corners` (UInt8), as in HexMesh; then
/// tags and regions as addTags() describes them.
/// @throws Error FileWrite
void writeVtu(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
              Context& context);

/// Writes the same as writeVtu() but no array scaled_jacobian: it takes the vertices of all cells.
/// @throws Error FileWrite also for a device or a pipe: arrays are written side by side
[[nodiscard]] std::unique_ptr<MeshSink> openVtuSink(const std::filesystem::path& file,
                                                    Context& context);

/// Writes points, tets, and the map as the cell array WriteOptions::mapArray (Float64, 12
/// components).
/// @throws Error FileWrite; InvalidArgument, IndexOutOfRange, NotFinite
void writeVtuMap(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
                 Context& context);

// Arcs and patches as `.vtu`, or as `.vtp` if the file is named so.

/// A line per segment. Point arrays: `hex_edge` (Int32; -1 at hex vertices), `parameter` (Float64
/// along the hex edge; 0 at hex vertices), `generator_kind`, `generator_tet`, `generator_corners`
/// as in meshes. Cell arrays: `hex_edge`, and `tet_kind`, `tet`, `tet_corners` for the simplex that
/// the segment lies in.
void writeArcsVtk(const PiecewiseLinearMesh& mesh, const std::filesystem::path& path,
                  Context& context);

/// A polygon per tet or triangle. Point arrays: `point_kind` (UInt8: 0 hex vertex, 1 of an arc, 2
/// of a patch) and `generator_...` as above. Cell arrays: `hex_face`, `tet_kind`, `tet`,
/// `tet_corners`. Field array `corner_uv` (Float64, 2 components): (u, v) of the corners of all
/// polygons, in the order of their connectivity.
void writePatchesVtk(const PiecewiseLinearMesh& mesh, const std::filesystem::path& path,
                     Context& context);

// `.vtk`: an unstructured grid, ASCII or binary, of versions 1.0 to 5.1. Written in version 2.0,
// the narrow form that every program reads.

/// Reads points and hexahedra, and regions as writeVtkLegacy() writes them; other cells and arrays
/// are ignored.
/// @throws Error FileNotFound, FileSyntax (with the line), FileUnsupported, IndexOutOfRange,
///         NotFinite, TooLarge
[[nodiscard]] HexMesh readVtkLegacy(const Input& input, Context& context);
/// The same in pieces, of files up to version 4 with nothing but hexahedra; of other files as a
/// whole.
void readVtkLegacyTo(MeshSink& sink, const Input& input, Context& context);

/// The same for tetrahedra and for maps, as of `.vtu`.
[[nodiscard]] TetCells readVtkLegacyTets(const Input& input, Context& context);
[[nodiscard]] TetMap readVtkLegacyMap(const Input& input, const ReadOptions& options,
                                      Context& context);

/// Write points, hexahedra and regions, as ASCII or as bytes, the largest of a number first.
/// HexaLab, OpenFOAM and MFEM read no other form than ASCII.
/// @throws Error FileWrite; TooLarge for 2^31 points as bytes
void writeVtkLegacy(const HexMesh& mesh, const std::filesystem::path& file,
                    const WriteOptions& options, Context& context);
void writeVtkLegacyBinary(const HexMesh& mesh, const std::filesystem::path& file,
                          const WriteOptions& options, Context& context);

/// Write the same, but no regions.
[[nodiscard]] std::unique_ptr<MeshSink> openVtkLegacySink(const std::filesystem::path& file,
                                                          Context& context);
[[nodiscard]] std::unique_ptr<MeshSink> openVtkLegacyBinarySink(const std::filesystem::path& file,
                                                                Context& context);

/// Write points, tets, and the map as the cell array WriteOptions::mapArray.
/// @throws Error FileWrite; InvalidArgument, IndexOutOfRange, NotFinite
void writeVtkLegacyMap(const TetMap& map, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context);
void writeVtkLegacyMapBinary(const TetMap& map, const std::filesystem::path& file,
                             const WriteOptions& options, Context& context);

/// `.vtkhdf`: VTK's format in HDF5, for ParaView from 5.10 on. Written only, and only by builds
/// with HDF5 (HEXHEX_HAS_HDF5): an unstructured grid, version 1.0 of the format, with the same
/// arrays as `.vtu` has.
/// @throws Error FileWrite; InvalidArgument for features with vertices that do not exist
void writeVtkHdf(const HexMesh& mesh, const std::filesystem::path& file,
                 const WriteOptions& options, Context& context);

}  // namespace hexhex::io
