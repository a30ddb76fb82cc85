// VTK data sets for reading: points, cells and named arrays, independent of where and how the file
// stores them. Formats fill them in; vtk_reader.cpp builds meshes from them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/features.hpp>
#include <hexhex/fill.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/input_file.hpp>
#include <io/core/number_source.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>
#include <io/formats/vtk_data_set.hpp>

namespace hexhex::io {

/// The number types that can be read, as a zero of the type.
using VtkScalar =
    std::variant<double, float, std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
                 std::int32_t, std::uint32_t, std::int64_t, std::uint64_t>;

template <class T>
[[nodiscard]] constexpr bool isOf(const VtkScalar& scalar) noexcept {
  return std::holds_alternative<T>(scalar);
}
[[nodiscard]] std::size_t bytesOf(const VtkScalar& scalar);

/// The kind of numbers requested. Of others, only characters are ever requested.
enum class VtkNumbers : std::uint8_t { Integers, Reals, Others };

/// The location and encoding of an array's numbers.
struct VtkColumn {
  VtkScalar scalar = {};
  bool bigEndian = false;  ///< big-endian; otherwise native byte order
  std::uint64_t count = 0;
  std::uint64_t position = 0;  ///< in the file, or in `decoded`
  Array<char> decoded = {};    ///< data that the file does not store as plain binary
  /// Returns number i of a column that the file implies; otherwise null.
  std::function<double(std::uint64_t i)> compute = {};
};

/// Points or indices along the axes of a grid.
using GridIndex = std::array<std::uint64_t, 3>;

/// An array of a file.
struct VtkSourceArray {
  VtkSection section = VtkSection::FieldData;
  std::string name;
  VtkNumbers numbers = VtkNumbers::Others;
  std::size_t components = 1;
  bool appended = false;  ///< after the header of an XML file, as this library writes arrays
  /// Locates the numbers, which must be of this kind and, if given, as many as `count`.
  std::function<VtkColumn(VtkNumbers, std::optional<std::uint64_t> count)> load = {};
};

/// The bytes of a file: all in memory, or only its header.
struct VtkFileBytes {
  std::unique_ptr<InputFile> file;  ///< for the rest; null: everything is in `text`
  Array<char> room;                 ///< storage of `text`, unless it was in memory before
  std::string_view text;            ///< the bytes in memory
};

/// An open file.
class VtkSource {
 public:
  VtkSource(VtkFileBytes content, std::string fileName)
      : content_(std::move(content)),
        fileName_(std::move(fileName)),
        bytes_(content_.file ? ByteFile(*content_.file, fileName_)
                             : ByteFile(content_.text, fileName_)) {}
  virtual ~VtkSource() = default;
  // Arrays refer to the file.
  VtkSource(const VtkSource&) = delete;
  VtkSource& operator=(const VtkSource&) = delete;

  std::uint64_t points = 0;
  std::uint64_t cells = 0;
  VtkColumn coordinates;
  VtkColumn types;
  /// Where cells end in `connectivity`; or, with one number more, where they begin and the last
  /// ends.
  VtkColumn offsets;
  /// Numbers per cell in `connectivity`, if all cells have as many and there are no offsets.
  std::size_t stride = 0;
  VtkColumn connectivity;
  std::size_t gap = 0;  ///< numbers in `connectivity` before the corners of each cell
  VtkEdges uprightEdges = VtkEdges::Around;  ///< of Lagrange cells
  bool isSurface = false;                    ///< whether the data set is one of polygons

  std::shared_ptr<CellCounts> counts;  ///< of the input
  OtherCells* others = nullptr;        ///< where the input wants other cells

  std::vector<VtkSourceArray> arrays;
  /// Arrays of points and cells, for messages: the names of the first ones, and how many more.
  std::vector<std::string> seen;
  std::size_t unnamed = 0;

  /// Reads on for more arrays; false if all are known.
  virtual bool readOn() { return false; }
  /// Throws TooLarge if there are more points or cells than an Index can number.
  virtual void requireIndexable() const {}

  /// The first array of a section with this name and form; null if there is none.
  /// @param begin  index of the array to start from
  [[nodiscard]] const VtkSourceArray* find(VtkSection section, std::string_view name,
                                           std::size_t components, VtkNumbers numbers,
                                           std::size_t begin = 0) const;
  /// The numbers of an array; one tuple per point or cell, if it belongs to these.
  [[nodiscard]] VtkColumn load(const VtkSourceArray& array) const;

