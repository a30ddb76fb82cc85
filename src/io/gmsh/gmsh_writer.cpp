// The writing half of gmsh.hpp.
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/output_file.hpp>
#include <io/gmsh/gmsh.hpp>
#include <io/gmsh/msh41_writer.hpp>

namespace hexhex::io {
namespace {

template <std::size_t n>
constexpr std::integral_constant<std::size_t, n> kNodes;

/// Calls f(kind) for the elements of each dimension, in the order of the file.
template <class F>
void forEachKind(const HexMesh& mesh, const GmshGroups& groups, const F& f) {
  const auto of = [](const auto& elements) {
    return [&elements](std::size_t i) -> const auto& { return elements[i]; };
  };
  f(GmshKind{0U, kGmshPoint, kNodes<1>, of(groups.vertices.elements)});
  f(GmshKind{1U, kGmshLine, kNodes<2>, of(groups.edges.elements)});
  f(GmshKind{2U, kGmshQuad, kNodes<4>, of(groups.quads.elements)});
  f(GmshKind{3U, kGmshHexahedron, kNodes<8>,
             [&](std::size_t i) -> const Hex& { return mesh.cells[groups.cells.at(i)]; }});
}

template <class Numbers>
void writeMsh41(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context) {
  Stage stage(context, "write mesh");
  // First, so that a folder that is not writable shows at once.
  Msh41Writer<Numbers> writer(file, context.threads());
  const GmshGroups groups(MeshGroups(mesh, options.patchAngle, stage));
  writer.write(
      mesh.points, groups, [&](const auto& f) { forEachKind(mesh, groups, f); }, stage);
}

/// A mesh in pieces: one volume. Its box stands in front of the nodes but is known only behind
/// them, and is written to its place in the end.
class GmshStream : private Msh41Writer<BinaryNumbers> {
 public:
  GmshStream(const std::filesystem::path& file, int threads) : Msh41Writer(file, threads) {
    output().requirePositions("to which a .msh file cannot be written in pieces");
  }

  void begin(std::uint64_t points, std::uint64_t cells) {
    groups_ = GmshGroups(MeshGroups(cells));
    beginEntities(groups_);
    writeEntity(3, volume(), box_);
    beginNodes(groups_, points);
  }
  void points(const PointPiece& piece) {
    for (const Vec3& point : piece.points) box_.add(point);
    writePoints(piece.points);
  }
  void beginCells() {
    beginElements(groups_);
    beginBlock(3, volume(), kGmshHexahedron);
  }
  template <class Cell>
  void cells(std::uint64_t first, std::span<const Cell> cells) {
    writeElements(first + 1, cells.size(), kNodes<8>,
                  [cells](std::size_t i) -> const Cell& { return cells[i]; });
  }
  void end() {
    rewriteBox(box_);
    Msh41Writer::end();
  }

 private:
  [[nodiscard]] const GmshEntity& volume() const { return groups_.entities[3].front(); }

  GmshGroups groups_{MeshGroups(0)};
  Box box_;
};

}  // namespace

void writeGmsh41Binary(const HexMesh& mesh, const std::filesystem::path& file,
                       const WriteOptions& options, Context& context) {
  writeMsh41<BinaryNumbers>(mesh, file, options, context);
}

void writeGmsh41Text(const HexMesh& mesh, const std::filesystem::path& file,
                     const WriteOptions& options, Context& context) {
  writeMsh41<TextNumbers>(mesh, file, options, context);
}

void writeGmsh22Text(const HexMesh& mesh, const std::filesystem::path& file,
                     const WriteOptions& options, Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);
  const GmshGroups groups(MeshGroups(mesh, options.patchAngle, stage));
  requireInt32(mesh.points.size(), "MSH 2.2 numbers nodes", "write MSH 4.1");
  requireInt32(groups.elementCount(), "MSH 2.2 numbers elements", "write MSH 4.1");
  LineWriter lines(output, context.threads());
  LoopProgress progress(stage, mesh.points.size() + groups.elementCount());
  output.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  writePhysicalNames(output, groups);
  output.write("$Nodes\n").write(mesh.points.size()).write('\n');
  const auto node = [&mesh](char* place, std::size_t i) {
    place = put(put(place, std::uint64_t{i} + 1), ' ');
    return put(putNumbers(place, mesh.points[i]), '\n');
  };
  lines.write(mesh.points.size(), 4 * (kNumberRoom + 1), node, &progress);
  output.write("$EndNodes\n$Elements\n").write(groups.elementCount()).write('\n');
  std::uint64_t tag = 1;
  forEachKind(mesh, groups, [&](const auto& kind) {
    for (const GmshEntity& entity : groups.entities[kind.dimension]) {
      const auto element = [&](char* place, std::size_t i) {
        const std::array<std::uint64_t, 5> head = {tag + i, kind.type, 2, entity.physical,
                                                   entity.tag};
        place = putNumbers(place, head);
        const auto& nodes = kind.at(entity.begin + i);
        for (std::size_t k = 0; k < kind.nodes; ++k) {
          place = put(put(place, ' '), std::uint64_t{nodes[k]} + 1);
        }
        return put(place, '\n');
      };
      lines.write(entity.size(), (kind.nodes + 5) * (kNumberRoom + 1), element, &progress);
      tag += entity.size();
    }
  });
  output.write("$EndElements\n");
  output.commit();
}

std::unique_ptr<MeshSink> openGmsh41BinarySink(const std::filesystem::path& file,
                                               Context& context) {
  return openWriterSink<GmshStream>(file, context);
}

}  // namespace hexhex::io
