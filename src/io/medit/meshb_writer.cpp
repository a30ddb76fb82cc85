// The writing half of meshb.hpp.
#include <algorithm>
#include <cstdint>
#include <span>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/medit/meshb.hpp>
#include <io/medit/meshb_layout.hpp>

namespace hexhex {
namespace {

/// What goes into a file.
struct MeshbContent {
  const HexMesh& mesh;
  Array<std::uint32_t> vertexReferences;  ///< empty: all are 0
  EdgeGroups edges;
  Array<std::uint32_t> edgeReferences;
  QuadGroups quads;
  Array<std::uint32_t> quadReferences;
  Array<std::uint32_t> cellReferences;  ///< empty: all are 1
};

MeshbContent contentOf(const HexMesh& mesh, double patchAngle, Stage& stage, int threads) {
  MeshbContent content{mesh, vertexReferences(mesh, groupVertices(mesh)), groupEdges(mesh), {}, {},
                       {},   cellReferences(mesh, Untagged::Zero)};
  withThreads(threads, [&] { content.quads = groupQuads(mesh, patchAngle, stage); });
  content.edgeReferences = groupNumbers(content.edges.groups);
  content.quadReferences = groupNumbers(content.quads.groups, Untagged::Zero);
  return content;
}

/// Writes one file front to back.
class MeshbWriter {
 public:
  MeshbWriter(OutputFile& output, const MeshbContent& content, std::uint32_t version, Stage& stage,
              int threads)
      : output_(output),
        lines_(output, threads),
        content_(content),
        version_(version),
        widths_(version),
        progress_(stage, content.mesh.points.size() + content.edges.elements.size() +
                             content.quads.elements.size() + content.mesh.cells.size()) {}

  void write() {
    writeBytesOf(output_, std::uint32_t{1});  // tells the byte order
    writeBytesOf(output_, version_);
    position_ = 8;
    beginSection(MeshbKeyword::Dimension, 8 + widths_.position);
    writeBytesOf(output_, std::uint32_t{3});
    writeVertices();
    writeElements(MeshbKeyword::Edges, std::span(content_.edges.elements), content_.edgeReferences);
    writeElements(MeshbKeyword::Quadrilaterals, std::span(content_.quads.elements),
                  content_.quadReferences);
    writeElements(MeshbKeyword::Hexahedra, std::span(content_.mesh.cells), content_.cellReferences);
    writeBytesOf(output_, MeshbKeyword::End);
    writePosition(0);
  }

 private:
  /// The head of a section: its keyword, and where the next one begins.
  void beginSection(MeshbKeyword keyword, std::uint64_t bytes) {
    position_ += bytes;
    writeBytesOf(output_, keyword);
    writePosition(position_);
  }
  void writePosition(std::uint64_t position) { writeInteger(position, widths_.position); }
  void writeInteger(std::uint64_t number, std::uint64_t width) {
    writeBytesOf(output_, static_cast<std::uint32_t>(number));
    if (width == 8) writeBytesOf(output_, static_cast<std::uint32_t>(number >> 32U));
  }
  [[nodiscard]] char* putInteger(char* place, std::uint64_t number) const {
    return widths_.integer == 8 ? putBytes(place, number)
                                : putBytes(place, static_cast<std::uint32_t>(number));
  }

  void writeVertices() {
    const std::span<const Vec3> points(content_.mesh.points);
    const std::span<const std::uint32_t> references(content_.vertexReferences);
    beginSection(MeshbKeyword::Vertices, widths_.section(points.size(), 1, 3));
    writeInteger(points.size(), widths_.integer);
    const auto vertex = [&](char* place, std::size_t i) {
      return putInteger(putBytes(place, points[i]), references.empty() ? 0 : references[i]);
    };
    lines_.write(points.size(), 32, vertex, &progress_);
  }

  /// @param references  empty: all are 1
  template <std::size_t corners>
  void writeElements(MeshbKeyword keyword, std::span<const std::array<Index, corners>> elements,
                     std::span<const std::uint32_t> references) {
    if (elements.empty() && keyword == MeshbKeyword::Edges) return;
    beginSection(keyword, widths_.section(elements.size(), corners + 1, 0));
    writeInteger(elements.size(), widths_.integer);
    const auto element = [&](char* place, std::size_t i) {
      for (const Index vertex : elements[i]) place = putInteger(place, std::uint64_t{vertex} + 1);
      return putInteger(place, references.empty() ? 1 : references[i]);
    };
    lines_.write(elements.size(), 8 * (corners + 1), element, &progress_);
  }

  OutputFile& output_;
  LineWriter lines_;
  const MeshbContent& content_;
  std::uint32_t version_;
  MeshbWidths widths_;
  LoopProgress progress_;
  std::uint64_t position_ = 0;
};

std::uint32_t versionFor(const MeshbContent& content) {
  return meshbVersionFor({content.mesh.points.size(), content.edges.elements.size(),
                          content.quads.elements.size(), content.mesh.cells.size()});
}

void writeFile(const HexMesh& mesh, const std::filesystem::path& file, std::uint32_t version,
               const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  const MeshbContent content = contentOf(mesh, options.patchAngle, stage, context.threads());
  if (version == 0) version = versionFor(content);
  MeshbWriter(output, content, version, stage, context.threads()).write();
  output.commit();
}

}  // namespace

void writeMeshb(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context) {
  writeFile(mesh, file, 0, options, context);
}

void writeMeshbVersion(const HexMesh& mesh, const std::filesystem::path& file,
                       std::uint32_t version, Context& context) {
  writeFile(mesh, file, version, {}, context);
}

}  // namespace hexhex
