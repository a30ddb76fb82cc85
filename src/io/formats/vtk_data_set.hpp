// VTK data sets for writing: arrays of points, cells and the whole mesh, each with a name, a type
// and a function that writes its bytes.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <hexhex/context.hpp>
#include <hexhex/io.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/quality.hpp>
#include <hexhex/stream.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/output_file.hpp>

namespace hexhex::io {

// VTK cell types.
inline constexpr std::uint8_t kVtkLine = 3;
inline constexpr std::uint8_t kVtkPolygon = 7;
inline constexpr std::uint8_t kVtkTet = 10;
inline constexpr std::uint8_t kVtkHexahedron = 12;
inline constexpr std::uint8_t kVtkLagrangeHexahedron = 72;

/// The sections of arrays, in file order. Cells belongs to unstructured grids, Lines and Polys to
/// PolyData.
enum class VtkSection : std::uint8_t {
  FieldData,
  PointData,
  CellData,
  Points,
  Lines,
  Polys,
  Cells
};

// Array names, for readers and writers.
inline constexpr std::string_view kVtkGeneratorTets = "generator_tet";
inline constexpr std::string_view kVtkGeneratorCorners = "generator_corners";
inline constexpr std::string_view kVtkVertexTags = "feature_vertex";
inline constexpr std::string_view kVtkEdgeTags = "feature_edges";
inline constexpr std::string_view kVtkTriangleTags = "feature_triangles";
inline constexpr std::string_view kVtkQuadTags = "feature_quads";
inline constexpr std::string_view kVtkRegions = "region";
/// The names of named tags, and in the same order their dimensions and tags.
inline constexpr std::string_view kVtkTagNames = "tag_names";
inline constexpr std::string_view kVtkNamedTags = "named_tags";
// VTK's own arrays.
inline constexpr std::string_view kVtkGlobalPoints = "GlobalPointIds";
inline constexpr std::string_view kVtkGlobalCells = "GlobalCellIds";
inline constexpr std::string_view kVtkGhosts = "vtkGhostType";

/// Receives the bytes of an array, front to back.
using VtkBytes = std::function<void(const void* bytes, std::size_t size)>;

/// Writes valueOf(i) for i in [0, count).
template <class T, class F>
void writeValues(const VtkBytes& output, std::size_t count, const F& valueOf) {
  std::array<T, (1U << 14U) / sizeof(T)> values;  // enough to amortize the cost of calls
  for (std::size_t begin = 0; begin < count; begin += values.size()) {
    const std::size_t size = std::min(values.size(), count - begin);
    for (std::size_t i = 0; i < size; ++i) values[i] = static_cast<T>(valueOf(begin + i));
    output(values.data(), size * sizeof(T));
  }
}

/// An array. A row has `components` numbers of the type.
struct VtkArray {
  VtkSection section = VtkSection::Points;
  std::string_view name;
  std::string_view type;  ///< VTK's name of the number type
  std::size_t components = 1;
  std::uint64_t rows = 0;
  std::uint64_t bytes = 0;
  /// Writes all bytes of the array; for data sets in pieces, those of its next rows.
  std::function<void(const VtkBytes&)> write;
};

/// Points and cells with arrays. The sources of arrays must outlive the data set.
class VtkDataSet {
 public:
  /// @param elements  the section of the cells' corners, which determines the kind of data set
  VtkDataSet(std::uint64_t points_, std::uint64_t cells_, VtkSection elements_ = VtkSection::Cells)
      : points(points_), cells(cells_), elements(elements_) {}

  std::uint64_t points;
  std::uint64_t cells;
  VtkSection elements;
  /// Whether it holds arcs, patches or cells of higher order.
  bool curved = false;

  /// All arrays, in the order of their sections.
  [[nodiscard]] const std::vector<VtkArray>& arrays() const noexcept { return arrays_; }

  template <class T>
  void add(VtkSection section, std::string_view name, std::size_t components, std::uint64_t rows,
           std::function<void(const VtkBytes&)> write) {
    const auto behind =
        std::find_if(arrays_.begin(), arrays_.end(),
                     [section](const VtkArray& array) { return array.section > section; });
    arrays_.insert(behind, {section, name, typeName<T>(), components, rows,
                            rows * components * sizeof(T), std::move(write)});
  }
  /// Adds zero-terminated strings; they must not contain zeros.
  void addTexts(std::string_view name, std::span<const TagName> names);
  /// Adds numbers from memory.
  template <class T>
  void add(VtkSection section, std::string_view name, std::span<const T> values,
           std::size_t components = 1) {
    add<T>(section, name, components, values.size() / components,
           [values](const VtkBytes& output) { output(values.data(), values.size_bytes()); });
  }
  /// The same for vectors.
  template <class T, std::size_t n>
  void add(VtkSection section, std::string_view name, std::span<const std::array<T, n>> values) {
    add<T>(section, name, n, values.size(),
           [values](const VtkBytes& output) { output(values.data(), values.size_bytes()); });
  }
  /// Adds numbers owned by the data set.
  template <class Numbers>
  void addOwn(VtkSection section, std::string_view name, Numbers&& numbers,
              std::size_t components = 1) {
    using T = typename std::remove_cvref_t<Numbers>::value_type;
    const std::uint64_t rows = numbers.size() / components;  // before the numbers move
    add<T>(section, name, components, rows,
           [own = std::forward<Numbers>(numbers)](const VtkBytes& output) {
             output(own.data(), own.size() * sizeof(T));
           });
  }
  /// Adds valueOf(i) for i in [0, count).
  template <class T, class F>
  void addComputed(VtkSection section, std::string_view name, std::uint64_t count, F valueOf) {
    add<T>(section, name, 1, count, [count, valueOf = std::move(valueOf)](const VtkBytes& output) {
      writeValues<T>(output, count, valueOf);
    });
  }

