// The writing half of medit.hpp: one writer of sections over two encodings of numbers. A mesh in
// memory is one piece of a stream, with groups.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/medit/medit.hpp>

namespace hexhex::io {
namespace {

struct MeditCounts {
  std::uint64_t vertices = 0;
  std::uint64_t edges = 0;
  std::uint64_t quads = 0;
  std::uint64_t hexahedra = 0;
};

/// What stands beside vertices and cells.
struct MeditGroups {
  Array<std::uint32_t> vertexReferences;  ///< empty: all are 0
  EdgeGroups edges;
  Array<std::uint32_t> edgeReferences;
  QuadGroups quads;
  Array<std::uint32_t> quadReferences;
  Array<std::uint32_t> cellReferences;  ///< empty: all are 1

  MeditGroups(const HexMesh& mesh, bool withEdges, double patchAngle, Stage& stage)
      : vertexReferences(io::vertexReferences(mesh, groupVertices(mesh))),
        cellReferences(io::cellReferences(mesh, Untagged::Zero)) {
    if (withEdges) edges = groupEdges(mesh);
    edgeReferences = groupNumbers(edges.groups);
    withThreads(stage.context().threads(), [&] { quads = groupQuads(mesh, patchAngle, stage); });
    quadReferences = groupNumbers(quads.groups, Untagged::Zero);
  }
};

/// `.mesh`: a line for each element. Tagged edges stay out: viewers that read no more than what
/// they show stumble over the section.
class MeditLines {
 public:
  static constexpr bool kHoldsEdges = false;
  static constexpr std::size_t kRoom = kNumberRoom + 1;  // of a number

  explicit MeditLines(OutputFile& output) : output_(output) {}

  void begin(const MeditCounts& /*counts*/, std::uint32_t /*version*/) {
    output_.write("MeshVersionFormatted 2\nDimension 3\n");
  }
  void beginSection(MeditSection section, std::uint64_t count, std::uint64_t /*integers*/,
                    std::uint64_t /*reals*/ = 0) {
    const auto isIt = [section](const auto& keyword) { return keyword.first == section; };
    const auto keyword = std::find_if(kMeditKeywords.begin(), kMeditKeywords.end(), isIt);
    output_.write(keyword->second).write('\n').write(count).write('\n');
  }
  void end() { output_.write("End\n"); }

  static char* point(char* place, const Vec3& point) { return put(putNumbers(place, point), ' '); }
  static char* vertex(char* place, std::uint64_t number) { return put(put(place, number), ' '); }
  static char* reference(char* place, std::uint32_t number) {
    // Nearly all are 0 or 1, which cost a tenth of the writing otherwise.
    place = number < 10 ? put(place, static_cast<char>('0' + number)) : put(place, number);
    return put(place, '\n');
  }

 private:
  OutputFile& output_;
};

/// `.meshb`: each section says where the next one begins.
class MeditRecords {
 public:
  static constexpr bool kHoldsEdges = true;
  static constexpr std::size_t kRoom = 8;

  explicit MeditRecords(OutputFile& output) : output_(output) {}

  /// @param version  0: the smallest that holds such a mesh
  void begin(const MeditCounts& counts, std::uint32_t version) {
    setVersion(version == 0 ? versionFor(counts) : version);
    writeBytesOf(output_, std::uint32_t{1});  // tells the byte order
    writeBytesOf(output_, version_);
    position_ = 8;
    beginSection(MeditSection::Dimension, 4 + positionBytes() + 4);
    writeBytesOf(output_, std::uint32_t{3});
  }
  void beginSection(MeditSection section, std::uint64_t count, std::uint64_t integers,
                    std::uint64_t reals = 0) {
    beginSection(section, bytesOf(count, integers, reals));
    writeInteger(count, integerBytes());
  }
  void end() {
    writeBytesOf(output_, MeditSection::End);
    writeInteger(0, positionBytes());
  }

  static char* point(char* place, const Vec3& point) { return putBytes(place, point); }
  char* vertex(char* place, std::uint64_t number) const {
    return version_ >= 4 ? putBytes(place, number)
                         : putBytes(place, static_cast<std::uint32_t>(number));
  }
  char* reference(char* place, std::uint32_t number) const { return vertex(place, number); }

 private:
  [[nodiscard]] std::uint64_t positionBytes() const { return version_ >= 3 ? 8 : 4; }
  [[nodiscard]] std::uint64_t integerBytes() const { return version_ >= 4 ? 8 : 4; }
  /// Of a section, with its head.
  [[nodiscard]] std::uint64_t bytesOf(std::uint64_t count, std::uint64_t integers,
                                      std::uint64_t reals) const {
    return 4 + positionBytes() + integerBytes() + count * (integers * integerBytes() + 8 * reals);
  }

  void setVersion(std::uint32_t version) { version_ = version; }
  std::uint32_t versionFor(const MeditCounts& counts) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
    if (std::max({counts.vertices, counts.quads, counts.hexahedra}) > kMost) return 4;
    setVersion(2);
    const std::uint64_t bytes = 64 + bytesOf(counts.vertices, 1, 3) + bytesOf(counts.edges, 3, 0) +
                                bytesOf(counts.quads, 5, 0) + bytesOf(counts.hexahedra, 9, 0);
    return bytes > kMost ? 3 : 2;
  }

