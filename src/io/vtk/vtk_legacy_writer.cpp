// The writing half of vtk_legacy.hpp: a mesh or map in memory is written like a mesh of one piece.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/bytes.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/output_file.hpp>
#include <io/core/writable.hpp>
#include <io/vtk/vtk.hpp>
#include <io/vtk/vtk_data_set.hpp>

namespace hexhex {
namespace {

/// Numbers as text: in the form of version 2.0, which every program reads.
struct VtkText {
  static constexpr std::string_view kEncoding = "ASCII";
  static constexpr std::string_view kEndOfSection = {};
  static constexpr std::size_t kRoom = kNumberRoom + 1;  ///< for a number

  template <class T, std::size_t n>
  static char* numbers(char* place, const std::array<T, n>& numbers) {
    return put(putNumbers(place, numbers), '\n');
  }
  template <class Vertex, std::size_t corners>
  static char* cell(char* place, const std::array<Vertex, corners>& cell) {
    return numbers(put(put(place, corners), ' '), cell);
  }
};

/// Numbers as bytes, the largest first.
struct VtkBigBytes {
  static constexpr std::string_view kEncoding = "BINARY";
  static constexpr std::string_view kEndOfSection = "\n";
  static constexpr std::size_t kRoom = 8;

  template <class T>
  static char* number(char* place, T number) {
    const auto bytes = littleBytes(number);
    return std::reverse_copy(bytes.begin(), bytes.end(), place);
  }
  template <class T, std::size_t n>
  static char* numbers(char* place, const std::array<T, n>& numbers) {
    for (const T value : numbers) place = number(place, value);
    return place;
  }
  template <class Vertex, std::size_t corners>
  static char* cell(char* place, const std::array<Vertex, corners>& cell) {
    place = number(place, static_cast<std::uint32_t>(corners));
    for (const Vertex vertex : cell) place = number(place, static_cast<std::uint32_t>(vertex));
    return place;
  }
};

/// Writes the sections of a file, in order.
template <class Numbers>
class LegacyWriter {
 public:
  LegacyWriter(const std::filesystem::path& file, int threads)
      : name_(file.string()), output_(file), lines_(output_, threads) {}

  /// Everything up to the points.
  /// @throws Error TooLarge for points that 32-bit indices cannot number
  void begin(std::string_view title, std::uint64_t points) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
    if (Numbers::kEncoding == VtkBigBytes::kEncoding && points > kMost) {
      throw Error(ErrorCode::TooLarge,
                  name_ +
                      ": legacy binary .vtk files have vertex numbers of 31 bits, which do not "
                      "suffice for " +
                      std::to_string(points) + " points; write .vtu.");
    }
    output_.write("# vtk DataFile Version 2.0\n").write(title).write('\n');
    output_.write(Numbers::kEncoding).write("\nDATASET UNSTRUCTURED_GRID\n");
    output_.write("POINTS ").write(points).write(" double\n");
  }
  /// n rows: row(i) is an array of numbers.
  template <class Row>
  void rows(std::size_t n, const Row& row, LoopProgress* progress) {
    constexpr std::size_t kNumbers = std::tuple_size_v<std::remove_cvref_t<decltype(row(n))>>;
    lines_.write(
        n, kNumbers * Numbers::kRoom,
        [&row](char* place, std::size_t i) { return Numbers::numbers(place, row(i)); }, progress);
  }
  void points(std::span<const Vec3> points, LoopProgress* progress = nullptr) {
    rows(
        points.size(), [points](std::size_t i) -> const Vec3& { return points[i]; }, progress);
  }
  void beginCells(std::uint64_t cells, std::size_t corners) {
    output_.write(Numbers::kEndOfSection);
    output_.write("CELLS ").write(cells).write(' ').write((corners + 1) * cells).write('\n');
  }
  template <class Vertex, std::size_t corners>
  void cells(std::span<const std::array<Vertex, corners>> cells, LoopProgress* progress = nullptr) {
    lines_.write(
        cells.size(), (corners + 1) * Numbers::kRoom,
        [cells](char* place, std::size_t i) { return Numbers::cell(place, cells[i]); }, progress);
  }
  /// All cells are of one type.
  void types(std::uint64_t cells, std::uint32_t type, LoopProgress* progress = nullptr) {
    output_.write(Numbers::kEndOfSection);
    output_.write("CELL_TYPES ").write(cells).write('\n');
    rows(
        cells, [type](std::size_t) { return std::array{type}; }, progress);
    output_.write(Numbers::kEndOfSection);
  }
  /// An array of cells.
  /// @param head  what follows their number
  template <class Row>
  void cellData(std::uint64_t cells, std::string_view head, const Row& row,
                LoopProgress* progress = nullptr) {
    output_.write("CELL_DATA ").write(cells).write(head);
    rows(cells, row, progress);
    output_.write(Numbers::kEndOfSection);
  }
  void commit() { output_.commit(); }