 private:
  template <class T>
  static constexpr std::string_view typeName() {
    if constexpr (std::same_as<T, double>) return "Float64";
    if constexpr (std::same_as<T, std::uint8_t>) return "UInt8";
    if constexpr (std::same_as<T, std::int32_t>) return "Int32";
    if constexpr (std::same_as<T, std::uint32_t>) return "UInt32";
    if constexpr (std::same_as<T, std::int64_t>) return "Int64";
  }

  std::vector<VtkArray> arrays_;
};

/// Some or all vertices and cells of a mesh: what the arrays of meshDataSet() write next.
struct VtkPiece {
  PointPiece vertices = {};
  std::uint64_t firstCell = 0;
  std::size_t cells = 0;
  std::variant<std::span<const Index>, std::span<const std::uint64_t>> corners = {};
  const OtherCells* others = &noOthers();  ///< written after the cells

  template <class Vertex, std::size_t n>
  void setCells(std::uint64_t first, std::span<const std::array<Vertex, n>> list) {
    firstCell = first;
    cells = list.size();
    corners = std::span(list.empty() ? nullptr : list.front().data(), n * list.size());
  }
};

/// Corner i of a list of the corners of all cells, and where the first i cells end in it.
[[nodiscard]] Index cornerOf(const OtherCells& others, std::size_t i);
[[nodiscard]] std::size_t endOf(const OtherCells& others, std::size_t i);

/// A data set of points, cells of one type, others and, if pieces have them, generators.
/// @param piece    must outlive the data set
/// @param cells    without others
/// @param corners  per cell
[[nodiscard]] VtkDataSet meshDataSet(const VtkPiece& piece, std::uint64_t points,
                                     std::uint64_t cells, std::size_t corners, std::uint8_t type);

/// Adds points and the arrays generator_tet, generator_corners and generator_kind.
/// @param lists  of points, to be concatenated; must outlive the data set
void addPoints(VtkDataSet& data, std::span<const PointPiece> lists);

/// The cell array of WriteOptions::scaledJacobians.
inline constexpr std::string_view kVtkQuality = "scaled_jacobian";

/// Adds tags and regions, if there are any: the point array feature_vertex (Int32), the field
/// arrays feature_edges, feature_triangles and feature_quads (Int64: vertices and tag), and the
/// cell array region (Int32).
/// @param regions  must outlive the data set
/// @throws Error InvalidArgument for a tagged vertex that is out of range
void addTags(VtkDataSet& data, const HexFeatures& features, std::span<const std::int32_t> regions);
void addTags(VtkDataSet& data, const Features& features, std::span<const std::int32_t> regions);

/// The data set of a hex mesh in `.vtu` and `.vtkhdf` files, as described at writeVtu().
/// @param piece  must outlive the data set, as must the mesh and the options
[[nodiscard]] VtkDataSet hexDataSet(const HexMesh& mesh, const WriteOptions& options,
                                    VtkPiece& piece);

/// Writes a VTK XML file, array by array. A single thread writes raw arrays straight from memory,
/// which is as fast as the file system accepts bytes from one file. Compressed arrays are
/// deflated in blocks by all threads; the result does not depend on their number.
/// @param compress  by a library that must be there; the output must then have positions
void writeVtkXml(OutputFile& output, const VtkDataSet& data, Compression compress, Stage& stage);

// Data sets of parts.

/// VTK's ghost mark of points and cells that another part owns.
inline constexpr std::uint8_t kVtkDuplicate = 1;

/// Points, generators, tags, regions, global numbers and, if the mesh has ghosts, marks of points
/// and cells owned by other parts. All parts have the same arrays of points and cells. Empty arrays
/// of tags are left out.
/// @param part, piece  must outlive the data set
[[nodiscard]] VtkDataSet partDataSet(const MeshPart& part, const PartsInfo& info, VtkPiece& piece);

}  // namespace hexhex::io
