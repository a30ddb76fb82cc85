// Files. The format follows from the file name's extension (letter case does not matter).
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

namespace hexhex::io {
class OutputFile;
}

namespace hexhex HEXHEX_API_NAMESPACE {

/// Volume cells of one type in a file.
struct CellCount {
  std::string name;  ///< "hexahedra", "prisms with 15 nodes"
  std::uint64_t count = 0;
};

/// What a reader may be told.
struct ReadOptions {
  /// A format by its name (see fileFormats()), whatever the file's extension. Empty: what the
  /// extension means.
  std::string_view format = {};
  /// The name of the array that holds the map in `.vtu` and `.vtk` files: of cells, with 12
  /// components (u0 v0 w0 u1 ... w3: the parameters of the corners in their order), or of points,
  /// with 3, for maps with one chart.
  std::string_view mapArray = "igm";
  /// `.hexex` files of other programs list walls of a motorcycle complex, which are no features.
  /// Those inside of the object become features with the tag 2 all the same: faces between blocks.
  bool keepWalls = false;
  /// Reads the hexahedra among other volume cells, which are left out; the vertices of these stay.
  /// Otherwise a hex mesh with other cells is an error, as its hexahedra alone have holes.
  bool hexesOnly = false;
  /// If not null, receives what types of volume cells the file holds, by name. Of `.hexex`, `.ovm`,
  /// `.ovmb` and `.pvtu` files, which hold one, nothing.
  std::vector<CellCount>* cellCounts = nullptr;
};

/// Reads a tetrahedral mesh with an integer-grid map: `.hexex`, `.ovm`, `.ovmb`, `.vtu`, `.vtk`.
/// @throws Error FileNotFound, FileSyntax (with line), FileUnsupported
[[nodiscard]] TetMap readMap(const std::filesystem::path& file, const ReadOptions& options,
                             Context& context);
[[nodiscard]] TetMap readMap(const std::filesystem::path& file, Context& context);
[[nodiscard]] TetMap readMap(const std::filesystem::path& file);

/// Reads a tetrahedral mesh, without a map, whether there is one or not: the formats above,
/// `.mesh`,
/// `.meshb` and `.msh`.
/// @throws Error  as readMap()
[[nodiscard]] TetMesh readTetMesh(const std::filesystem::path& file, const ReadOptions& options,
                                  Context& context);

/// The map of two meshes of the same tets, as polycube tools deliver it: the vertices of the second
/// one are the parameters of the first one's. There is one chart then. The corners of a tet may be
/// listed in another order.
/// @throws Error InvalidArgument if the numbers of vertices or tets differ, or a tet (the place)
/// has
///         other vertices; IndexOutOfRange
[[nodiscard]] TetMap mapFromPair(const TetMesh& tets, const TetMesh& polycube, Context& context);

/// The same from two files that readTetMesh() reads.
/// @throws Error  as readTetMesh(); FileUnsupported if the two do not belong together
[[nodiscard]] TetMap readMapPair(const std::filesystem::path& tets,
                                 const std::filesystem::path& polycube, Context& context);

/// Where the labels of a polycube are, and how they are found.
struct FlagsFile {
  std::filesystem::path file;
  /// For a text with a number per triangle: the triangles, as an `.obj` file. Its vertices are
  /// those of the tets by their positions.
  std::filesystem::path surface = {};
  std::string_view array = "flags";  ///< name of the cell array in `.vtu` and `.vtk` files
};

/// Reads the labels of a tet mesh's boundary, see FaceFlags in <hexhex/quantize.hpp>:
/// - text: four numbers for each tet, one for the face opposite each corner, -1 where there is
///   none; or, with a surface, a number per triangle;
/// - `.vtu` and `.vtk`: a cell array of whole numbers, one for each triangle among the cells, whose
///   points are those of the tet mesh.
/// Triangles that are not on the boundary are an error.
/// @return per tet
/// @throws Error FileNotFound, FileSyntax, FileUnsupported if the numbers do not fit the mesh
[[nodiscard]] std::vector<std::array<std::int8_t, 4>> readFlags(const FlagsFile& flags,
                                                                const TetMesh& tets,
                                                                Context& context);

/// Reads a hexahedral mesh: `.mesh` and `.meshb` (MEDIT ASCII and binary), `.vtu`, `.vtk` (legacy
/// VTK, ASCII and binary), `.msh` (Gmsh 1 to 4.1, ASCII and binary), `.ovm`, `.ovmb`, `.inp`
/// (Abaqus), `.exo` and `.e` (Exodus II); each of them also compressed, as `.msh.gz`. Points,
/// lines, triangles and other sections are ignored, quads may be features; generators are restored
/// from `.vtu`, `.ovm` and `.ovmb`.
/// @throws Error  as readMap(); FileUnsupported for other volume cells, see ReadOptions::hexesOnly
[[nodiscard]] HexMesh readHexMesh(const std::filesystem::path& file, const ReadOptions& options,
                                  Context& context);
[[nodiscard]] HexMesh readHexMesh(const std::filesystem::path& file, Context& context);
[[nodiscard]] HexMesh readHexMesh(const std::filesystem::path& file);

/// Reads what a file holds: a hexahedral mesh or, where there are no hexahedra, a map.
/// @throws Error  as readHexMesh() and readMap()
[[nodiscard]] std::variant<TetMap, HexMesh> readMapOrHexMesh(const std::filesystem::path& file,
                                                             const ReadOptions& options,
                                                             Context& context);

/// What a writer may be told beside the mesh.
struct WriteOptions {
  /// What scaledJacobians() returned for this mesh, if the caller has it anyway. Empty: computed by
  /// writers whose format holds it.
  std::span<const double> scaledJacobians = {};

