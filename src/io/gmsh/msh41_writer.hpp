// Writes MSH 4.1, as text and as bytes: what differs is how a number looks. A whole mesh and a mesh
// in pieces have the same sections.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>

namespace hexhex::io {

/// Elements of one kind that belong together.
struct GmshEntity {
  std::uint32_t tag;
  std::uint32_t physical;  ///< number of the physical group
  std::size_t begin;
  std::size_t end;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// What the elements of a file are sorted into.
struct GmshGroups : MeshGroups {
  std::array<std::vector<GmshEntity>, 4> entities;  ///< by dimension

  explicit GmshGroups(MeshGroups groups) : MeshGroups(std::move(groups)) {
    // A point entity is one point: each vertex of a group is an entity of its own.
    for (const ElementGroup& group : vertices.groups) {
      for (std::size_t i = group.begin; i < group.end; ++i) {
        entities[0].push_back({static_cast<std::uint32_t>(i + 1), group.number, i, i + 1});
      }
    }
    for (std::size_t dimension = 1; dimension < 4; ++dimension) {
      for (const ElementGroup& group : *byDimension()[dimension]) {
        entities[dimension].push_back({group.number, group.number, group.begin, group.end});
      }
    }
  }

  [[nodiscard]] std::array<const std::vector<ElementGroup>*, 4> byDimension() const {
    return {&vertices.groups, &edges.groups, &quads.groups, &cells.groups};
  }
};

/// The elements of one dimension.
/// @tparam Count  a number, or a constant
/// @tparam At     at(i)[k] is node k of element i
template <class Count, class At>
struct GmshKind {
  unsigned dimension;
  unsigned type;  ///< Gmsh's
  Count nodes;    ///< of each element
  At at;
};
template <class Count, class At>
GmshKind(unsigned, unsigned, Count, At) -> GmshKind<Count, At>;

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
  static constexpr bool kIsBinary = false;
  static constexpr std::size_t kRoom = kNumberRoom + 1;

  static char* size(char* place, std::uint64_t number) { return put(put(place, number), ' '); }
  static char* point(char* place, const Vec3& point) { return putNumbers(place, point); }
  static char* endLine(char* place) { return put(place, '\n'); }
  template <class Number>
  static void write(OutputFile& output, Number number) {
    output.write(number).write(' ');
  }
};

/// Numbers of MSH 4.1 as bytes.
class BinaryNumbers {
 public:
  static constexpr bool kIsBinary = true;
  static constexpr std::size_t kRoom = 8;

  static char* size(char* place, std::uint64_t number) { return putBytes(place, number); }
  static char* point(char* place, const Vec3& point) { return putBytes(place, point); }
  static char* endLine(char* place) { return place; }
  template <class Number>
  static void write(OutputFile& output, Number number) {
    writeBytesOf(output, number);
  }
};

/// Writes one file front to back.
template <class Numbers>
class Msh41Writer {
 public:
  Msh41Writer(const std::filesystem::path& file, int threads)
      : output_(file), lines_(output_, threads) {}

  /// A whole mesh.
  /// @param forEachKind  calls its argument with the GmshKind of each dimension, 0 to 3
  template <class ForEachKind>
  void write(std::span<const Vec3> points, const GmshGroups& groups, const ForEachKind& forEachKind,
             Stage& stage) {
    LoopProgress progress(stage, 2 * points.size() + groups.elementCount());
    progress_ = &progress;
    Box boxOfAll;
    for (const Vec3& point : points) boxOfAll.add(point);
    beginEntities(groups);
    forEachKind([&](const auto& kind) {
      for (const GmshEntity& entity : groups.entities[kind.dimension]) {
        // A volume has all points, each of which is looked at once then.
        const Box box = kind.dimension == 3 ? boxOfAll : boxOf(kind, entity, points);
        this->writeEntity(kind.dimension, entity, box);
      }
    });
    beginNodes(groups, points.size());
    writePoints(points);
    beginElements(groups);
    std::uint64_t tag = 1;
    forEachKind([&](const auto& kind) {
      for (const GmshEntity& entity : groups.entities[kind.dimension]) {
        this->beginBlock(kind.dimension, entity, kind.type);
        this->writeElements(tag, entity.size(), kind.nodes, [&](std::size_t i) -> decltype(auto) {
          return kind.at(entity.begin + i);
        });
        tag += entity.size();
      }
    });
    end();
  }

 protected:
  /// The smallest box around points; around none, all of it is 0.
  class Box {
   public:
    void add(const Vec3& point) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lower_[axis] = std::min(lower_[axis], point[axis]);
        upper_[axis] = std::max(upper_[axis], point[axis]);
      }
    }
    [[nodiscard]] std::array<Vec3, 2> corners() const {
      if (lower_[0] > upper_[0]) return {};
      return {lower_, upper_};
    }

