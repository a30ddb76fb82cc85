// Reading and writing files. The extension of the file name determines the format
// (case-insensitive).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/export.h>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Number of volume cells of one type in a file.
struct CellCount {
  std::string name;  ///< "hexahedra", "prisms with 15 nodes"
  std::uint64_t count = 0;
};

/// Straight cells of one kind other than hexahedra.
struct OtherCellList {
  std::size_t corners = 4;           ///< of each cell
  Array<Index> vertices = {};        ///< the corners of all cells, in VTK's order
  Array<std::int32_t> regions = {};  ///< per cell: its region; may be empty

  [[nodiscard]] std::size_t count() const noexcept { return vertices.size() / corners; }
};

/// Cells beside the hexahedra of a HexMesh, with its points.
struct OtherCells {
  std::array<OtherCellList, 3> kinds = {{{4}, {5}, {6}}};  ///< tetrahedra, pyramids, prisms
  std::vector<FeatureFace> triangles = {};                 ///< tagged triangles, if known

  [[nodiscard]] std::size_t count() const noexcept {
    return kinds[0].count() + kinds[1].count() + kinds[2].count();
  }
};

/// Options for readers.
struct ReadOptions {
  /// Name of the format (see fileFormats()), whatever the file's extension. Empty: the format is
  /// that of the extension.
  std::string_view format = {};
  /// Name of the array that holds the map in `.vtu` and `.vtk` files: a cell array with 12
  /// components (u0 v0 w0 u1 ... w3: the parameters of the corners in order) or, for maps with a
  /// single chart, a point array with 3.
  std::string_view mapArray = "igm";
  /// `.hexex` files from other programs list walls of a motorcycle complex, which are not features.
  /// Import interior walls as features with tag 2 anyway: faces between blocks.
  bool keepWalls = false;
  /// Read only the hexahedra of a mesh and skip its other volume cells, whose vertices are kept. By
  /// default, other cells in a hex mesh are an error, as its hexahedra alone would leave holes.
  bool hexesOnly = false;
  /// If not null, receives the types of volume cells in the file, by name. Receives nothing for
  /// `.hexex`, `.ovm`, `.ovmb` and `.pvtu` files, which hold a single type.
  std::vector<CellCount>* cellCounts = nullptr;
  /// If not null, receives tetrahedra, pyramids and prisms with straight edges from a hex mesh,
  /// which are no error then. Only with readHexMesh() and readMapOrHexMesh(), from formats that can
  /// be written with such cells, `.unv`, MFEM and CGNS.
  OtherCells* others = nullptr;
};

/// Reads a tetrahedral mesh with an integer-grid map: `.hexex`, `.ovm`, `.ovmb`, `.vtu`, `.vtk`.
/// @throws Error FileNotFound, FileSyntax (with line), FileUnsupported
[[nodiscard]] TetMap readMap(const std::filesystem::path& file, const ReadOptions& options,
                             Context& context);
[[nodiscard]] TetMap readMap(const std::filesystem::path& file, Context& context);
[[nodiscard]] TetMap readMap(const std::filesystem::path& file);

/// Reads a tetrahedral mesh and ignores its map, if any: the formats above, `.mesh`, `.meshb`,
/// `.msh`, `.inp`, `.unv`, `.exo`, `.e`, and TetGen's `.ele` with its `.node` file.
/// @throws Error  as readMap()
[[nodiscard]] TetMesh readTetMesh(const std::filesystem::path& file, const ReadOptions& options,
                                  Context& context);

/// Combines two meshes of the same tets, as produced by polycube tools, into a map with a single
/// chart: the vertices of the second mesh are the parameters of the first. The corners of a tet may
/// be listed in a different order.
/// @throws Error InvalidArgument if the numbers of vertices or tets differ, or if a tet (the place)
///         has other vertices; IndexOutOfRange
[[nodiscard]] TetMap mapFromPair(const TetMesh& tets, const TetMesh& polycube, Context& context);

/// The same from two files in formats that readTetMesh() reads.
/// @throws Error  as readTetMesh(); FileUnsupported if the files do not belong together
[[nodiscard]] TetMap readMapPair(const std::filesystem::path& tets,
                                 const std::filesystem::path& polycube, Context& context);

/// Location of the labels of a polycube.
struct FlagsFile {
  std::filesystem::path file;
  /// For a text file with one number per triangle: an `.obj` file with the triangles. Its vertices
  /// are matched with those of the tets by position.
  std::filesystem::path surface = {};
  std::string_view array = "flags";  ///< name of the cell array in `.vtu` and `.vtk` files
};