  /// A format by its name (see fileFormats()), whatever the file's extension, or a solver that
  /// shall read the file (see solverFormats()). Empty: what the extension means.
  std::string_view format = {};

  /// For formats with groups of boundary quads, if none of them is tagged: the angle in
  /// degrees, up to 180, by which the boundary may turn within a group; see boundaryPatches(). 0:
  /// one group.
  double patchAngle = 40;

  /// Compresses the arrays of `.vtu` files with zlib. Other formats refuse it, and so does a
  /// library that was built without zlib.
  bool compress = false;

  /// The name of the cell array that holds a map in `.vtu` and `.vtk` files; not empty.
  std::string_view mapArray = "igm";
};

/// Writes a map: `.hexex`, `.ovm`, `.ovmb`, and as a cell array `.vtu`, `.vtk`. Each number of a
/// text has the fewest digits that read back to the same double. The file appears complete or not
/// at all.
/// @throws Error FileUnsupported, FileWrite; InvalidArgument if arrays disagree; IndexOutOfRange,
///         NotFinite
void writeMap(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
              Context& context);
void writeMap(const TetMap& map, const std::filesystem::path& file, Context& context);
void writeMap(const TetMap& map, const std::filesystem::path& file);

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

/// Opens a file for a mesh that comes in pieces: `.vtu`, `.mesh`, `.meshb`, `.vtk` or `.msh` (Gmsh
/// 4.1, binary), as writeHexMesh() writes them but without the array `scaled_jacobian` and without
/// boundary quads. Of the options, the format counts. Memory: a few megabytes. The
/// file appears, complete, when the sink's end() returns; a sink that is destroyed before leaves
/// nothing.
///
/// The sink refuses calls in the wrong order, vertices that do not exist and coordinates that are
/// not finite. It takes both kinds of cells in meshes of any size.
/// @param context  outlives the sink
/// @throws Error FileUnsupported; FileWrite, now and later
[[nodiscard]] std::unique_ptr<MeshSink> openMeshSink(const std::filesystem::path& file,
                                                     const WriteOptions& options, Context& context);
[[nodiscard]] std::unique_ptr<MeshSink> openMeshSink(const std::filesystem::path& file,
                                                     Context& context);

/// A text file of the caller's, complete or absent like all that is written here: opened at once,
/// so that what cannot be written shows before long work; without commit() nothing is left of it.
class TextFile {
 public:
  /// @throws Error FileWrite
  explicit TextFile(const std::filesystem::path& file);
  ~TextFile();
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  /// Writes the text and gives the file its name.
  /// @throws Error FileWrite
  void commit(std::string_view text);

 private:
  std::unique_ptr<io::OutputFile> output_;
};

/// Gives a file that is written another name, of its folder, also for the time after a power
/// failure.
/// @throws Error FileWrite
void replaceFile(const std::filesystem::path& finished, const std::filesystem::path& target);

/// Reads a hexahedral mesh and hands it over in pieces. A `.vtu` file with appended data, as this
/// library writes it, takes a few megabytes of memory, however large it is, and hands over the
/// generators that it holds; other files are read as a whole first.
/// @throws Error  as readHexMesh(), and whatever the sink throws
void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, const ReadOptions& options,
                   Context& context);
void readHexMeshTo(MeshSink& sink, const std::filesystem::path& file, Context& context);

/// Throw FileUnsupported unless writeHexMesh() or writeMap() knows the file's extension, or the
/// format of the options, and can do what they say: to fail before long work.
void requireHexMeshFormat(const std::filesystem::path& file, const WriteOptions& options);
void requireHexMeshFormat(const std::filesystem::path& file, std::string_view format = {});
void requireMapFormat(const std::filesystem::path& file, const WriteOptions& options);

/// A file format and what this library does with it.
struct FileFormat {
  std::string_view name;         ///< for ReadOptions and WriteOptions
  std::string_view extension;    ///< with the dot; empty: has to be asked for by name
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

/// All formats of this build. Of several with one extension, the first that fits is what a file
/// name means.
[[nodiscard]] std::span<const FileFormat> fileFormats();

/// A program that computes on hexahedra, and what it reads of what this library writes.
struct SolverFormat {
  std::string_view name;         ///< for WriteOptions::format: "dealii"
  std::string_view program;      ///< "deal.II"
  std::string_view format;       ///< of straight cells: its name
  std::string_view extension;    ///< that the program expects, with the dot
  std::string_view curved = {};  ///< the format of cells of higher order; empty: there is none
};
/// In the order of their names.
[[nodiscard]] std::span<const SolverFormat> solverFormats() noexcept;
/// Null if there is no solver of this name.
[[nodiscard]] const SolverFormat* findSolver(std::string_view name) noexcept;

}  // namespace HEXHEX_API_NAMESPACE
