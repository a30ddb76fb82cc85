// The writing half of vtu.hpp: one thread, straight from the mesh's arrays. That is as fast as the
// file system takes bytes, which lets one thread at a time write to a file. Compressed arrays come
// block by block instead, from all threads.
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <hexhex/quality.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/core/writable.hpp>
#include <io/core/zlib_blocks.hpp>
#include <io/vtk/vtu.hpp>
#include <io/vtk/vtu_blocks.hpp>
#include <io/vtk/vtu_content.hpp>
#include <io/vtk/vtu_layout.hpp>

namespace hexhex {
namespace {

// What is written between two looks at the caller's wish to cancel: some milliseconds' work.
constexpr std::size_t kSliceBytes = std::size_t{1} << 22;

/// Where the arrays of a map are, and where those of a hex mesh.
struct MapContent {
  explicit MapContent(const TetMap& map_)
      : map(map_),
        edgeRows(rowsOf(map.features.edges)),
        triangleRows(rowsOf(map.features.faces)),
        tags(vertexTags(map.features.vertices, map.points.size())) {}

  const TetMap& map;
  std::vector<std::int64_t> edgeRows;
  std::vector<std::int64_t> triangleRows;
  Array<std::int32_t> tags;

  [[nodiscard]] std::size_t pointCount() const { return map.points.size(); }
  [[nodiscard]] std::span<const Tet> cells() const { return map.tets; }
  [[nodiscard]] const void* inMemory(VtuContent content) const {
    if (content == VtuContent::Map) return map.parameters.data();
    if (content == VtuContent::VertexTags) return tags.data();
    if (content == VtuContent::Regions) return map.regions.data();
    if (content == VtuContent::EdgeTags) return edgeRows.data();
    if (content == VtuContent::TriangleTags) return triangleRows.data();
    return map.points.data();
  }
  [[nodiscard]] static std::span<const CornerSet> generatorCorners() { return {}; }
  static constexpr std::uint8_t kType = kVtkTet;
};

struct HexContent {
  HexContent(const HexMesh& mesh_, std::span<const double> quality_)
      : mesh(mesh_),
        quality(quality_),
        edgeRows(rowsOf(mesh.features.edges)),
        quadRows(rowsOf(mesh.features.quads)),
        tags(vertexTags(mesh.features.vertices, mesh.points.size())) {}

  const HexMesh& mesh;
  std::span<const double> quality;
  std::vector<std::int64_t> edgeRows;
  std::vector<std::int64_t> quadRows;
  Array<std::int32_t> tags;

  [[nodiscard]] std::size_t pointCount() const { return mesh.points.size(); }
  [[nodiscard]] std::span<const Hex> cells() const { return mesh.cells; }
  [[nodiscard]] const void* inMemory(VtuContent content) const {
    if (content == VtuContent::GeneratorTet) return mesh.generatorTet.data();
    if (content == VtuContent::GeneratorCorners) return mesh.generatorCorners.data();
    if (content == VtuContent::ScaledJacobian) return quality.data();
    if (content == VtuContent::VertexTags) return tags.data();
    if (content == VtuContent::Regions) return mesh.regions.data();
    if (content == VtuContent::EdgeTags) return edgeRows.data();
    if (content == VtuContent::QuadTags) return quadRows.data();
    return mesh.points.data();
  }
  [[nodiscard]] std::span<const CornerSet> generatorCorners() const {
    return mesh.generatorCorners;
  }
  static constexpr std::uint8_t kType = kVtkHexahedron;
};

/// Writes the arrays of one mesh.
template <class Content>
class ArrayWriter {
 public:
  ArrayWriter(const Content& content, const VtuLayout& layout, Stage& stage)
      : content_(content), layout_(layout), progress_(stage, layout.tailPosition()) {}

  template <class Output>
  void write(Output& output, const VtuArray& array) {
    switch (array.content) {
      case VtuContent::GeneratorTet:
      case VtuContent::GeneratorCorners:
      case VtuContent::ScaledJacobian:
      case VtuContent::VertexTags:
      case VtuContent::Regions:
      case VtuContent::EdgeTags:
      case VtuContent::TriangleTags:
      case VtuContent::QuadTags:
      case VtuContent::Map:
      case VtuContent::Points:
        return fromMemory(output, content_.inMemory(array.content), array.bytes);
      case VtuContent::GeneratorKind:
      case VtuContent::Connectivity:
      case VtuContent::Offsets:
      case VtuContent::Types:
        computed(output, array);
    }
  }

 private:
  template <class Output>
  void fromMemory(Output& output, const void* values, std::uint64_t bytes) {
    const char* const data = static_cast<const char*>(values);
    for (std::uint64_t begin = 0; begin < bytes; begin += kSliceBytes) {
      const std::size_t size = std::min<std::uint64_t>(kSliceBytes, bytes - begin);
      output.writeBytes(data + begin, size);
      progress_.advance(size);
    }
  }

