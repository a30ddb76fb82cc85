// The reading half of vtk.hpp: files as a whole, or piece by piece.
#include <algorithm>

#include <hexhex/stream.hpp>

#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/vtk/vtk.hpp>
#include <io/vtk/vtk_legacy_file.hpp>
#include <io/vtk/vtk_reader.hpp>
#include <io/vtk/vtu_file.hpp>

namespace hexhex {
namespace {

template <class Read>
auto readLegacyFile(const Input& input, std::string_view stageName, Context& context,
                    const Read& read) {
  return inStage(context, stageName, [&](Stage& stage) {
    Array<char> room;
    VtkLegacyFile file(input.text(room, stage), input.name(), stage);
    return read(file, stage);
  });
}

HexMesh readLegacyHexes(VtkLegacyFile& file, Stage& stage) {
  file.readRegions();
  return readVtkHexMesh(file, stage);
}

/// Reads the map from the array that options name.
auto mapReader(const ReadOptions& options) {
  return [&options](auto& file, Stage& stage) { return readVtkMap(file, options.mapArray, stage); };
}

// Points or cells of a piece: a few megabytes.
constexpr std::size_t kPiece = std::size_t{1} << 16;

/// Calls f(first, count) for consecutive ranges of n elements, and reports progress.
template <class F>
void forEachPiece(Stage& stage, std::uint64_t n, const F& f) {
  LoopProgress progress(stage, n);
  for (std::uint64_t first = 0; first < n; first += kPiece) {
    const std::size_t count = std::min<std::uint64_t>(kPiece, n - first);
    f(first, count);
    progress.advance(count);
  }
}

void sendPoints(const VtkSource& source, MeshSink& sink, Stage& stage) {
  Array<Vec3> points;
  Array<Index> tets;
  Array<CornerSet> corners;
  const VtkGenerators generators = findVtkGenerators(source);
  forEachPiece(stage, source.points, [&](std::uint64_t first, std::size_t count) {
    points.resize(count);
    readVtkPoints(source, first, points);
    const auto copy = [&](const auto& column, auto& values) {
      if (!column) return;
      values.resize(count);
      source.copy(*column, first, count, values.data());
    };
    copy(generators.tets, tets);
    copy(generators.corners, corners);
    sink.points({first, points, tets, corners});
  });
}

template <class Cell>
void sendCells(const VtkSource& source, MeshSink& sink, Stage& stage) {
  Array<Cell> cells;
  std::uint64_t sent = 0;
  forEachPiece(stage, source.cells, [&](std::uint64_t first, std::size_t count) {
    cells.resize(countVtkCells(source, kVtkCells<8>, first, count));
    readVtkCells(source, kVtkCells<8>, first, count, cells.empty() ? nullptr : cells[0].data());
    if (!cells.empty()) sink.cells(sent, std::span<const Cell>(cells));
    sent += cells.size();
  });
}

}  // namespace

HexMesh readVtu(const Input& input, Context& context) {
  return readVtuFile(input, "read mesh", context, readVtkHexMesh);
}

TetCells readVtuTets(const Input& input, Context& context) {
  return readVtuFile(input, "read tets", context, readVtkTets);
}

TetMap readVtuMap(const Input& input, const ReadOptions& options, Context& context) {
  return readVtuFile(input, "read map", context, mapReader(options));
}

HexMesh readVtkLegacy(const Input& input, Context& context) {
  return readLegacyFile(input, "read mesh", context, readLegacyHexes);
}

TetCells readVtkLegacyTets(const Input& input, Context& context) {
  return readLegacyFile(input, "read tets", context, readVtkTets);
}

TetMap readVtkLegacyMap(const Input& input, const ReadOptions& options, Context& context) {
  return readLegacyFile(input, "read map", context, mapReader(options));
}

void readVtuTo(MeshSink& sink, const std::filesystem::path& path, Context& context) {
  const InputFile input(path);
  const Array<char> head = readPlainVtuHead(input);
  if (head.empty()) return sendTo(sink, readVtu(path, context));
  Stage stage(context, "read mesh");
  const std::string name = path.string();
  const VtuFile file(ByteFile(input, name), asText(head), name, stage);
  std::uint64_t hexahedra = 0;
  forEachPiece(stage, file.cells, [&](std::uint64_t first, std::size_t count) {
    hexahedra += countVtkCells(file, kVtkCells<8>, first, count);
  });
  if (file.cells > 0 && hexahedra == 0) failWithoutVtkCells(file, kVtkCells<8>);
  sink.begin(file.points, hexahedra);
  sendPoints(file, sink, stage);
  if (file.points < kNone) {
    sendCells<Hex>(file, sink, stage);
  } else {
    sendCells<Hex64>(file, sink, stage);
  }
  sink.end();
}

}  // namespace hexhex
