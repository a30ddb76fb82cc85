// Files. The format follows from the file name's extension (letter case does not matter).
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Reads a tetrahedral mesh with an integer-grid map: `.hexex`.
/// @throws Error FileNotFound, FileSyntax (with line), FileUnsupported
[[nodiscard]] TetMap readMap(const std::filesystem::path& file, Context& context);
[[nodiscard]] TetMap readMap(const std::filesystem::path& file);

/// Writes a map: `.hexex`. Each number has the fewest digits that read back to the same double.
/// The file appears complete or not at all.
void writeMap(const TetMap& map, const std::filesystem::path& file, Context& context);
void writeMap(const TetMap& map, const std::filesystem::path& file);

/// Reads a hexahedral mesh: `.mesh` and `.meshb` (MEDIT ASCII and binary), `.vtu` (as this library
/// writes it), `.vtk` (legacy VTK, ASCII and binary), `.msh` (Gmsh 4.1 and 2.x, ASCII and binary),
/// `.ovm`, `.ovmb`. Other cells and sections are ignored; generators are not restored.
[[nodiscard]] HexMesh readHexMesh(const std::filesystem::path& file, Context& context);
[[nodiscard]] HexMesh readHexMesh(const std::filesystem::path& file);

/// What a writer may be told beside the mesh.
struct WriteOptions {
  /// What scaledJacobians() returned for this mesh, if the caller has it anyway. Empty: computed by
  /// writers whose format holds it.
  std::span<const double> scaledJacobians = {};

  /// A format by its name, whatever the file's extension: "mesh", "vtu", "ovm", "ovmb", "meshb",
  /// "vtk", "msh" (Gmsh 4.1, binary), "msh41-ascii", "msh22-ascii", "inp", "mfem". Empty: what the
  /// extension means.
  std::string_view format = {};

  /// For formats with groups of boundary quads, if no quad of the mesh is tagged: the angle in
  /// degrees, up to 180, by which the boundary may turn within a group; see boundaryPatches(). 0:
  /// one group.
  double patchAngle = 40;
};

/// Writes a hexahedral mesh: `.mesh` (vertices, boundary quads, hexahedra) or `.vtu` (binary
/// appended; cell array `scaled_jacobian`; for meshes that know where their vertices came from, the
/// point arrays `generator_kind` (UInt8), `generator_tet` (UInt32), `generator_corners` (UInt8)).
/// `.vtk` holds vertices and hexahedra, and regions as cell data. `.meshb` and `.mesh`
/// (references),
/// `.msh` (physical groups), `.inp` (node sets, element sets and surfaces) and MFEM's files
/// (attributes) also hold boundary quads, what mesh.features tags, and regions.
/// The file appears complete or not at all.
/// @throws Error FileUnsupported, FileWrite; InvalidArgument if arrays disagree or a cell names a
///         vertex that does not exist; NotFinite
void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file,
                  const WriteOptions& options, Context& context);
void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file, Context& context);
void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file);

/// Opens a file for a mesh that comes in pieces: `.vtu` or `.mesh`, as writeHexMesh() writes them
/// but without the array `scaled_jacobian` and without boundary quads. Memory: a few megabytes. The
/// file appears, complete, when the sink's end() returns; a sink that is destroyed before leaves
/// nothing.
///
/// The sink refuses calls in the wrong order, vertices that do not exist and coordinates that are
/// not finite. It takes both kinds of cells in meshes of any size.
/// @param context  outlives the sink
/// @throws Error FileUnsupported; FileWrite, now and later
[[nodiscard]] std::unique_ptr<MeshSink> openMeshSink(const std::filesystem::path& file,
                                                     Context& context);

/// Reads a hexahedral mesh and hands it over in pieces. A `.vtu` file with appended data, as this
/// library writes it, takes a few megabytes of memory, however large it is, and hands over the
/// generators that it holds; other files are read as a whole first.
/// @throws Error  as readHexMesh(), and whatever the sink throws
void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, Context& context);

/// Throws FileUnsupported unless writeHexMesh knows the extension, or the format, if it is not
/// empty: to fail before long work.
void requireHexMeshFormat(const std::filesystem::path& file, std::string_view format = {});

}  // namespace HEXHEX_API_NAMESPACE
