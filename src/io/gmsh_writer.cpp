// The writing half of gmsh.hpp. MSH 4.1 has the same content as text and as bytes: what differs is
// how a number looks.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/binary_lines.hpp>
#include <io/gmsh.hpp>
#include <io/line_writer.hpp>
#include <io/mesh_groups.hpp>
#include <io/output_file.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 14;

/// Elements of one kind that belong together.
struct GmshEntity {
  std::uint32_t tag;
  std::uint32_t physical;  ///< number of the physical group
  std::size_t begin;
  std::size_t end;
};

std::vector<GmshEntity> entitiesOf(const std::vector<ElementGroup>& groups) {
  std::vector<GmshEntity> entities;
  entities.reserve(groups.size());
  for (const ElementGroup& group : groups) {
    entities.push_back({group.number, group.number, group.begin, group.end});
  }
  return entities;
}

/// A point entity is one point: each vertex of a group is an entity of its own.
std::vector<GmshEntity> pointsOf(const std::vector<ElementGroup>& groups) {
  std::vector<GmshEntity> entities;
  for (const ElementGroup& group : groups) {
    for (std::size_t i = group.begin; i < group.end; ++i) {
      entities.push_back({static_cast<std::uint32_t>(i + 1), group.number, i, i + 1});
    }
  }
  return entities;
}

/// A mesh as Gmsh sees it.
struct GmshContent {
  const HexMesh& mesh;
  VertexGroups vertices;
  EdgeGroups edges;
  QuadGroups quads;
  CellGroups cells;
  Array<Hex> sortedCells;                           ///< by region; empty if they are that anyway
  std::array<std::vector<GmshEntity>, 4> entities;  ///< by dimension

  [[nodiscard]] std::size_t elementCount() const {
    return vertices.elements.size() + edges.elements.size() + quads.elements.size() +
           mesh.cells.size();
  }

  /// Calls f(dimension, entities, elements) for each kind of elements in the order of the file.
  template <class F>
  void forEachKind(const F& f) const {
    f(0U, entities[0], std::span(vertices.elements));
    f(1U, entities[1], std::span(edges.elements));
    f(2U, entities[2], std::span(quads.elements));
    f(3U, entities[3], std::span(sortedCells.empty() ? mesh.cells : sortedCells));
  }
};

constexpr std::array<unsigned, 4> kTypes = {kGmshPoint, kGmshLine, kGmshQuad, kGmshHexahedron};

GmshContent contentOf(const HexMesh& mesh, const WriteOptions& options, Stage& stage, int threads) {
  GmshContent content{mesh, groupVertices(mesh), groupEdges(mesh), {}, groupCells(mesh), {}, {}};
  withThreads(threads, [&] {
    content.quads = groupQuads(mesh, options.patchAngle, stage);
    if (content.cells.order.empty()) return;
    content.sortedCells.resize(mesh.cells.size());
    parallelFor(stage, mesh.cells.size(), kGrain,
                [&](std::size_t i) { content.sortedCells[i] = mesh.cells[content.cells.at(i)]; });
  });
  content.entities = {pointsOf(content.vertices.groups), entitiesOf(content.edges.groups),
                      entitiesOf(content.quads.groups), entitiesOf(content.cells.groups)};
  return content;
}

void extend(std::array<Vec3, 2>& box, const Vec3& point) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box[0][axis] = std::min(box[0][axis], point[axis]);
    box[1][axis] = std::max(box[1][axis], point[axis]);
  }
}

constexpr std::array<Vec3, 2> emptyBox() {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  return {Vec3{kFar, kFar, kFar}, Vec3{-kFar, -kFar, -kFar}};
}

/// The smallest box around all vertices.
std::array<Vec3, 2> boxOf(const HexMesh& mesh) {
  std::array<Vec3, 2> box = emptyBox();
  for (const Vec3& point : mesh.points) extend(box, point);
  return mesh.points.empty() ? std::array<Vec3, 2>{} : box;
}

/// The smallest box around the vertices of elements.
template <class Elements>
std::array<Vec3, 2> boxOf(const HexMesh& mesh, const Elements& elements) {
  std::array<Vec3, 2> box = emptyBox();
  for (const auto& element : elements) {
    for (const Index vertex : element) extend(box, mesh.points[vertex]);
  }
  return elements.empty() ? std::array<Vec3, 2>{} : box;
}

