// Writes VTK XML files with raw appended arrays: of any data set, and of meshes in pieces.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/compressed_blocks.hpp>
#include <io/core/output_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/vtk_data_set.hpp>

namespace hexhex::io {

namespace {

constexpr std::string_view kTail = "\n  </AppendedData>\n</VTKFile>\n";

/// The tag of an array. `offset` counts from the beginning of the data.
std::string tagOf(const VtkArray& array, std::uint64_t offset) {
  std::string tag =
      concat("        <DataArray type=\"", array.type, "\" Name=\"", array.name, "\"");
  // Omitted if it is 1: some readers would return a matrix with one column.
  if (array.components != 1) tag += concat(" NumberOfComponents=\"", array.components, "\"");
  // The length of a field array is not given elsewhere.
  if (array.section == VtkSection::FieldData) tag += concat(" NumberOfTuples=\"", array.rows, "\"");
  return concat(tag, " format=\"appended\" offset=\"", offset, "\"/>\n");
}

/// The attribute that marks an array of global numbers.
std::string globalNumbersIn(const VtkDataSet& data, VtkSection section) {
  for (const VtkArray& array : data.arrays()) {
    if (array.section != section) continue;
    if (array.name == kVtkGlobalPoints || array.name == kVtkGlobalCells) {
      return concat(" GlobalIds=\"", array.name, '"');
    }
  }
  return {};
}

/// The header of a file, up to its data.
/// @param offsets  of the arrays, counted from the beginning of the data
std::string headOf(const VtkDataSet& data, std::span<const std::uint64_t> offsets,
                   Compression compress) {
  const bool isGrid = data.elements == VtkSection::Cells;
  const std::string type = isGrid ? "UnstructuredGrid" : "PolyData";
  const bool little = std::endian::native == std::endian::little;
  std::string head = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type +
                     "\" version=\"1.0\" byte_order=\"" + (little ? "LittleEndian" : "BigEndian") +
                     "\" header_type=\"UInt64\"";
  if (compress == Compression::Zlib) head += " compressor=\"vtkZLibDataCompressor\"";
  if (compress == Compression::Lz4) head += " compressor=\"vtkLZ4DataCompressor\"";
  head += ">\n  <" + type + ">\n";
  const auto addSection = [&](std::string_view name, VtkSection section) {
    head.append("      <").append(name).append(globalNumbersIn(data, section)).append(">\n");
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      if (data.arrays()[i].section == section) head += tagOf(data.arrays()[i], offsets[i]);
    }
    head.append("      </").append(name).append(">\n");
  };
  if (data.curved || data.arrays().front().section == VtkSection::FieldData) {
    addSection("FieldData", VtkSection::FieldData);
  }
  head += concat("    <Piece NumberOfPoints=\"", data.points, "\"");
  const auto addCount = [&head](std::string_view what, std::uint64_t count) {
    head.append(" NumberOf").append(what).append("=\"").append(std::to_string(count)).append("\"");
  };
  const bool lines = data.elements == VtkSection::Lines;
  if (isGrid) {
    addCount("Cells", data.cells);
  } else {
    addCount("Verts", 0);
    addCount("Lines", lines ? data.cells : 0);
    addCount("Strips", 0);
    addCount("Polys", lines ? 0 : data.cells);
  }
  head += ">\n";
  addSection("PointData", VtkSection::PointData);
  addSection("CellData", VtkSection::CellData);
  addSection("Points", VtkSection::Points);
  if (isGrid) {
    addSection("Cells", VtkSection::Cells);
  } else {
    head += "      <Verts>\n      </Verts>\n";
    addSection("Lines", VtkSection::Lines);
    head += "      <Strips>\n      </Strips>\n";
    addSection("Polys", VtkSection::Polys);
  }
  head += "    </Piece>\n  </" + type + ">\n  <AppendedData encoding=\"raw\">\n";
  return head + (data.curved ? "_" : "    _");
}

/// The header of a file with raw arrays.
/// @param[out] positions  of the arrays in the file; each is preceded by its length
std::string plainHead(const VtkDataSet& data, std::vector<std::uint64_t>& positions) {
  std::uint64_t offset = 0;
  for (const VtkArray& array : data.arrays()) {
    positions.push_back(offset);
    offset += sizeof(array.bytes) + array.bytes;
  }
  std::string head = headOf(data, positions, Compression::None);
  for (std::uint64_t& position : positions) position += head.size() + sizeof(std::uint64_t);
  return head;
}

/// The header of a file with compressed arrays. Its size does not depend on the offsets.
std::string compressedHead(const VtkDataSet& data, std::span<const std::uint64_t> offsets,
                           Compression compress) {
  const std::vector<std::uint64_t> largest(offsets.size(), ~std::uint64_t{0});
  const std::size_t size = headOf(data, largest, compress).size();
  std::string head = headOf(data, offsets, compress);
  // Spaces before the '_' are ignored.
  head.insert(head.size() - 1, size - head.size(), ' ');
  return head;
}

using CompressBlock = void(std::span<const char> bytes, Array<char>& compressed);

/// Receives the bytes of an array and writes them as blocks, compressed by all threads.
class CompressedArray {
 public:
  /// @param how    the function for a block
  /// @param lines  into the same file
  CompressedArray(CompressBlock& how, OutputFile& output, LineWriter& lines, std::uint64_t bytes)
      : compressBlock_(how),
        output_(output),
        lines_(lines),
        begin_(output.position()),
        // Number of blocks, their size, size of a shorter last one; compressed sizes follow.
        head_{blockCount(bytes, kBlockBytes), kBlockBytes, bytes % kBlockBytes} {
    const std::vector<std::uint64_t> room(head_.size() + head_[0], 0);
    output_.writeBytes(room.data(), room.size() * sizeof(std::uint64_t));
    collected_.resize(std::min<std::uint64_t>(kBatch, head_[0]) * kBlockBytes);
  }