  template <class Output>
  void computed(Output& output, const VtuArray& array) {
    const bool ofPoints = array.content == VtuContent::GeneratorKind;
    const std::size_t count = ofPoints ? content_.pointCount() : content_.cells().size();
    if (count == 0) return;
    const std::size_t bytesEach = array.bytes / count;
    const std::size_t slice = kSliceBytes / bytesEach;
    for (std::size_t begin = 0; begin < count; begin += slice) {
      const std::size_t size = std::min(slice, count - begin);
      writeSlice(output, array.content, begin, size);
      progress_.advance(size * bytesEach);
    }
  }

  template <class Output>
  void writeSlice(Output& output, VtuContent content, std::size_t begin, std::size_t size) {
    const auto cells = content_.cells();
    if (content == VtuContent::GeneratorKind) {
      writeGeneratorKinds(output, content_.generatorCorners().subspan(begin, size));
    } else if (content == VtuContent::Connectivity) {
      writeConnectivity(output, cells.subspan(begin, size), layout_.wideConnectivity());
    } else if (content == VtuContent::Offsets) {
      constexpr std::size_t kCorners = std::tuple_size_v<typename decltype(cells)::value_type>;
      writeOffsets(output, begin, size, layout_.wideOffsets(), kCorners);
    } else {
      writeTypes(output, size, Content::kType);
    }
  }

  const Content& content_;
  const VtuLayout& layout_;
  LoopProgress progress_;
};

template <class Content>
void writePlain(OutputFile& output, const VtuLayout& layout, ArrayWriter<Content>& writer) {
  output.write(layout.head());
  for (const VtuArray& array : layout.arrays()) {
    output.writeBytes(&array.bytes, sizeof(array.bytes));
    writer.write(output, array);
  }
}

/// The head, which says where arrays begin, comes last, to the place that is kept free for it.
template <class Content>
void writeCompressed(OutputFile& output, const VtuLayout& layout, ArrayWriter<Content>& writer,
                     int threads) {
  std::vector<std::uint64_t> offsets(layout.arrays().size(), 0);
  const std::string room = layout.compressedHead(offsets);
  output.write(room);
  std::uint64_t position = room.size();
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    offsets[i] = position - room.size();
    VtuBlocks blocks(output, position, layout.arrays()[i].bytes, threads);
    writer.write(blocks, layout.arrays()[i]);
    position = blocks.finish();
  }
  const std::string head = layout.compressedHead(offsets);
  output.flush();
  output.writeBytesAt(0, head.data(), head.size());
}

void requireCompressible(const OutputFile& output, const std::filesystem::path& file) {
  if (!hasZlib()) {
    throw Error(ErrorCode::FileUnsupported,
                file.string() +
                    ": this program was built without zlib and cannot compress files. Write the "
                    "file without compression.");
  }
  if (output.hasPositions()) return;
  throw Error(ErrorCode::FileWrite,
              file.string() +
                  ": the file was not written because it is a device or a pipe, to which no "
                  "compressed .vtu file can be written. Name a file.");
}

template <class Content>
void writeFile(OutputFile& output, const Content& content, const VtuLayout& layout, bool compress,
               Stage& stage) {
  ArrayWriter<Content> writer(content, layout, stage);
  if (compress) {
    writeCompressed(output, layout, writer, stage.context().threads());
  } else {
    writePlain(output, layout, writer);
  }
  output.write(VtuLayout::tail());
  output.commit();
}

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

}  // namespace

void writeVtu(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
              Context& context) {
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  if (options.compress) requireCompressible(output, file);
  Array<double> computedQuality;
  std::span<const double> quality = options.scaledJacobians;
  if (quality.empty()) quality = computedQuality = scaledJacobians(mesh, context);
  Stage stage(context, "write mesh");
  VtuShape shape;
  shape.points = mesh.points.size();
  shape.cells = mesh.cells.size();
  shape.generatorTets = !mesh.generatorTet.empty();
  shape.generatorCorners = !mesh.generatorCorners.empty();
  shape.scaledJacobians = true;
  shape.vertexTags = !mesh.features.vertices.empty();
  shape.regions = !mesh.regions.empty();
  shape.edgeTags = mesh.features.edges.size();
  shape.quadTags = mesh.features.quads.size();
  writeFile(output, HexContent(mesh, quality), VtuLayout(shape), options.compress, stage);
}

void writeVtuMap(const TetMap& map, const std::filesystem::path& file, const WriteOptions& options,
                 Context& context) {
  Stage stage(context, "write map");
  requirePlainName(options.mapArray);
  OutputFile output(file);
  if (options.compress) requireCompressible(output, file);
  withThreads(context.threads(), [&] { requireWritable(map, stage); });
  VtuShape shape{map.points.size(), map.tets.size()};
  shape.corners = std::tuple_size_v<Tet>;
  shape.map = options.mapArray;
  shape.vertexTags = !map.features.vertices.empty();
  shape.regions = !map.regions.empty();
  shape.edgeTags = map.features.edges.size();
  shape.triangleTags = map.features.faces.size();
  writeFile(output, MapContent{map}, VtuLayout(shape), options.compress, stage);
}

}  // namespace hexhex