   private:
    static constexpr double kFar = std::numeric_limits<double>::infinity();
    Vec3 lower_ = {kFar, kFar, kFar};
    Vec3 upper_ = {-kFar, -kFar, -kFar};
  };

  // The parts of a file, in their order. Each ends the section before it.

  /// All before the entities.
  void beginEntities(const GmshGroups& groups) {
    output_.write("$MeshFormat\n4.1 ").write(Numbers::kIsBinary ? '1' : '0').write(" 8\n");
    if (Numbers::kIsBinary) {
      writeBytesOf(output_, std::uint32_t{1});
      output_.write('\n');
    }
    output_.write("$EndMeshFormat\n");
    writePhysicalNames(output_, groups);
    output_.write("$Entities\n");
    for (const auto& ofDimension : groups.entities) sizes({ofDimension.size()});
    endLine();
  }

  void writeEntity(unsigned dimension, const GmshEntity& entity, const Box& box) {
    integers({entity.tag});
    boxPosition_ = output_.position();
    const std::array<Vec3, 2> corners = box.corners();
    // A point has a position instead of a box.
    for (std::size_t corner = 0; corner < (dimension == 0 ? 1U : 2U); ++corner) {
      for (const double coordinate : corners[corner]) Numbers::write(output_, coordinate);
    }
    sizes({1});
    integers({entity.physical});
    // What bounds an entity is left open: patches of features need not be whole boundaries.
    if (dimension > 0) sizes({0});
    endLine();
  }
  /// Replaces the box of the last entity, in a file of bytes.
  void rewriteBox(const Box& box) {
    output_.flush();
    std::array<char, sizeof(Vec3) * 2> bytes;  // NOLINT(*-member-init): filled at once
    char* place = bytes.data();
    for (const Vec3& corner : box.corners()) place = putBytes(place, corner);
    output_.writeBytesAt(boxPosition_, bytes.data(), bytes.size());
  }

  /// All before the points.
  void beginNodes(const GmshGroups& groups, std::size_t count) {
    endSection("$EndEntities\n");
    output_.write("$Nodes\n");
    const std::size_t blocks = std::min<std::size_t>(count, 1);
    sizes({blocks, count, blocks, count});
    endLine();
    if (count == 0) return;
    integers({3, groups.entities[3].front().tag, 0});
    sizes({count});
    endLine();
    const auto tag = [](char* place, std::size_t i) {
      return Numbers::endLine(Numbers::size(place, i + 1));
    };
    lines_.write(count, Numbers::kRoom + 1, tag, progress_);
  }

  void writePoints(std::span<const Vec3> points) {
    const auto point = [points](char* place, std::size_t i) {
      return Numbers::endLine(Numbers::point(place, points[i]));
    };
    lines_.write(points.size(), 3 * Numbers::kRoom + 1, point, progress_);
  }

  void beginElements(const GmshGroups& groups) {
    endSection("$EndNodes\n");
    output_.write("$Elements\n");
    const std::size_t count = groups.elementCount();
    std::size_t blocks = 0;
    for (const auto& ofDimension : groups.entities) {
      for (const GmshEntity& entity : ofDimension) blocks += entity.size() > 0 ? 1 : 0;
    }
    sizes({blocks, count, std::min<std::size_t>(count, 1), count});
    endLine();
  }

  /// The elements of an entity have a block, if there are any.
  void beginBlock(unsigned dimension, const GmshEntity& entity, unsigned type) {
    if (entity.size() == 0) return;
    integers({dimension, entity.tag, type});
    sizes({entity.size()});
    endLine();
  }

  /// @param nodes, at  as in GmshKind
  template <class Count, class At>
  void writeElements(std::uint64_t firstTag, std::size_t count, Count nodes, const At& at) {
    const auto element = [&](char* place, std::size_t i) {
      place = Numbers::size(place, firstTag + i);
      const auto& ofElement = at(i);
      for (std::size_t k = 0; k < nodes; ++k) {
        place = Numbers::size(place, std::uint64_t{ofElement[k]} + 1);
      }
      return Numbers::endLine(place);
    };
    lines_.write(count, (nodes + 1) * Numbers::kRoom + 1, element, progress_);
  }

  void end() {
    endSection("$EndElements\n");
    output_.commit();
  }

  [[nodiscard]] const OutputFile& output() const noexcept { return output_; }

 private:
  template <class Kind>
  [[nodiscard]] static Box boxOf(const Kind& kind, const GmshEntity& entity,
                                 std::span<const Vec3> points) {
    Box box;
    for (std::size_t i = entity.begin; i < entity.end; ++i) {
      const auto& element = kind.at(i);
      for (std::size_t k = 0; k < kind.nodes; ++k) box.add(points[element[k]]);
    }
    return box;
  }

  void integers(std::initializer_list<std::uint32_t> numbers) {
    for (const std::uint32_t number : numbers) Numbers::write(output_, number);
  }
  void sizes(std::initializer_list<std::uint64_t> numbers) {
    for (const std::uint64_t number : numbers) Numbers::write(output_, number);
  }
  void endLine() {
    if (!Numbers::kIsBinary) output_.write('\n');
  }
  void endSection(std::string_view end) {
    // Behind bytes the end has to begin a line.
    if (Numbers::kIsBinary) output_.write('\n');
    output_.write(end);
  }

  OutputFile output_;
  LineWriter lines_;
  LoopProgress* progress_ = nullptr;
  std::uint64_t boxPosition_ = 0;
};

}  // namespace hexhex::io