  void writeBytes(const void* bytes, std::size_t size) {
    const char* from = static_cast<const char*>(bytes);
    while (size > 0) {
      const std::size_t count = std::min(size, collected_.size() - used_);
      std::copy_n(from, count, collected_.data() + used_);
      from += count;
      used_ += count;
      size -= count;
      if (used_ == collected_.size()) compress();
    }
  }

  /// Writes the remaining bytes.
  void finish() {
    compress();
    output_.flush();
    output_.writeBytesAt(begin_, head_.data(), head_.size() * sizeof(std::uint64_t));
  }

 private:
  // A millisecond of work, and a few times zlib's window, for good compression.
  static constexpr std::size_t kBlockBytes = std::size_t{1} << 17;
  // Blocks compressed in parallel.
  static constexpr std::size_t kBatch = 64;

  void compress() {
    const std::size_t blocks = blockCount(used_, kBlockBytes);
    const std::size_t known = head_.size();
    head_.resize(known + blocks);
    const auto putBlock = [&](char* place, std::size_t i) {
      const std::size_t size = std::min(kBlockBytes, used_ - i * kBlockBytes);
      Array<char> block;
      compressBlock_(std::span(collected_).subspan(i * kBlockBytes, size), block);
      head_[known + i] = block.size();
      return put(place, std::string_view(block.data(), block.size()));
    };
    lines_.write(blocks, 2 * kBlockBytes, putBlock, nullptr);  // no block becomes as large
    used_ = 0;
  }