void writePhysicalNames(OutputFile& output, const GmshContent& content) {
  const std::array groups = {&content.vertices.groups, &content.edges.groups, &content.quads.groups,
                             &content.cells.groups};
  std::size_t count = 0;
  for (const auto* const kind : groups) count += kind->size();
  output.write("$PhysicalNames\n").write(count).write('\n');
  for (std::size_t dimension = 0; dimension < groups.size(); ++dimension) {
    for (const ElementGroup& group : *groups[dimension]) {
      output.write(dimension).write(' ').write(group.number).write(" \"").write(group.name);
      output.write("\"\n");
    }
  }
  output.write("$EndPhysicalNames\n");
}

/// Numbers of MSH 4.1 as text: with a space or a line break behind each.
class TextNumbers {
 public:
  static constexpr std::string_view kFileType = "0";
  static constexpr std::size_t kRoom = kNumberRoom + 1;

  static char* size(char* place, std::uint64_t number) { return put(put(place, number), ' '); }
  static char* point(char* place, const Vec3& point) { return putNumbers(place, point); }
  static char* endLine(char* place) { return put(place, '\n'); }
  static void integer(OutputFile& output, std::uint32_t number) { output.write(number).write(' '); }
  static void size(OutputFile& output, std::uint64_t number) { output.write(number).write(' '); }
  static void real(OutputFile& output, double number) { output.write(number).write(' '); }
  static void endLine(OutputFile& output) { output.write('\n'); }
  static void endianness(OutputFile& /*output*/) {}
};

/// Numbers of MSH 4.1 as bytes.
class BinaryNumbers {
 public:
  static constexpr std::string_view kFileType = "1";
  static constexpr std::size_t kRoom = 8;

  static char* size(char* place, std::uint64_t number) { return putBytes(place, number); }
  static char* point(char* place, const Vec3& point) { return putBytes(place, point); }
  static char* endLine(char* place) { return place; }
  static void integer(OutputFile& output, std::uint32_t number) { writeBytesOf(output, number); }
  static void size(OutputFile& output, std::uint64_t number) { writeBytesOf(output, number); }
  static void real(OutputFile& output, double number) { writeBytesOf(output, number); }
  static void endLine(OutputFile& /*output*/) {}
  static void endianness(OutputFile& output) {
    writeBytesOf(output, std::uint32_t{1});
    output.write('\n');
  }
};

/// Writes the sections of MSH 4.1.
template <class Numbers>
class Msh41Writer {
 public:
  Msh41Writer(OutputFile& output, const GmshContent& content, Stage& stage, int threads)
      : output_(output),
        lines_(output, threads),
        content_(content),
        progress_(stage, 2 * content.mesh.points.size() + content.elementCount()) {}

  void write() {
    output_.write("$MeshFormat\n4.1 ").write(Numbers::kFileType).write(" 8\n");
    Numbers::endianness(output_);
    output_.write("$EndMeshFormat\n");
    writePhysicalNames(output_, content_);
    writeEntities();
    writeNodes();
    writeElements();
  }

 private:
  void writeEntities() {
    output_.write("$Entities\n");
    for (const auto& entities : content_.entities) sizes({entities.size()});
    Numbers::endLine(output_);
    content_.forEachKind([this](unsigned dimension, const auto& entities, const auto& elements) {
      for (const GmshEntity& entity : entities) {
        this->writeEntity(dimension, entity,
                          elements.subspan(entity.begin, entity.end - entity.begin));
      }
    });
    endSection("$EndEntities\n");
  }

  template <class Elements>
  void writeEntity(unsigned dimension, const GmshEntity& entity, const Elements& elements) {
    // The volume has all vertices, each of which is looked at once then.
    const std::array<Vec3, 2> box =
        dimension == 3 ? boxOf(content_.mesh) : boxOf(content_.mesh, elements);
    Numbers::integer(output_, entity.tag);
    // A point has a position instead of a box.
    for (std::size_t corner = 0; corner < (dimension == 0 ? 1U : 2U); ++corner) {
      for (const double coordinate : box[corner]) Numbers::real(output_, coordinate);
    }
    sizes({1});
    Numbers::integer(output_, entity.physical);
    // What bounds an entity is left open: patches of features need not be whole boundaries.
    if (dimension > 0) sizes({0});
    Numbers::endLine(output_);
  }

