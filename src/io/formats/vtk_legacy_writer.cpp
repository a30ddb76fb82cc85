// Legacy `.vtk` files: a mesh or map in memory is written like a mesh of one piece.
#include <algorithm>
#include <array>
#include <bit>
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
#include <io/core/cell_counts.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/output_file.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

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
    return putBigBytes(place, number);
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

/// Writes the sections of a file, in order: of hexahedra, which may come in pieces, or of the tets
/// of a map.
template <class Numbers, std::size_t corners = 8>
class LegacyWriter {
 public:
  LegacyWriter(const std::filesystem::path& file, int threads)
      : name_(file.string()), output_(file), lines_(output_, threads) {}

  /// Everything up to the points.
  /// @throws Error TooLarge for points that 32-bit indices cannot number
  void begin(std::uint64_t points, std::uint64_t cells) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
    if (Numbers::kEncoding == VtkBigBytes::kEncoding && points > kMost) {
      throw Error(ErrorCode::TooLarge,
                  name_ +
                      ": legacy binary .vtk files have vertex numbers of 31 bits, which do not "
                      "suffice for " +
                      std::to_string(points) + " points; write .vtu.");
    }
    cellCount_ = cells;
    output_.write("# vtk DataFile Version 2.0\n");
    output_.write(corners == 8 ? "hexahedral mesh by hexhex\n" : "integer-grid map by hexhex\n");
    output_.write(Numbers::kEncoding).write("\nDATASET UNSTRUCTURED_GRID\n");
    output_.write("POINTS ").write(points).write(" double\n");
  }
  void points(const PointPiece& piece) {
    rows(piece.points.size(), [&](std::size_t i) -> const Vec3& { return piece.points[i]; });
  }
  void beginCells() {
    output_.write(Numbers::kEndOfSection);
    output_.write("CELLS ").write(cellCount_);
    output_.write(' ').write((corners + 1) * cellCount_).write('\n');
  }
  template <class Vertex>
  void cells(std::uint64_t /*first*/, std::span<const std::array<Vertex, corners>> cells) {
    lines_.write(
        cells.size(), (corners + 1) * Numbers::kRoom,
        [cells](char* place, std::size_t i) { return Numbers::cell(place, cells[i]); }, progress_);
  }
  void types() {
    output_.write(Numbers::kEndOfSection);
    output_.write("CELL_TYPES ").write(cellCount_).write('\n');
    constexpr auto kType = static_cast<std::uint32_t>(kCellKind<corners>.vtkType);
    rows(cellCount_, [](std::size_t) { return std::array{kType}; });
    output_.write(Numbers::kEndOfSection);
  }
  /// An array of cells.
  /// @param head  what follows their number
  template <class Row>
  void cellData(std::string_view head, const Row& row) {
    output_.write("CELL_DATA ").write(cellCount_).write(head);
    rows(cellCount_, row);
    output_.write(Numbers::kEndOfSection);
  }
  void commit() { output_.commit(); }
  void end() {
    types();
    commit();
  }

  /// Everything up to the types of cells. What is written from now on advances the progress.
  void write(std::span<const Vec3> allPoints, std::span<const std::array<Index, corners>> allCells,
             LoopProgress& progress) {
    progress_ = &progress;
    begin(allPoints.size(), allCells.size());
    points({0, allPoints, {}, {}});
    beginCells();
    cells(0, allCells);
    types();
  }

 private:
  /// n rows: row(i) is an array of numbers.
  template <class Row>
  void rows(std::size_t n, const Row& row) {
    constexpr std::size_t kColumns = std::tuple_size_v<std::remove_cvref_t<decltype(row(n))>>;
    lines_.write(
        n, kColumns * Numbers::kRoom,
        [&row](char* place, std::size_t i) { return Numbers::numbers(place, row(i)); }, progress_);
  }

  std::string name_;
  OutputFile output_;
  LineWriter lines_;
  std::uint64_t cellCount_ = 0;
  LoopProgress* progress_ = nullptr;
};

template <class Numbers>
void writeMesh(const HexMesh& mesh, const std::filesystem::path& file,
               const WriteOptions& /*options*/, Context& context) {
  Stage stage(context, "write mesh");
  LegacyWriter<Numbers> writer(file, context.threads());
  LoopProgress progress(stage, mesh.points.size() + 2 * mesh.cells.size() + mesh.regions.size());
  writer.write(mesh.points, mesh.cells, progress);
  if (!mesh.regions.empty()) {
    writer.cellData("\nSCALARS region int 1\nLOOKUP_TABLE default\n",
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
  LegacyWriter<Numbers, 4> writer(file, context.threads());
  withThreads(context.threads(), [&] { requireWritable(map, stage); });
  const std::size_t tets = map.tets.size();
  LoopProgress progress(stage, map.points.size() + 3 * tets);
  writer.write(map.points, map.tets, progress);
  writer.cellData(
      "\nFIELD FieldData 1\n" + name + " 12 " + std::to_string(tets) + " double\n",
      [&map](std::size_t t) { return std::bit_cast<std::array<double, 12>>(map.parameters[t]); });
  writer.commit();
}

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
  return openWriterSink<LegacyWriter<VtkText>>(file, context);
}

std::unique_ptr<MeshSink> openVtkLegacyBinarySink(const std::filesystem::path& file,
                                                  Context& context) {
  return openWriterSink<LegacyWriter<VtkBigBytes>>(file, context);
}

}  // namespace hexhex::io