  CompressBlock& compressBlock_;
  OutputFile& output_;
  LineWriter& lines_;
  std::uint64_t begin_;
  std::vector<std::uint64_t> head_;
  Array<char> collected_;  ///< not compressed yet
  std::size_t used_ = 0;
};

// Bytes written between checks for cancellation: a few milliseconds of work.
constexpr std::size_t kSliceBytes = std::size_t{1} << 22;

/// Passes bytes on in slices.
VtkBytes inSlices(VtkBytes output, LoopProgress& progress) {
  return [output = std::move(output), &progress](const void* bytes, std::size_t size) {
    for (std::size_t begin = 0; begin < size; begin += kSliceBytes) {
      const std::size_t count = std::min(kSliceBytes, size - begin);
      output(static_cast<const char*>(bytes) + begin, count);
      progress.advance(count);
    }
  };
}

void writePlain(OutputFile& output, const VtkDataSet& data, LoopProgress& progress) {
  std::vector<std::uint64_t> positions;
  output.write(plainHead(data, positions));
  const VtkBytes bytes = inSlices(
      [&output](const void* from, std::size_t size) { output.writeBytes(from, size); }, progress);
  for (const VtkArray& array : data.arrays()) {
    output.writeBytes(&array.bytes, sizeof(array.bytes));
    array.write(bytes);
  }
}

/// The header, with the offsets of the arrays, is written last, to the space reserved for it.
void writeCompressed(OutputFile& output, const VtkDataSet& data, Compression compress, int threads,
                     LoopProgress& progress) {
  CompressBlock& compressBlock = compress == Compression::Lz4 ? compressByLz4 : deflateBlock;
  std::vector<std::uint64_t> offsets(data.arrays().size(), 0);
  const std::size_t headBytes = compressedHead(data, offsets, compress).size();
  output.write(std::string(headBytes, ' '));
  LineWriter lines(output, threads);
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const VtkArray& array = data.arrays()[i];
    offsets[i] = output.position() - headBytes;
    CompressedArray blocks(compressBlock, output, lines, array.bytes);
    array.write(
        inSlices([&blocks](const void* from, std::size_t size) { blocks.writeBytes(from, size); },
                 progress));
    blocks.finish();
  }
  const std::string head = compressedHead(data, offsets, compress);
  output.flush();
  output.writeBytesAt(0, head.data(), head.size());
}

/// Refuses names that would need escaping, since they are written to attributes as they are.
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

/// Writes a mesh that comes in pieces, each with some rows of several arrays. All arrays are
/// written side by side, from positions that follow from the counts alone.
class VtuStream {
 public:
  VtuStream(OutputFile& output, int /*threads*/) : output_(output) {
    output_.requirePositions(
        "but the arrays of a .vtu file that comes in pieces are written side by side");
  }

  void begin(std::uint64_t points, std::uint64_t cells) {
    pointCount_ = points;
    cellCount_ = cells;
  }
  void points(const PointPiece& piece) {
    piece_.vertices = piece;
    beginFile();
    writeRows(true);
  }
  void beginCells() { beginFile(); }  // there may be no vertices
  template <class Cell>
  void cells(std::uint64_t first, std::span<const Cell> cells) {
    piece_ = {};
    piece_.setCells(first, cells);
    writeRows(false);
  }
  void end() {
    for (FilePart& part : parts_) part.flush();
    output_.writeBytesAt(end_, kTail.data(), kTail.size());
  }

 private:
  /// Begins the file once the first piece shows which arrays there are.
  void beginFile() {
    if (data_) return;
    data_.emplace(
        meshDataSet(piece_, pointCount_, cellCount_, std::tuple_size_v<Hex>, kVtkHexahedron));
    std::vector<std::uint64_t> positions;
    const std::string head = plainHead(*data_, positions);
    output_.writeBytesAt(0, head.data(), head.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const std::uint64_t bytes = data_->arrays()[i].bytes;
      output_.writeBytesAt(positions[i] - sizeof(bytes), &bytes, sizeof(bytes));
      parts_.emplace_back(output_, positions[i]);
      end_ = positions[i] + bytes;
    }
  }
  /// Writes the next rows of the point arrays, or of the cell arrays.
  void writeRows(bool ofPoints) {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const VtkArray& array = data_->arrays()[i];
      const bool isOfPoints =
          array.section == VtkSection::PointData || array.section == VtkSection::Points;
      if (isOfPoints != ofPoints) continue;
      array.write(
          [&part = parts_[i]](const void* from, std::size_t size) { part.writeBytes(from, size); });
    }
  }

  OutputFile& output_;
  std::uint64_t pointCount_ = 0;
  std::uint64_t cellCount_ = 0;
  VtkPiece piece_;
  std::optional<VtkDataSet> data_;
  std::vector<FilePart> parts_;  ///< of the arrays
  std::uint64_t end_ = 0;        ///< of the last array
};

