// A data set of VTK as those who read one see it: points, cells and named arrays, wherever their
// numbers are and however they are stored. Formats fill it in; vtk_reader.cpp makes meshes of it.
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

/// The number types that are read: a zero of the type.
using VtkScalar =
    std::variant<double, float, std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
                 std::int32_t, std::uint32_t, std::int64_t, std::uint64_t>;

template <class T>
[[nodiscard]] constexpr bool isOf(const VtkScalar& scalar) noexcept {
  return std::holds_alternative<T>(scalar);
}
[[nodiscard]] std::size_t bytesOf(const VtkScalar& scalar);

/// What numbers are needed as. Of others, only characters are ever needed.
enum class VtkNumbers : std::uint8_t { Integers, Reals, Others };

/// Where the numbers of an array are, and how they are stored.
struct VtkColumn {
  VtkScalar scalar = {};
  bool bigEndian = false;  ///< the largest byte first; otherwise in this machine's order
  std::uint64_t count = 0;
  std::uint64_t position = 0;  ///< in the file, or in `decoded`
  Array<char> decoded = {};    ///< what the file does not hold as plain bytes
};

/// An array of a file.
struct VtkSourceArray {
  VtkSection section = VtkSection::FieldData;
  std::string name;
  VtkNumbers numbers = VtkNumbers::Others;
  std::size_t components = 1;
  bool appended = false;  ///< to the head of an XML file, as this library writes arrays
  /// Finds the numbers; they must be of this kind and, if a count is given, that many.
  std::function<VtkColumn(VtkNumbers, std::optional<std::uint64_t> count)> load = {};
};

/// The bytes of a file: all of them in memory, or its head only.
struct VtkFileBytes {
  std::unique_ptr<InputFile> file;  ///< where the rest is; null: nowhere else
  Array<char> room;                 ///< for `text`, unless that was in memory before
  std::string_view text;            ///< what is in memory
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
  /// Where cells end in `connectivity`; or one number more: where they begin and the last one ends.
  VtkColumn offsets;
  /// How many numbers of `connectivity` each cell has, if all have as many and no offsets say it.
  std::size_t stride = 0;
  VtkColumn connectivity;
  std::size_t gap = 0;  ///< how many numbers stand in `connectivity` in front of a cell's corners
  VtkEdges uprightEdges = VtkEdges::Around;  ///< of Lagrange cells

  std::shared_ptr<CellCounts> counts;  ///< of the input

  std::vector<VtkSourceArray> arrays;
  /// Arrays of points and cells, for messages: the first of them, and how many more there are.
  std::vector<std::string> seen;
  std::size_t unnamed = 0;

  /// Goes on to more arrays; false if all are known.
  virtual bool readOn() { return false; }
  /// Throws TooLarge if points or cells are more than an Index can count.
  virtual void requireIndexable() const {}

  /// The first array of a section with this name and form; null if there is none.
  /// @param begin  how many arrays are passed over
  [[nodiscard]] const VtkSourceArray* find(VtkSection section, std::string_view name,
                                           std::size_t components, VtkNumbers numbers,
                                           std::size_t begin = 0) const;
  /// Its numbers: a tuple for each point or cell, if it belongs to them.
  [[nodiscard]] VtkColumn load(const VtkSourceArray& array) const;

  /// Copies numbers [begin, begin + count) of a column. T is double, std::int64_t, or the very type
  /// of the column. Thread-safe.
  template <class T>
  void copy(const VtkColumn& column, std::uint64_t begin, std::size_t count, T* to) const;

  /// Throws an error about the file.
  /// @param sentence  its parts, as of concat()
  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Parts... sentence) const {
    fail(code, Place{}, sentence...);
  }
  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Place place, Parts... sentence) const {
    throw Error(code, concat(fileName_, ": ", sentence...), place);
  }

 protected:
  /// Notes an array of points or cells for messages.
  void see(std::string_view name, bool ofCells, std::size_t components);

  [[nodiscard]] std::string_view text() const noexcept { return content_.text; }
  [[nodiscard]] std::uint64_t fileSize() const noexcept { return bytes_.size(); }

 private:
  VtkFileBytes content_;
  std::string fileName_;
  ByteFile bytes_;
};

/// Opens a `.vtu` file, without the whole of it in memory if its arrays are appended as plain
/// bytes. Every size and offset is checked against the file.
/// @param input, stage  outlive the source
/// @throws Error FileSyntax, FileUnsupported, NotFinite
[[nodiscard]] std::unique_ptr<VtkSource> openVtuFile(const Input& input, Stage& stage);

/// Opens a legacy `.vtk` file, and reads as far as the first array behind the sections of a mesh.
/// Of arrays, those of numbers are offered that come behind the mesh, and the regions of cells.
/// @param withRegions  reads the regions of cells if they follow as this library writes them
/// @throws Error FileSyntax, FileUnsupported, NotFinite or TooLarge, with the line
[[nodiscard]] std::unique_ptr<VtkSource> openVtkLegacyFile(const Input& input, bool withRegions,
                                                           Stage& stage);

/// A column for `count` numbers of text, to be filled in by readVtkNumber().
[[nodiscard]] VtkColumn textColumn(VtkNumbers numbers, std::size_t count);

/// Reads a number that is text, as number i of a column.
void readVtkNumber(TextScanner& scanner, VtkNumbers numbers, VtkColumn& column, std::size_t i,
                   const NumberName& name);