/// Reads the labels of a tet mesh's boundary, see FaceFlags in <hexhex/quantize.hpp>:
/// - text: four numbers per tet, one for the face opposite each corner, -1 where there is no label;
///   or, with a surface, one number per triangle;
/// - `.vtu` and `.vtk`: an integer cell array with one value for each triangle among the cells,
///   whose points are those of the tet mesh.
/// Triangles that are not on the boundary are an error.
/// @return one entry per tet
/// @throws Error FileNotFound, FileSyntax, FileUnsupported if the numbers do not fit the mesh
[[nodiscard]] std::vector<std::array<std::int8_t, 4>> readFlags(const FlagsFile& flags,
                                                                const TetMesh& tets,
                                                                Context& context);

/// Reads a hexahedral mesh: `.mesh` (MEDIT's text, or MFEM's) and `.meshb`, `.vtu`, `.vtk` (legacy
/// VTK, ASCII and binary), `.msh` (Gmsh 1 to 4.1, ASCII and binary), `.ovm`, `.ovmb`, `.inp`
/// (Abaqus), `.unv` (I-deas universal), `.pvtu`, `.vtkhdf`, `.cgns`, `.exo` and `.e` (Exodus II),
/// `.foam` (beside OpenFOAM's constant/polyMesh); each of them also compressed, as in `.msh.gz`.
/// Points, lines, triangles and other sections are ignored; quads may become features. Generators
/// are restored from `.vtu`, `.ovm` and `.ovmb`.
/// @throws Error  as readMap(); FileUnsupported for other volume cells, see ReadOptions::hexesOnly
[[nodiscard]] HexMesh readHexMesh(const std::filesystem::path& file, const ReadOptions& options,
                                  Context& context);
[[nodiscard]] HexMesh readHexMesh(const std::filesystem::path& file, Context& context);
[[nodiscard]] HexMesh readHexMesh(const std::filesystem::path& file);

/// Reads whatever a file holds: a hexahedral mesh or, if it has no hexahedra, a map.
/// @throws Error  as readHexMesh() and readMap()
[[nodiscard]] std::variant<TetMap, HexMesh> readMapOrHexMesh(const std::filesystem::path& file,
                                                             const ReadOptions& options,
                                                             Context& context);

/// How arrays are compressed.
enum class Compression : std::uint8_t {
  None,
  Zlib,  ///< in builds with zlib
  Lz4    ///< ten times as fast, to files a quarter larger; by liblz4, where that is installed
};

/// Options for writers.
struct WriteOptions {
  /// Result of scaledJacobians() for this mesh, if already available. Empty: writers compute it if
  /// their format stores it.
  std::span<const double> scaledJacobians = {};

  /// Name of the format (see fileFormats()), whatever the file's extension, or of the solver that
  /// will read the file (see solverFormats()). Empty: the format is that of the extension.
  std::string_view format = {};

  /// For formats with boundary groups, if no boundary quad is tagged: the maximum angle, in degrees
  /// up to 180, by which the boundary may turn within a group; see boundaryPatches(). 0: a single
  /// group.
  double patchAngle = 40;

  /// Compress the arrays of `.vtu` files. Anything but None is an error for other formats, and
  /// where the library for it is missing.
  Compression compress = Compression::None;

  /// Name of the cell array that holds a map in `.vtu` and `.vtk` files; must not be empty.
  std::string_view mapArray = "igm";

  /// Type of the elements of straight cells in `.inp` files: C3D8 (if empty), C3D8R or C3D8I.
  /// Anything but empty is an error for other formats.
  std::string_view elementType = {};

  /// If not null, writeHexMesh() writes these cells, too: to `.vtu`, `.vtk`, `.vtkhdf`, `.msh`,
  /// `.mesh`, `.meshb`, `.inp`, `.exo` and `.e`. Any are an error for other formats.
  const OtherCells* others = nullptr;
};

/// Writes a map: `.hexex`, `.ovm`, `.ovmb`, and as a cell array `.vtu`, `.vtk`. Numbers in text
/// files have the fewest digits that read back to the same double. The file appears complete or not
/// at all.
/// @throws Error FileUnsupported, FileWrite; InvalidArgument if arrays are inconsistent;
///         IndexOutOfRange, NotFinite
void writeMap(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
              Context& context);
void writeMap(const TetMap& map, const std::filesystem::path& file, Context& context);
void writeMap(const TetMap& map, const std::filesystem::path& file);