  /// Copies numbers [begin, begin + count) of a column. T is double, std::int64_t, or the type of
  /// the column. Thread-safe.
  template <class T>
  void copy(const VtkColumn& column, std::uint64_t begin, std::size_t count, T* to) const;

  /// Of the file, for messages.
  [[nodiscard]] const std::string& name() const noexcept { return fileName_; }
  /// Throws an error about the file.
  /// @param sentence  its parts, as for concat()
  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Parts... sentence) const {
    fail(code, Place{}, sentence...);
  }
  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Place place, Parts... sentence) const {
    throw Error(code, concat(fileName_, ": ", sentence...), place);
  }

 protected:
  /// Records the name of a point or cell array, for messages.
  void see(std::string_view name, bool ofCells, std::size_t components);

  /// Makes the points and cells of a structured grid.
  /// @param size      points along each axis
  /// @param place     coordinate `axis` of a point; null: the points are given
  /// @param dataSize  bytes of the file, uncompressed: bounds grids whose cells have no data
  /// @throws Error FileUnsupported for a single layer of points; TooLarge
  void makeGrid(const GridIndex& size, std::uint64_t dataSize,
                const std::function<double(std::size_t axis, const GridIndex& point)>& place);
  /// Makes all cells polygons.
  void makePolygons();

  [[nodiscard]] std::string_view text() const noexcept { return content_.text; }
  [[nodiscard]] std::uint64_t fileSize() const noexcept { return bytes_.size(); }

 private:
  VtkFileBytes content_;
  std::string fileName_;
  ByteFile bytes_;
};

/// Opens a `.vtu`, `.vts`, `.vtr`, `.vti` or `.vtp` file, loading only its header if the arrays are
/// appended raw. Every size and offset is checked against the file.
/// @param input, stage  must outlive the source
/// @throws Error FileSyntax, FileUnsupported, NotFinite
[[nodiscard]] std::unique_ptr<VtkSource> openVtuFile(const Input& input, Stage& stage);

/// Opens a legacy `.vtk` file and reads up to the first array after the sections of a mesh. Offers
/// numeric arrays that follow the mesh, and the regions of cells.
/// @param withRegions  whether to read the regions of cells, with all arrays unless they follow as
///                     this library writes them
/// @throws Error FileSyntax, FileUnsupported, NotFinite or TooLarge, with the line
[[nodiscard]] std::unique_ptr<VtkSource> openVtkLegacyFile(const Input& input, bool withRegions,
                                                           Stage& stage);

/// A column for `count` numbers of a text, to be filled by readVtkNumber().
[[nodiscard]] VtkColumn textColumn(VtkNumbers numbers, std::size_t count);

/// Parses a number of a text into position i of a column.
inline void readVtkNumber(TextScanner& scanner, VtkNumbers numbers, VtkColumn& column,
                          std::size_t i, const NumberName& name) {
  const auto set = [place = column.decoded.data() + i * sizeof(double)](auto number) {
    std::memcpy(place, &number, sizeof(number));
  };
  if (numbers == VtkNumbers::Reals) return set(scanner.number(name));
  set(scanner.integer(name));
}

// Meshes and maps from data sets, for all formats: selects cells and arrays, and reports errors.

/// Reads points from index `first` on; or all points, with all threads.
/// @throws Error NotFinite
void readVtkPoints(const VtkSource& source, std::uint64_t first, std::span<Vec3> points);
void readVtkPoints(const VtkSource& source, std::span<Vec3> points, Stage& stage);

/// The number of wanted cells among `count` cells from index `first` on.
[[nodiscard]] std::size_t countVtkCells(const VtkSource& source, const CellKind& cells,
                                        std::uint64_t first, std::size_t count);

/// Reads the wanted cells among `count` cells from index `first` on.
/// @tparam Vertex   Index or std::uint64_t
/// @param vertices  room for the corners of countVtkCells() cells
/// @param numbers   if not null, room for the indices of these cells in the file
/// @throws Error FileSyntax, IndexOutOfRange
template <class Vertex>
void readVtkCells(const VtkSource& source, const CellKind& cells, std::uint64_t first,
                  std::size_t count, Vertex* vertices, std::size_t* numbers = nullptr);

/// Reads all wanted cells, with all threads.
/// @param makeRoom  called with their number; returns the destination of their corners
/// @param[out] numbers  if not null: their indices in the file
/// @param areOthers  whether they are beside the cells that the file is read for: not counted, and
///                   there may be none
/// @throws Error the same; FileUnsupported if all cells are of other kinds
void readVtkCells(const VtkSource& source, const CellKind& cells,
                  const std::function<Index*(std::size_t)>& makeRoom, Array<std::size_t>* numbers,
                  Stage& stage, bool areOthers = false);

