// The writing half of gmsh.hpp.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <tuple>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/output_file.hpp>
#include <io/gmsh/gmsh.hpp>
#include <io/gmsh/gmsh_types.hpp>
#include <io/gmsh/msh41_writer.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 14;

/// A mesh as Gmsh sees it.
struct GmshContent {
  std::span<const Vec3> points;
  std::span<const Hex> given;  ///< cells as the mesh has them
  GmshGroups groups;
  Array<Hex> sortedCells;  ///< by region; empty if they are that anyway

  GmshContent(const HexMesh& mesh, const WriteOptions& options, Stage& stage)
      : points(mesh.points), given(mesh.cells), groups(mesh, options.patchAngle, stage) {
    if (groups.cells.order.empty()) return;
    sortedCells.resize(given.size());
    parallelFor(stage, given.size(), kGrain,
                [this](std::size_t i) { sortedCells[i] = given[groups.cells.at(i)]; });
  }

  [[nodiscard]] std::size_t elementCount() const {
    return groups.vertices.elements.size() + groups.edges.elements.size() +
           groups.quads.elements.size() + given.size();
  }

  /// Calls f(dimension, type, elements) for each kind of elements in the order of the file.
  template <class F>
  void forEachKind(const F& f) const {
    f(0U, kGmshPoint, std::span(groups.vertices.elements));
    f(1U, kGmshLine, std::span(groups.edges.elements));
    f(2U, kGmshQuad, std::span(groups.quads.elements));
    f(3U, kGmshHexahedron, sortedCells.empty() ? given : std::span<const Hex>(sortedCells));
  }
};

GmshContent contentOf(const HexMesh& mesh, const WriteOptions& options, Stage& stage, int threads) {
  std::optional<GmshContent> content;
  withThreads(threads, [&] { content.emplace(mesh, options, stage); });
  return std::move(*content);
}

template <class Numbers>
void writeMsh41(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  const GmshContent content = contentOf(mesh, options, stage, context.threads());
  Msh41Writer<Numbers, GmshContent>(output, content, stage, context.threads()).write();
  output.commit();
}

/// Writes the elements of one kind as lines "tag type 2 physical entity nodes".
template <class Elements>
void writeMsh22Elements(LineWriter& lines, std::uint64_t firstTag, unsigned type,
                        const std::vector<GmshEntity>& entities, const Elements& elements,
                        LoopProgress& progress) {
  constexpr std::size_t kCorners = std::tuple_size_v<typename Elements::value_type>;
  for (const GmshEntity& entity : entities) {
    const auto element = [&](char* place, std::size_t i) {
      const std::array<std::uint64_t, 5> head = {firstTag + entity.begin + i, type, 2,
                                                 entity.physical, entity.tag};
      place = putNumbers(place, head);
      for (const Index vertex : elements[entity.begin + i]) {
        place = put(put(place, ' '), std::uint64_t{vertex} + 1);
      }
      return put(place, '\n');
    };
    lines.write(entity.end - entity.begin, (kCorners + 5) * (kNumberRoom + 1), element, &progress);
  }
}

void requireSmall(std::size_t count, const char* what) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (count <= kMost) return;
  throw Error(ErrorCode::TooLarge, "MSH 2.2 numbers " + std::string(what) +
                                       " with 31 bits, which do not suffice for " +
                                       std::to_string(count) + "; write MSH 4.1.");
}

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
  const GmshContent content = contentOf(mesh, options, stage, context.threads());
  requireSmall(mesh.points.size(), "nodes");
  requireSmall(content.elementCount(), "elements");
  LineWriter lines(output, context.threads());
  LoopProgress progress(stage, mesh.points.size() + content.elementCount());
  output.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  writePhysicalNames(output, content.groups);
  output.write("$Nodes\n").write(mesh.points.size()).write('\n');
  const auto node = [&mesh](char* place, std::size_t i) {
    place = put(put(place, std::uint64_t{i} + 1), ' ');
    return put(putNumbers(place, mesh.points[i]), '\n');
  };
  lines.write(mesh.points.size(), 4 * (kNumberRoom + 1), node, &progress);
  output.write("$EndNodes\n$Elements\n").write(content.elementCount()).write('\n');
  std::uint64_t tag = 1;
  content.forEachKind([&](unsigned dimension, unsigned type, const auto& elements) {
    writeMsh22Elements(lines, tag, type, content.groups.entities[dimension], elements, progress);
    tag += elements.size();
  });
  output.write("$EndElements\n");
  output.commit();
}

}  // namespace hexhex