 private:
  std::string name_;
  OutputFile output_;
  LineWriter lines_;
};

constexpr std::string_view kMeshTitle = "hexahedral mesh by hexhex";

template <class Numbers>
void writeMesh(const HexMesh& mesh, const std::filesystem::path& file,
               const WriteOptions& /*options*/, Context& context) {
  Stage stage(context, "write mesh");
  LegacyWriter<Numbers> writer(file, context.threads());
  const std::size_t cells = mesh.cells.size();
  LoopProgress progress(stage, mesh.points.size() + 2 * cells);
  writer.begin(kMeshTitle, mesh.points.size());
  writer.points(mesh.points, &progress);
  writer.beginCells(cells, std::tuple_size_v<Hex>);
  writer.cells(std::span<const Hex>(mesh.cells), &progress);
  writer.types(cells, kVtkHexahedron, &progress);
  if (!mesh.regions.empty()) {
    writer.cellData(cells, "\nSCALARS region int 1\nLOOKUP_TABLE default\n",
                    [&mesh](std::size_t c) { return std::array{mesh.regions[c]}; });
  }
  writer.commit();
}

/// Names of arrays are tokens: other characters are written as "%20", as VTK does it.
std::string encodedName(std::string_view name) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  if (name.empty()) {
    throw Error(ErrorCode::InvalidArgument, "The name of the map's array is empty.");
  }
  std::string token;
  for (const char c : name) {
    if (c > ' ' && c <= '~' && c != '%' && c != '"') {
      token += c;
      continue;
    }
    const auto code = static_cast<unsigned char>(c);
    token += {'%', kDigits[code / 16U], kDigits[code % 16U]};
  }
  return token;
}

template <class Numbers>
void writeMap(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
              Context& context) {
  Stage stage(context, "write map");
  const std::string name = encodedName(options.mapArray);
  LegacyWriter<Numbers> writer(file, context.threads());
  withThreads(context.threads(), [&] { requireWritable(map, stage); });
  const std::size_t tets = map.tets.size();
  LoopProgress progress(stage, map.points.size() + 3 * tets);
  writer.begin("integer-grid map by hexhex", map.points.size());
  writer.points(map.points, &progress);
  writer.beginCells(tets, std::tuple_size_v<Tet>);
  writer.cells(std::span<const Tet>(map.tets), &progress);
  writer.types(tets, kVtkTet, &progress);
  writer.cellData(
      tets, "\nFIELD FieldData 1\n" + name + " 12 " + std::to_string(tets) + " double\n",
      [&map](std::size_t t) {
        std::array<double, 12> numbers;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
          numbers[i] = map.parameters[t][i / 3][i % 3];
        }
        return numbers;
      },
      &progress);
  writer.commit();
}

/// Writes a mesh that comes in pieces.
template <class Numbers>
class LegacyStream {
 public:
  LegacyStream(const std::filesystem::path& file, int threads) : writer_(file, threads) {}

  void begin(std::uint64_t points, std::uint64_t cells) {
    cellCount_ = cells;
    writer_.begin(kMeshTitle, points);
  }
  void points(const PointPiece& piece) { writer_.points(piece.points); }
  void beginCells() { writer_.beginCells(cellCount_, std::tuple_size_v<Hex>); }
  template <class Cell>
  void cells(std::uint64_t /*first*/, std::span<const Cell> cells) {
    writer_.cells(cells);
  }
  void end() {
    writer_.types(cellCount_, kVtkHexahedron);
    writer_.commit();
  }

 private:
  LegacyWriter<Numbers> writer_;
  std::uint64_t cellCount_ = 0;
};

}  // namespace

void writeVtkLegacy(const HexMesh& mesh, const std::filesystem::path& file,
                    const WriteOptions& options, Context& context) {
  writeMesh<VtkText>(mesh, file, options, context);
}

void writeVtkLegacyBinary(const HexMesh& mesh, const std::filesystem::path& file,
                          const WriteOptions& options, Context& context) {
  writeMesh<VtkBigBytes>(mesh, file, options, context);
}

void writeVtkLegacyMap(const TetMap& map, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context) {
  writeMap<VtkText>(map, file, options, context);
}

void writeVtkLegacyMapBinary(const TetMap& map, const std::filesystem::path& file,
                             const WriteOptions& options, Context& context) {
  writeMap<VtkBigBytes>(map, file, options, context);
}

std::unique_ptr<MeshSink> openVtkLegacySink(const std::filesystem::path& file, Context& context) {
  return openWriterSink<LegacyStream<VtkText>>(file, context);
}

std::unique_ptr<MeshSink> openVtkLegacyBinarySink(const std::filesystem::path& file,
                                                  Context& context) {
  return openWriterSink<LegacyStream<VtkBigBytes>>(file, context);
}

}  // namespace hexhex
