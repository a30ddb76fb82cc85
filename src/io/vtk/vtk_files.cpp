// The reading half of vtk.hpp: files as a whole, or piece by piece.
#include <algorithm>

#include <hexhex/stream.hpp>

#include <base/stage.hpp>
#include <io/core/input_file.hpp>
#include <io/core/triangle_labels.hpp>
#include <io/vtk/vtk.hpp>
#include <io/vtk/vtk_reader.hpp>

namespace hexhex::io {
namespace {

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
    cells.resize(countVtkCells(source, kCellKind<8>, first, count));
    readVtkCells(source, kCellKind<8>, first, count, cells.empty() ? nullptr : cells[0].data());
    if (!cells.empty()) sink.cells(sent, std::span<const Cell>(cells));
    sent += cells.size();
  });
}

void sendPieces(const VtkSource& source, MeshSink& sink, Stage& stage) {
  std::uint64_t hexahedra = 0;
  forEachPiece(stage, source.cells, [&](std::uint64_t first, std::size_t count) {
    hexahedra += countVtkCells(source, kCellKind<8>, first, count);
  });
  noteVtkCells(source, kCellKind<8>, hexahedra);
  if (source.cells > 0 && hexahedra == 0) failWithoutVtkCells(source, kCellKind<8>);
  sink.begin(source.points, hexahedra);
  sendPoints(source, sink, stage);
  if (source.points < kNone) {
    sendCells<Hex>(source, sink, stage);
  } else {
    sendCells<Hex64>(source, sink, stage);
  }
  sink.end();
}

}  // namespace

HexMesh readVtu(const Input& input, Context& context) {
  return inStage(context, "read mesh", [&input](Stage& stage) {
    return readVtkHexMesh(*openVtuFile(input, stage), stage);
  });
}

TetCells readVtuTets(const Input& input, Context& context) {
  return inStage(context, "read tets",
                 [&input](Stage& stage) { return readVtkTets(*openVtuFile(input, stage), stage); });
}

TetMap readVtuMap(const Input& input, const ReadOptions& options, Context& context) {
  return inStage(context, "read map", [&](Stage& stage) {
    return readVtkMap(*openVtuFile(input, stage), options.mapArray, stage);
  });
}

TriangleLabels readVtuLabels(const Input& input, std::string_view array, Context& context) {
  return inStage(context, "read labels", [&](Stage& stage) {
    return readVtkLabels(*openVtuFile(input, stage), array, stage);
  });
}

TriangleLabels readVtkLegacyLabels(const Input& input, std::string_view array, Context& context) {
  return inStage(context, "read labels", [&](Stage& stage) {
    return readVtkLabels(*openVtkLegacyFile(input, false, stage), array, stage);
  });
}

HexMesh readVtkLegacy(const Input& input, Context& context) {
  return inStage(context, "read mesh", [&input](Stage& stage) {
    return readVtkHexMesh(*openVtkLegacyFile(input, true, stage), stage);
  });
}

TetCells readVtkLegacyTets(const Input& input, Context& context) {
  return inStage(context, "read tets", [&input](Stage& stage) {
    return readVtkTets(*openVtkLegacyFile(input, false, stage), stage);
  });
}

TetMap readVtkLegacyMap(const Input& input, const ReadOptions& options, Context& context) {
  return inStage(context, "read map", [&](Stage& stage) {
    return readVtkMap(*openVtkLegacyFile(input, false, stage), options.mapArray, stage);
  });
}

void readVtuTo(MeshSink& sink, const Input& input, Context& context) {
  Stage stage(context, "read mesh");
  sendPieces(*openVtuFile(input, stage), sink, stage);
}

}  // namespace hexhex::io