/// Counts the cells of each type.
/// @param count  of the wanted ones
void noteVtkCells(const VtkSource& source, const CellKind& cells, std::uint64_t count);

/// Per cell (+1): where its numbers begin in `connectivity`, as the file says.
[[nodiscard]] Array<std::int64_t> vtkCellPlaces(const VtkSource& source, std::uint64_t first,
                                                std::size_t count);

/// Throws the error for a file with cells, but no wanted ones.
[[noreturn]] void failWithoutVtkCells(const VtkSource& source, const CellKind& cells);

/// The simplices that points were generated on, in two arrays as this library writes them.
struct VtkGenerators {
  std::optional<VtkColumn> tets;
  std::optional<VtkColumn> corners;
};
[[nodiscard]] VtkGenerators findVtkGenerators(const VtkSource& source);
/// Reads both arrays; empty if arrays of their names have another form.
void readVtkGenerators(const VtkSource& source, Array<Index>& tets, Array<CornerSet>& corners);

/// Reads tags and regions as addTags() writes them. Arrays of other forms belong to other programs
/// and are ignored.
/// @throws Error FileSyntax if an array has the wrong size; FileUnsupported for a tag or region
/// that
///         does not fit in 32 bits; IndexOutOfRange for a vertex that is not a point
[[nodiscard]] HexFeatures readVtkHexFeatures(const VtkSource& source);
[[nodiscard]] Features readVtkTetFeatures(const VtkSource& source);
[[nodiscard]] bool hasVtkRegions(const VtkSource& source);
/// @param cells  indices of the wanted cells, ascending
[[nodiscard]] Array<std::int32_t> readVtkRegions(const VtkSource& source,
                                                 std::span<const std::size_t> cells);

/// Reads points, hexahedra, and the arrays that writers of this library add.
[[nodiscard]] HexMesh readVtkHexMesh(const VtkSource& source, Stage& stage);
/// For each point, the first one at exactly the same position.
/// @param coordinates  three per point
/// @param firstPoints  the first point of each piece. If a piece has several points at a position,
///                     their counterparts in other pieces are unknown, so none there is merged
/// @param[out] ambiguous  such a point that other pieces have, too; unchanged if there is none
[[nodiscard]] Array<std::size_t> firstsAtSamePosition(std::span<const double> coordinates,
                                                      const std::vector<std::size_t>& firstPoints,
                                                      std::size_t* ambiguous = nullptr);

/// A mesh joined from pieces.
struct GluedMesh {
  HexMesh mesh;
  bool numbered = false;  ///< whether points and cells are numbered by the pieces' global numbers
};
using OpenVtkPiece = std::function<std::unique_ptr<VtkSource>(std::size_t piece)>;
/// Reads pieces in sequence and joins them.
/// @param name  of the whole, for messages
/// @throws Error FileSyntax if global numbers are inconsistent or, without these, if positions are
///         ambiguous
[[nodiscard]] GluedMesh readVtkPieces(const std::string& name, std::size_t count,
                                      const OpenVtkPiece& open, Stage& stage);

/// Whether there are Lagrange hexahedra, or hexahedra with 20 or 27 nodes but no straight ones.
[[nodiscard]] bool holdsVtkLagrange(const VtkSource& source);
[[nodiscard]] LagrangeMesh readVtkLagrange(const VtkSource& source, Stage& stage);

/// Reads points and polygons.
/// @throws Error FileUnsupported if the data set is no surface; IndexOutOfRange
[[nodiscard]] TriangleMesh readVtkSurface(const VtkSource& source, Stage& stage);

/// Reads points and tets.
[[nodiscard]] TetCells readVtkTets(VtkSource& source, Stage& stage);
/// Reads tets and their map from a floating-point array. A cell array has 12 components,
/// u0 v0 w0 u1 v1 w1 u2 v2 w2 u3 v3 w3, the parameters of a tet's corners in order; a point array
/// has 3, u v w, for maps with a single chart.
/// @param mapArray  name of the array
/// @throws Error FileUnsupported if there is no such array; NotFinite
[[nodiscard]] TetMap readVtkMap(VtkSource& source, std::string_view mapArray, Stage& stage);

/// Reads triangles with an integer label each.
/// @param name  of the cell array
[[nodiscard]] TriangleLabels readVtkLabels(VtkSource& source, std::string_view name, Stage& stage);

}  // namespace hexhex::io
