// Writes MSH 4.1, as text and as bytes: what differs is how a number looks.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>

namespace hexhex {

/// Elements of one kind that belong together.
struct GmshEntity {
  std::uint32_t tag;
  std::uint32_t physical;  ///< number of the physical group
  std::size_t begin;
  std::size_t end;
};

[[nodiscard]] inline std::vector<GmshEntity> entitiesOf(const std::vector<ElementGroup>& groups) {
  std::vector<GmshEntity> entities;
  entities.reserve(groups.size());
  for (const ElementGroup& group : groups) {
    entities.push_back({group.number, group.number, group.begin, group.end});
  }
  return entities;
}

/// A point entity is one point: each vertex of a group is an entity of its own.
[[nodiscard]] inline std::vector<GmshEntity> pointsOf(const std::vector<ElementGroup>& groups) {
  std::vector<GmshEntity> entities;
  for (const ElementGroup& group : groups) {
    for (std::size_t i = group.begin; i < group.end; ++i) {
      entities.push_back({static_cast<std::uint32_t>(i + 1), group.number, i, i + 1});
    }
  }
  return entities;
}

/// What the elements of a file are sorted into.
struct GmshGroups {
  VertexGroups vertices;
  EdgeGroups edges;
  QuadGroups quads;
  CellGroups cells;
  std::array<std::vector<GmshEntity>, 4> entities;  ///< by dimension

  /// @throws Error InvalidArgument for features that are not in the mesh
  GmshGroups(const HexMesh& mesh, double patchAngle, Stage& stage)
      : vertices(groupVertices(mesh)),
        edges(groupEdges(mesh)),
        quads(groupQuads(mesh, patchAngle, stage)),
        cells(groupCells(mesh)),
        entities{pointsOf(vertices.groups), entitiesOf(edges.groups), entitiesOf(quads.groups),
                 entitiesOf(cells.groups)} {}

  [[nodiscard]] std::array<const std::vector<ElementGroup>*, 4> byDimension() const {
    return {&vertices.groups, &edges.groups, &quads.groups, &cells.groups};
  }
};

inline void writePhysicalNames(OutputFile& output, const GmshGroups& groups) {
  std::size_t count = 0;
  for (const auto* const kind : groups.byDimension()) count += kind->size();
  output.write("$PhysicalNames\n").write(count).write('\n');
  for (unsigned dimension = 0; dimension < 4; ++dimension) {
    for (const ElementGroup& group : *groups.byDimension()[dimension]) {
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
/// @tparam Content  points, a span of Vec3; groups, a GmshGroups; elementCount(); and
///         forEachKind(f), which calls f(dimension, type, elements) for dimensions 0 to 3, with
///         Gmsh's type of elements; elements has size(), subspan(begin, count), and operator[](i),
///         a range of Index with the same size() for all i
template <class Numbers, class Content>
class Msh41Writer {
 public:
  Msh41Writer(OutputFile& output, const Content& content, Stage& stage, int threads)
      : output_(output),
        lines_(output, threads),
        content_(content),
        progress_(stage, 2 * content.points.size() + content.elementCount()) {}

  void write() {
    output_.write("$MeshFormat\n4.1 ").write(Numbers::kFileType).write(" 8\n");
    Numbers::endianness(output_);
    output_.write("$EndMeshFormat\n");
    writePhysicalNames(output_, content_.groups);
    writeEntities();
    writeNodes();
    writeElements();
  }

 private:
  using Box = std::array<Vec3, 2>;

  static void extend(Box& box, const Vec3& point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box[0][axis] = std::min(box[0][axis], point[axis]);
      box[1][axis] = std::max(box[1][axis], point[axis]);
    }
  }
  static constexpr Box emptyBox() {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return {Vec3{kFar, kFar, kFar}, Vec3{-kFar, -kFar, -kFar}};
  }
  /// The smallest box around all points.
  [[nodiscard]] Box boxOfAll() const {
    Box box = emptyBox();
    for (const Vec3& point : content_.points) extend(box, point);
    return content_.points.empty() ? Box{} : box;
  }
  /// The smallest box around the points of elements.
  template <class Elements>
  [[nodiscard]] Box boxOf(const Elements& elements) const {
    Box box = emptyBox();
    for (std::size_t i = 0; i < elements.size(); ++i) {
      for (const Index node : elements[i]) extend(box, content_.points[node]);
    }
    return elements.size() == 0 ? Box{} : box;
  }

  void writeEntities() {
    output_.write("$Entities\n");
    const auto& entities = content_.groups.entities;
    for (const auto& ofDimension : entities) sizes({ofDimension.size()});
    Numbers::endLine(output_);
    content_.forEachKind([&](unsigned dimension, unsigned /*type*/, const auto& elements) {
      for (const GmshEntity& entity : entities[dimension]) {
        this->writeEntity(dimension, entity,
                          elements.subspan(entity.begin, entity.end - entity.begin));
      }
    });
    endSection("$EndEntities\n");
  }

  template <class Elements>
  void writeEntity(unsigned dimension, const GmshEntity& entity, const Elements& elements) {
    // A volume has all points, each of which is looked at once then.
    const Box box = dimension == 3 ? boxOfAll() : boxOf(elements);
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
    const std::span<const Vec3> points(content_.points);
    output_.write("$Nodes\n");
    const std::size_t blocks = points.empty() ? 0 : 1;
    sizes({blocks, points.size(), blocks, points.size()});
    Numbers::endLine(output_);
    if (blocks == 1) {
      const std::uint32_t volume = content_.groups.entities[3].front().tag;
      for (const std::uint32_t number : {3U, volume, 0U}) Numbers::integer(output_, number);
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
    forEachBlock(
        [&](unsigned dimension, unsigned type, std::uint32_t entity, const auto& elements) {
          for (const std::uint32_t number : {dimension, entity, type}) {
            Numbers::integer(output_, number);
          }
          sizes({elements.size()});
          Numbers::endLine(output_);
          writeBlock(tag, elements);
          tag += elements.size();
        });
    endSection("$EndElements\n");
  }

  /// Calls f(dimension, type, entity, elements of the entity) for the entities that are not empty.
  template <class F>
  void forEachBlock(const F& f) const {
    content_.forEachKind([&](unsigned dimension, unsigned type, const auto& elements) {
      for (const GmshEntity& entity : content_.groups.entities[dimension]) {
        if (entity.begin == entity.end) continue;
        f(dimension, type, entity.tag, elements.subspan(entity.begin, entity.end - entity.begin));
      }
    });
  }

  /// @param elements  not empty
  template <class Elements>
  void writeBlock(std::uint64_t firstTag, const Elements& elements) {
    const auto element = [&elements, firstTag](char* place, std::size_t i) {
      place = Numbers::size(place, firstTag + i);
      for (const Index node : elements[i]) {
        place = Numbers::size(place, std::uint64_t{node} + 1);
      }
      return Numbers::endLine(place);
    };
    lines_.write(elements.size(), (elements[0].size() + 1) * Numbers::kRoom + 1, element,
                 &progress_);
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
  const Content& content_;
  LoopProgress progress_;
};

}  // namespace hexhex