  void beginSection(MeditSection section, std::uint64_t bytes) {
    position_ += bytes;
    writeBytesOf(output_, section);
    writeInteger(position_, positionBytes());
  }
  void writeInteger(std::uint64_t number, std::uint64_t bytes) {
    writeBytesOf(output_, static_cast<std::uint32_t>(number));
    if (bytes == 8) writeBytesOf(output_, static_cast<std::uint32_t>(number >> 32U));
  }

  OutputFile& output_;
  std::uint32_t version_ = 0;
  std::uint64_t position_ = 0;
};

/// Writes one file front to back.
template <class Encoding>
class MeditWriter {
 public:
  MeditWriter(const std::filesystem::path& file, int threads)
      : output_(file), lines_(output_, threads), encoding_(output_) {}

  /// A whole mesh.
  void write(const HexMesh& mesh, const MeditGroups& groups, std::uint32_t version, Stage& stage) {
    const MeditCounts counts = {mesh.points.size(), groups.edges.elements.size(),
                                groups.quads.elements.size(), mesh.cells.size()};
    LoopProgress progress(stage, counts.vertices + counts.edges + counts.quads + counts.hexahedra);
    encoding_.begin(counts, version);
    encoding_.beginSection(MeditSection::Vertices, counts.vertices, 1, 3);
    writeVertices(mesh.points, groups.vertexReferences, &progress);
    if (counts.edges > 0) {
      encoding_.beginSection(MeditSection::Edges, counts.edges, 3);
      writeElements(std::span(groups.edges.elements), groups.edgeReferences, &progress);
    }
    encoding_.beginSection(MeditSection::Quadrilaterals, counts.quads, 5);
    writeElements(std::span(groups.quads.elements), groups.quadReferences, &progress);
    encoding_.beginSection(MeditSection::Hexahedra, counts.hexahedra, 9);
    writeElements(std::span(mesh.cells), groups.cellReferences, &progress);
    end();
  }

  // A mesh in pieces.
  void begin(std::uint64_t vertices, std::uint64_t cells) {
    cells_ = cells;
    encoding_.begin({.vertices = vertices, .hexahedra = cells}, 0);
    encoding_.beginSection(MeditSection::Vertices, vertices, 1, 3);
  }
  void points(const PointPiece& piece) { writeVertices(piece.points, {}, nullptr); }
  void beginCells() { encoding_.beginSection(MeditSection::Hexahedra, cells_, 9); }
  template <class Cell>
  void cells(std::uint64_t /*first*/, std::span<const Cell> cells) {
    writeElements(cells, {}, nullptr);
  }
  void end() {
    encoding_.end();
    output_.commit();
  }

 private:
  /// @param references  empty: all are 0
  void writeVertices(std::span<const Vec3> points, std::span<const std::uint32_t> references,
                     LoopProgress* progress) {
    const auto vertex = [&](char* place, std::size_t i) {
      place = encoding_.point(place, points[i]);
      return encoding_.reference(place, references.empty() ? 0 : references[i]);
    };
    lines_.write(points.size(), 4 * Encoding::kRoom, vertex, progress);
  }

  /// @param references  empty: all are 1
  template <class Vertex, std::size_t n>
  void writeElements(std::span<const std::array<Vertex, n>> elements,
                     std::span<const std::uint32_t> references, LoopProgress* progress) {
    const auto element = [&](char* place, std::size_t i) {
      // 64 bits: 32 would wrap for the last vertex of the largest mesh.
      for (const Vertex vertex : elements[i]) {
        place = encoding_.vertex(place, std::uint64_t{vertex} + 1);
      }
      return encoding_.reference(place, references.empty() ? 1 : references[i]);
    };
    lines_.write(elements.size(), (n + 1) * Encoding::kRoom, element, progress);
  }

  OutputFile output_;
  LineWriter lines_;
  Encoding encoding_;
  std::uint64_t cells_ = 0;
};

template <class Encoding>
void writeWhole(const HexMesh& mesh, const std::filesystem::path& file, std::uint32_t version,
                const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  // First, so that a folder that is not writable shows at once.
  MeditWriter<Encoding> writer(file, context.threads());
  const MeditGroups groups(mesh, Encoding::kHoldsEdges, options.patchAngle, stage);
  writer.write(mesh, groups, version, stage);
}

}  // namespace

void writeMedit(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context) {
  writeWhole<MeditLines>(mesh, file, 0, options, context);
}

void writeMeshb(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context) {
  writeWhole<MeditRecords>(mesh, file, 0, options, context);
}

void writeMeshbVersion(const HexMesh& mesh, const std::filesystem::path& file,
                       std::uint32_t version, Context& context) {
  writeWhole<MeditRecords>(mesh, file, version, {}, context);
}

std::unique_ptr<MeshSink> openMeditSink(const std::filesystem::path& file, Context& context) {
  return openWriterSink<MeditWriter<MeditLines>>(file, context);
}

std::unique_ptr<MeshSink> openMeshbSink(const std::filesystem::path& file, Context& context) {
  return openWriterSink<MeditWriter<MeditRecords>>(file, context);
}

}  // namespace hexhex::io