void requireCompressible(const OutputFile& output, Compression compress) {
  if (compress == Compression::None) return;
  // The header is written last.
  output.requirePositions("to which no compressed .vtu file can be written");
}

}  // namespace

void writeVtkXml(OutputFile& output, const VtkDataSet& data, Compression compress, Stage& stage) {
  std::uint64_t bytes = 0;
  for (const VtkArray& array : data.arrays()) bytes += array.bytes;
  LoopProgress progress(stage, bytes);
  if (compress != Compression::None) {
    writeCompressed(output, data, compress, stage.context().threads(), progress);
  } else {
    writePlain(output, data, progress);
  }
  output.write(kTail);
}

void writeVtu(const HexMesh& mesh, OutputFile& output, const WriteOptions& options, Stage& stage) {
  requireCompressible(output, options.compress);
  VtkPiece piece;
  writeVtkXml(output, hexDataSet(mesh, options, piece), options.compress, stage);
}

void writeVtuMap(const TetMap& map, OutputFile& output, const WriteOptions& options, Stage& stage) {
  requirePlainName(options.mapArray);
  requireCompressible(output, options.compress);
  withThreads(stage.context().threads(), [&] { requireWritable(map, stage); });
  VtkPiece piece;
  piece.vertices.points = map.points;
  piece.setCells(0, std::span<const Tet>(map.tets));
  VtkDataSet data =
      meshDataSet(piece, map.points.size(), map.tets.size(), std::tuple_size_v<Tet>, kVtkTet);
  addTags(data, map.features, map.regions);
  data.add<double>(VtkSection::CellData, options.mapArray, 12, data.cells,
                   [&map](const VtkBytes& bytes) {
                     bytes(map.parameters.data(), map.parameters.size() * sizeof(TetParameters));
                   });
  writeVtkXml(output, data, options.compress, stage);
}

std::unique_ptr<MeshSink> openVtuSink(const std::filesystem::path& file, Context& context) {
  return openWriterSink<VtuStream>(file, context);
}

namespace {

/// The hex vertices and the inner points of arcs.
std::vector<PointPiece> pointsOf(const PiecewiseLinearMesh& mesh) {
  return {{0, mesh.mesh.points, mesh.mesh.generatorTet, mesh.mesh.generatorCorners},
          {0, mesh.arcs.points, mesh.arcs.generatorTet, mesh.arcs.generatorCorners}};
}

/// Adds the simplices that contain the cells.
void addCarriers(VtkDataSet& data, std::span<const Index> tets,
                 std::span<const CornerSet> corners) {
  data.add(VtkSection::CellData, "tet", tets);
  data.add(VtkSection::CellData, "tet_corners", corners);
  data.addComputed<std::uint8_t>(VtkSection::CellData, "tet_kind", corners.size(),
                                 [corners](std::size_t i) { return generatorKind(corners[i]); });
}

/// Adds the common type of all cells; PolyData has none.
void addTypes(VtkDataSet& data, std::uint8_t type) {
  if (data.elements != VtkSection::Cells) return;
  data.addComputed<std::uint8_t>(VtkSection::Cells, "types", data.cells,
                                 [type](std::size_t) { return type; });
}

/// The row of each element, given the beginnings of the rows.
Array<std::int32_t> rowOfEach(std::span<const std::uint64_t> begins, std::uint64_t extraPerRow) {
  const std::size_t rows = begins.size() - 1;
  Array<std::int32_t> result(begins.back() + rows * extraPerRow);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint64_t first = begins[row] + row * extraPerRow;
    const std::uint64_t count = begins[row + 1] - begins[row] + extraPerRow;
    std::fill_n(result.begin() + static_cast<std::ptrdiff_t>(first), count,
                static_cast<std::int32_t>(row));
  }
  return result;
}

