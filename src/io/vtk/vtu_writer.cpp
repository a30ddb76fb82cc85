// The writing half of vtu.hpp: meshes and maps in memory, and meshes in pieces.
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>

#include <hexhex/error.hpp>
#include <hexhex/quality.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/output_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/core/writable.hpp>
#include <io/vtk/vtk.hpp>
#include <io/vtk/vtk_xml_writer.hpp>

namespace hexhex {
namespace {

/// Names stand in attributes of tags as they are.
void requirePlainName(std::string_view name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return c >= ' ' && std::string_view("\"'<>&\x7f").find(c) == std::string_view::npos;
  });
  if (plain && !name.empty()) return;
  throw Error(ErrorCode::InvalidArgument,
              quoted(name) +
                  " cannot be the name of an array: it is empty or has one of the "
                  "characters \" ' < > & or a control character.");
}

/// Writes a mesh that comes in pieces.
class VtuStream {
 public:
  VtuStream(const std::filesystem::path& file, int /*threads*/) : output_(file) {
    if (output_.hasPositions()) return;
    throw Error(ErrorCode::FileWrite,
                file.string() +
                    ": the file was not written because it is a device or a pipe, but the arrays "
                    "of a .vtu file that comes in pieces are written side by side. Name a file.");
  }

  void begin(std::uint64_t points, std::uint64_t cells) {
    pointCount_ = points;
    cellCount_ = cells;
  }
  void points(const PointPiece& piece) {
    piece_ = {.points = piece.points,
              .generatorTets = piece.generatorTet,
              .generatorCorners = piece.generatorCorners};
    beginFile();
    pieces_->writePoints();
  }
  void beginCells() { beginFile(); }  // there may be no vertices
  template <class Cell>
  void cells(std::uint64_t first, std::span<const Cell> cells) {
    piece_ = {};
    piece_.setCells(first, cells);
    pieces_->writeCells();
  }
  void end() { pieces_->finish(); }

 private:
  /// Only the first piece tells which arrays there are, and so where they begin.
  void beginFile() {
    if (pieces_) return;
    data_.emplace(
        meshDataSet(piece_, pointCount_, cellCount_, std::tuple_size_v<Hex>, kVtkHexahedron));
    pieces_.emplace(output_, *data_);
  }

  OutputFile output_;
  std::uint64_t pointCount_ = 0;
  std::uint64_t cellCount_ = 0;
  VtkPiece piece_;
  std::optional<VtkDataSet> data_;
  std::optional<VtkXmlPieces> pieces_;
};

}  // namespace

void writeVtu(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
              Context& context) {
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  if (options.compress) requireCompressible(output, file.string());
  Array<double> computedQuality;
  std::span<const double> quality = options.scaledJacobians;
  if (quality.empty()) quality = computedQuality = scaledJacobians(mesh, context);
  Stage stage(context, "write mesh");
  VtkPiece piece;
  writeVtkXml(output, hexDataSet(mesh, quality, piece), options.compress, stage);
}

void writeVtuMap(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
                 Context& context) {
  Stage stage(context, "write map");
  requirePlainName(options.mapArray);
  OutputFile output(file);
  if (options.compress) requireCompressible(output, file.string());
  withThreads(context.threads(), [&] { requireWritable(map, stage); });
  VtkPiece piece{.points = map.points};
  piece.setCells(0, std::span<const Tet>(map.tets));
  VtkDataSet data =
      meshDataSet(piece, map.points.size(), map.tets.size(), std::tuple_size_v<Tet>, kVtkTet);
  addTags(data, map.features, map.regions);
  static_assert(sizeof(TetParameters) == 12 * sizeof(double));
  const double* const parameters =
      map.parameters.empty() ? nullptr : map.parameters.front().front().data();
  data.add(VtkSection::CellData, options.mapArray,
           std::span<const double>(parameters, 12 * map.parameters.size()), 12);
  writeVtkXml(output, data, options.compress, stage);
}

std::unique_ptr<MeshSink> openVtuSink(const std::filesystem::path& file, Context& context) {
  return openWriterSink<VtuStream>(file, context);
}

}  // namespace hexhex