/// Writes a hexahedral mesh: `.mesh` (vertices, boundary quads, hexahedra) or `.vtu` (binary
/// appended; cell array `scaled_jacobian`; for meshes with generators, the point arrays
/// `generator_kind` (UInt8), `generator_tet` (UInt32), `generator_corners` (UInt8)). `.vtk` stores
/// vertices, hexahedra, and regions as cell data. `.meshb` and `.mesh` (references), `.msh`
/// (physical groups), `.inp` (node sets, element sets and surfaces) and MFEM files (attributes)
/// also store boundary quads, the tags in mesh.features, and regions. The file appears complete or
/// not at all.
/// @throws Error FileUnsupported, FileWrite; InvalidArgument if arrays are inconsistent or a cell
///         names a vertex that does not exist; NotFinite
void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file,
                  const WriteOptions& options, Context& context);
void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file, Context& context);
void writeHexMesh(const HexMesh& mesh, const std::filesystem::path& file);

/// Opens a file for a mesh that arrives in pieces: `.vtu`, `.mesh`, `.meshb`, `.vtk` or `.msh`
/// (Gmsh 4.1, binary), as written by writeHexMesh() except for the array `scaled_jacobian` and
/// boundary quads. Uses only the format of the options, and a few megabytes of memory. The complete
/// file appears when the sink's end() returns; a sink destroyed earlier leaves nothing behind.
///
/// The sink rejects calls in the wrong order, vertices that do not exist and non-finite
/// coordinates. It accepts both kinds of cells in meshes of any size.
/// @param context  must outlive the sink
/// @throws Error FileUnsupported; FileWrite, here and from the sink
[[nodiscard]] std::unique_ptr<MeshSink> openMeshSink(const std::filesystem::path& file,
                                                     const WriteOptions& options, Context& context);
[[nodiscard]] std::unique_ptr<MeshSink> openMeshSink(const std::filesystem::path& file,
                                                     Context& context);

/// Reads a hexahedral mesh and passes it on in pieces. A `.vtu` file with appended data, as written
/// by this library, takes a few megabytes of memory whatever its size, and includes the generators
/// that it holds; other files are read completely first.
/// @throws Error  as readHexMesh(), and whatever the sink throws
void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, const ReadOptions& options,
                   Context& context);
void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, Context& context);

/// Throw FileUnsupported unless writeHexMesh() or writeMap() supports the file's extension, or the
/// format and the other options, so that unsupported formats are detected before long work.
void requireHexMeshFormat(const std::filesystem::path& file, const WriteOptions& options);
void requireHexMeshFormat(const std::filesystem::path& file, std::string_view format = {});
void requireMapFormat(const std::filesystem::path& file, const WriteOptions& options);

/// Whether writeHexMesh() stores boundary quads in groups in this format, as returned by
/// namedPatches().
/// @throws Error  as requireHexMeshFormat()
[[nodiscard]] bool writesPatches(const std::filesystem::path& file, const WriteOptions& options);

/// A file format and its support in this library.
struct FileFormat {
  std::string_view name;         ///< for ReadOptions and WriteOptions
  std::string_view extension;    ///< including the dot; empty: the format must be requested by name
  std::string_view description;  ///< a few words
  bool readsMaps = false;
  bool writesMaps = false;
  bool readsTets = false;  ///< readTetMesh()
  bool readsHexMeshes = false;
  bool writesHexMeshes = false;
  bool streams = false;        ///< openMeshSink()
  bool compresses = false;     ///< WriteOptions::compress
  bool readsSurfaces = false;  ///< readTriangleMesh(), see <hexhex/fill.hpp>
};

/// All formats of this build. If several share an extension, the first suitable one is the default.
[[nodiscard]] std::span<const FileFormat> fileFormats();

/// A solver for hexahedral meshes and the formats in which it reads meshes from this library.
struct SolverFormat {
  std::string_view name;         ///< for WriteOptions::format: "dealii"
  std::string_view program;      ///< "deal.II"
  std::string_view format;       ///< name of the format for straight cells
  std::string_view extension;    ///< expected by the program, including the dot
  std::string_view curved = {};  ///< format for higher-order cells; empty if there is none
};
/// Sorted by name.
[[nodiscard]] std::span<const SolverFormat> solverFormats() noexcept;
/// Null if there is no solver with this name.
[[nodiscard]] const SolverFormat* findSolver(std::string_view name) noexcept;

}  // namespace HEXHEX_API_NAMESPACE