/// The ends of all segments.
Array<std::int32_t> segmentEnds(const PiecewiseLinearMesh& mesh) {
  const Arcs& arcs = mesh.arcs;
  Array<std::int32_t> ends;
  ends.reserve(2 * arcs.segmentTet.size());
  const auto firstPoint = static_cast<std::int32_t>(mesh.mesh.points.size());
  for (std::size_t e = 0; e < arcs.count(); ++e) {
    ends.push_back(static_cast<std::int32_t>(arcs.ends[e][0]));
    for (std::uint64_t i = arcs.pointBegin[e]; i < arcs.pointBegin[e + 1]; ++i) {
      const std::int32_t point = firstPoint + static_cast<std::int32_t>(i);
      ends.push_back(point);  // end of one segment, start of the next
      ends.push_back(point);
    }
    ends.push_back(static_cast<std::int32_t>(arcs.ends[e][1]));
  }
  return ends;
}

}  // namespace

template <bool polyData>
void PiecewiseVtk<polyData>::writeArcs(const PiecewiseLinearMesh& mesh, const TetMapView* /*map*/,
                                       OutputFile& output, Stage& stage) {
  constexpr VtkSection kElements = polyData ? VtkSection::Lines : VtkSection::Cells;
  const Arcs& arcs = mesh.arcs;
  const std::size_t vertices = mesh.mesh.points.size();
  const std::size_t segments = arcs.segmentTet.size();
  const std::vector<PointPiece> points = pointsOf(mesh);
  VtkDataSet data(vertices + arcs.points.size(), segments, kElements);
  data.curved = true;
  addPoints(data, points);
  data.addComputed<std::int32_t>(
      VtkSection::PointData, "hex_edge", data.points,
      [vertices, arcOfPoint = rowOfEach(arcs.pointBegin, 0)](std::size_t i) {
        return i < vertices ? -1 : arcOfPoint[i - vertices];
      });
  data.addComputed<double>(VtkSection::PointData, "parameter", data.points,
                           [vertices, &arcs](std::size_t i) {
                             return i < vertices ? 0.0 : arcs.parameters[i - vertices];
                           });
  data.addOwn(VtkSection::CellData, "hex_edge", rowOfEach(arcs.pointBegin, 1));
  addCarriers(data, arcs.segmentTet, arcs.segmentCorners);
  data.addOwn(data.elements, "connectivity", segmentEnds(mesh));
  data.addComputed<std::int64_t>(data.elements, "offsets", segments,
                                 [](std::size_t i) { return 2 * (i + 1); });
  addTypes(data, kVtkLine);
  writeVtkXml(output, data, Compression::None, stage);
}

template <bool polyData>
void PiecewiseVtk<polyData>::writePatches(const PiecewiseLinearMesh& mesh,
                                          const TetMapView* /*map*/, OutputFile& output,
                                          Stage& stage) {
  constexpr VtkSection kElements = polyData ? VtkSection::Polys : VtkSection::Cells;
  const Patches& patches = mesh.patches;
  const std::size_t vertices = mesh.mesh.points.size();
  const std::size_t shared = vertices + mesh.arcs.points.size();
  const std::size_t polygons = patches.polygonTet.size();
  std::vector<PointPiece> points = pointsOf(mesh);
  points.push_back({0, patches.points, patches.generatorTet, patches.generatorCorners});
  VtkDataSet data(shared + patches.points.size(), polygons, kElements);
  data.curved = true;
  addPoints(data, points);
  data.addComputed<std::uint8_t>(
      VtkSection::PointData, "point_kind", data.points,
      [vertices, shared](std::size_t i) { return i < vertices ? 0 : (i < shared ? 1 : 2); });
  data.addOwn(VtkSection::CellData, "hex_face", rowOfEach(patches.polygonBegin, 0));
  addCarriers(data, patches.polygonTet, patches.polygonCorners);
  data.add(VtkSection::FieldData, "corner_uv",
           std::span<const std::array<double, 2>>(patches.parameters));
  data.addComputed<std::int64_t>(data.elements, "connectivity", patches.corners.size(),
                                 [&patches](std::size_t i) { return patches.corners[i]; });
  data.addComputed<std::int64_t>(data.elements, "offsets", polygons,
                                 [&patches](std::size_t i) { return patches.cornerBegin[i + 1]; });
  addTypes(data, kVtkPolygon);
  writeVtkXml(output, data, Compression::None, stage);
}

template struct PiecewiseVtk<false>;
template struct PiecewiseVtk<true>;

}  // namespace hexhex::io