// Meshes and maps from the data sets of vtk_source.hpp: which cells and arrays they are made of,
// and what is wrong with them, whatever the format.

/// Reads points from number `first` on; or all, with all threads.
/// @throws Error NotFinite
void readVtkPoints(const VtkSource& source, std::uint64_t first, std::span<Vec3> points);
void readVtkPoints(const VtkSource& source, std::span<Vec3> points, Stage& stage);

/// Number of wanted cells among `count` cells from number `first` on.
[[nodiscard]] std::size_t countVtkCells(const VtkSource& source, const CellKind& cells,
                                        std::uint64_t first, std::size_t count);

/// Reads the wanted cells among `count` cells from number `first` on.
/// @tparam Vertex   Index or std::uint64_t
/// @param vertices  room for the corners of as many cells as countVtkCells() says
/// @param numbers   if not null, room for as many: which cells of the file they are
/// @throws Error FileSyntax, IndexOutOfRange
template <class Vertex>
void readVtkCells(const VtkSource& source, const CellKind& cells, std::uint64_t first,
                  std::size_t count, Vertex* vertices, std::size_t* numbers = nullptr);

/// Reads all wanted cells, with all threads.
/// @param makeRoom  called with their number; returns where their corners go
/// @param[out] numbers  if not null: which cells of the file they are
/// @throws Error the same; FileUnsupported if there are only others
void readVtkCells(const VtkSource& source, const CellKind& cells,
                  const std::function<Index*(std::size_t)>& makeRoom, Array<std::size_t>* numbers,
                  Stage& stage);

/// Notes what types of cells there are.
/// @param count  of the wanted ones
void noteVtkCells(const VtkSource& source, const CellKind& cells, std::uint64_t count);

/// Throws the error of a file with cells, but no wanted ones.
[[noreturn]] void failWithoutVtkCells(const VtkSource& source, const CellKind& cells);

/// The simplices that points were generated on, in two arrays as this library writes them.
struct VtkGenerators {
  std::optional<VtkColumn> tets;
  std::optional<VtkColumn> corners;
};
[[nodiscard]] VtkGenerators findVtkGenerators(const VtkSource& source);
/// Reads both, unless arrays of their names are something else.
void readVtkGenerators(const VtkSource& source, Array<Index>& tets, Array<CornerSet>& corners);

/// Tags and regions as addTags() writes them. Arrays of other forms belong to other programs, and
/// are ignored.
/// @throws Error FileSyntax if an array has too few or too many numbers; FileUnsupported for a tag
///         or region that does not fit into 32 bits; IndexOutOfRange for a vertex that is no point
[[nodiscard]] HexFeatures readVtkHexFeatures(const VtkSource& source);
[[nodiscard]] Features readVtkTetFeatures(const VtkSource& source);
[[nodiscard]] bool hasVtkRegions(const VtkSource& source);
/// @param cells  the numbers of the cells that are wanted, ascending
[[nodiscard]] Array<std::int32_t> readVtkRegions(const VtkSource& source,
                                                 std::span<const std::size_t> cells);

/// Reads points and hexahedra, and what else writers of this library add.
[[nodiscard]] HexMesh readVtkHexMesh(const VtkSource& source, Stage& stage);
/// For each point the first one at its position, in all digits.
/// @param coordinates  three of each point
/// @param firstPoints  of each piece: its first point. Where a piece has several at one position,
///                     nobody knows which of them another one's is, and each stays by itself
/// @param[out] ambiguous  one of these that other pieces have, too; as it was if there is none
[[nodiscard]] Array<std::size_t> firstsAtSamePosition(std::span<const double> coordinates,
                                                      const std::vector<std::size_t>& firstPoints,
                                                      std::size_t* ambiguous = nullptr);

/// A mesh of pieces.
struct GluedMesh {
  HexMesh mesh;
  bool numbered = false;  ///< its points and cells have the global numbers that the pieces tell
};
using OpenVtkPiece = std::function<std::unique_ptr<VtkSource>(std::size_t piece)>;
/// Reads pieces, one after the other, and joins them.
/// @param name  of the whole, for messages
/// @throws Error FileSyntax where global numbers contradict each other; where there are none, if
///         positions do not tell which points are the same
[[nodiscard]] GluedMesh readVtkPieces(const std::string& name, std::size_t count,
                                      const OpenVtkPiece& open, Stage& stage);

/// Lagrange hexahedra, or hexahedra with 20 or 27 nodes where none are straight.
[[nodiscard]] bool holdsVtkLagrange(const VtkSource& source);
/// @param fileName  for messages
[[nodiscard]] LagrangeMesh readVtkLagrange(const VtkSource& source, const std::string& fileName,
                                           Stage& stage);

/// Reads points and tets.
[[nodiscard]] TetCells readVtkTets(VtkSource& source, Stage& stage);
/// Reads tets and their map from an array of floating-point numbers. One of 12 numbers per cell
/// holds u0 v0 w0 u1 v1 w1 u2 v2 w2 u3 v3 w3, the parameters of a tet's corners in their order; one
/// of 3 numbers per point holds its u v w, for maps with one chart.
/// @param mapArray  its name
/// @throws Error FileUnsupported if there is no such array; NotFinite
[[nodiscard]] TetMap readVtkMap(VtkSource& source, std::string_view mapArray, Stage& stage);

/// Reads triangles with a whole number each.
/// @param name  of the cell array
[[nodiscard]] TriangleLabels readVtkLabels(VtkSource& source, std::string_view name, Stage& stage);

}  // namespace hexhex::io