  void writeNodes() {
    const std::span<const Vec3> points(content_.mesh.points);
    output_.write("$Nodes\n");
    const std::size_t blocks = points.empty() ? 0 : 1;
    sizes({blocks, points.size(), blocks, points.size()});
    Numbers::endLine(output_);
    if (blocks == 1) {
      for (const std::uint32_t number : {3U, 1U, 0U}) Numbers::integer(output_, number);
      sizes({points.size()});
      Numbers::endLine(output_);
    }
    const auto tag = [](char* place, std::size_t i) {
      return Numbers::endLine(Numbers::size(place, i + 1));
    };
    const auto point = [points](char* place, std::size_t i) {
      return Numbers::endLine(Numbers::point(place, points[i]));
    };
    lines_.write(points.size(), Numbers::kRoom + 1, tag, &progress_);
    lines_.write(points.size(), 3 * Numbers::kRoom + 1, point, &progress_);
    endSection("$EndNodes\n");
  }

  void writeElements() {
    output_.write("$Elements\n");
    const std::size_t count = content_.elementCount();
    std::size_t blocks = 0;
    forEachBlock([&](auto&&...) { ++blocks; });
    sizes({blocks, count, std::min<std::size_t>(count, 1), count});
    Numbers::endLine(output_);
    std::uint64_t tag = 1;
    forEachBlock([&](unsigned dimension, const GmshEntity& entity, const auto& elements) {
      for (const std::uint32_t number : {dimension, entity.tag, kTypes[dimension]}) {
        Numbers::integer(output_, number);
      }
      sizes({elements.size()});
      Numbers::endLine(output_);
      writeBlock(tag, elements);
      tag += elements.size();
    });
    endSection("$EndElements\n");
  }

  /// Calls f(dimension, entity, elements of the entity) for the entities that are not empty.
  template <class F>
  void forEachBlock(const F& f) const {
    content_.forEachKind([&f](unsigned dimension, const auto& entities, const auto& elements) {
      for (const GmshEntity& entity : entities) {
        if (entity.begin == entity.end) continue;
        f(dimension, entity, elements.subspan(entity.begin, entity.end - entity.begin));
      }
    });
  }

  template <std::size_t corners, std::size_t extent>
  void writeBlock(std::uint64_t firstTag,
                  std::span<const std::array<Index, corners>, extent> elements) {
    const auto element = [elements, firstTag](char* place, std::size_t i) {
      place = Numbers::size(place, firstTag + i);
      for (const Index vertex : elements[i]) {
        place = Numbers::size(place, std::uint64_t{vertex} + 1);
      }
      return Numbers::endLine(place);
    };
    lines_.write(elements.size(), (corners + 1) * Numbers::kRoom + 1, element, &progress_);
  }

  void sizes(std::initializer_list<std::uint64_t> numbers) {
    for (const std::uint64_t number : numbers) Numbers::size(output_, number);
  }
  void endSection(std::string_view end) {
    // Behind bytes the end has to begin a line.
    if (Numbers::kFileType == "1") output_.write('\n');
    output_.write(end);
  }

  OutputFile& output_;
  LineWriter lines_;
  const GmshContent& content_;
  LoopProgress progress_;
};

template <class Numbers>
void writeMsh41(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  const GmshContent content = contentOf(mesh, options, stage, context.threads());
  Msh41Writer<Numbers>(output, content, stage, context.threads()).write();
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
  writePhysicalNames(output, content);
  output.write("$Nodes\n").write(mesh.points.size()).write('\n');
  const auto node = [&mesh](char* place, std::size_t i) {
    place = put(put(place, std::uint64_t{i} + 1), ' ');
    return put(putNumbers(place, mesh.points[i]), '\n');
  };
  lines.write(mesh.points.size(), 4 * (kNumberRoom + 1), node, &progress);
  output.write("$EndNodes\n$Elements\n").write(content.elementCount()).write('\n');
  std::uint64_t tag = 1;
  content.forEachKind([&](unsigned dimension, const auto& entities, const auto& elements) {
    writeMsh22Elements(lines, tag, kTypes[dimension], entities, elements, progress);
    tag += elements.size();
  });
  output.write("$EndElements\n");
  output.commit();
}

}  // namespace hexhex
