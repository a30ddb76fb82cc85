// Writes `.msh` files (see formats.hpp): MSH 4.1 in text and binary, which share a writer over two
// encodings of numbers, for whole meshes, in pieces, and of higher order; and MSH 2.2.
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/box.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/line_writer.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {

namespace {

/// A set of elements.
struct GmshEntity {
  std::uint32_t tag;
  std::uint32_t physical;  ///< number of the physical group
  std::size_t begin;
  std::size_t end;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// The groups and entities of a file.
struct GmshGroups : MeshGroups {
  std::array<std::vector<GmshEntity>, 4> entities;  ///< by dimension
  /// Their parts with one kind of elements, by the number of corners of these.
  std::array<std::array<std::vector<GmshEntity>, 9>, 4> blocks;

  GmshGroups(const HexMesh& mesh, const WriteOptions& options, Stage& stage)
      : GmshGroups(MeshGroups(mesh, options, stage)) {
    if (othersOf(options).count() == 0) return;
    const AllCells all(mesh, othersOf(options));
    split(2, [this](std::size_t i) { return cornersOf(quads.elements[i]); });
    split(3, [&](std::size_t i) { return all[cells.at(i)].size(); });
  }
  /// For elements of one kind in each dimension.
  explicit GmshGroups(MeshGroups all) : MeshGroups(std::move(all)) {
    numberApart({&quads.groups, &cells.groups, &edges.groups, &vertices.groups});
    // A point entity is a single point, so each vertex of a group gets its own.
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
    for (std::size_t d = 0; d < 4; ++d) blocks[d][std::size_t{1} << d] = entities[d];
  }

  [[nodiscard]] std::array<const std::vector<ElementGroup>*, 4> byDimension() const {
    return {&vertices.groups, &edges.groups, &quads.groups, &cells.groups};
  }

 private:
  /// @param corners  corners(i): of element i
  template <class Corners>
  void split(std::size_t dimension, const Corners& corners) {
    auto& lists = blocks[dimension];
    for (const auto& [tag, physical, begin, end] :
         std::exchange(lists[std::size_t{1} << dimension], {})) {
      const auto add = [&, tag = tag, physical = physical](const ElementGroup& part) {
        lists[corners(part.begin)].push_back({tag, physical, part.begin, part.end});
      };
      splitByCorners({tag, {}, begin, end}, corners, add);
    }
  }
};

/// The elements of one kind.
/// @tparam Count  an integer or std::integral_constant
/// @tparam At     at(i)[k] is node k of element i
template <class Count, class At>
struct GmshKind {
  unsigned dimension;
  std::size_t corners;
  unsigned type;  ///< Gmsh's element type
  Count nodes;    ///< per element
  At at;
};
template <class Count, class At>
GmshKind(unsigned, std::size_t, unsigned, Count, At) -> GmshKind<Count, At>;

void writePhysicalNames(OutputFile& output, const GmshGroups& groups) {
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

/// Numbers of MSH 4.1 as text: followed by a space or a line break.
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

/// Numbers of MSH 4.1 in binary.
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

/// Writes a file front to back.
template <class Numbers>
class Msh41Writer {
 public:
  Msh41Writer(OutputFile& output, int threads) : output_(output), lines_(output, threads) {}

  /// Writes a whole mesh.
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
      if (kind.corners != 1U << kind.dimension) return;  // one kind of each dimension suffices
      for (const GmshEntity& entity : groups.entities[kind.dimension]) {
        // Use the box of all points for volumes: no need to visit their cells.
        const Box box = kind.dimension == 3 ? boxOfAll : boxOf(kind, entity, points);
        this->writeEntity(kind.dimension, entity, box);
      }
    });
    beginNodes(groups, points.size());
    writePoints(points);
    beginElements(groups);
    std::uint64_t tag = 1;
    forEachKind([&](const auto& kind) {
      for (const GmshEntity& entity : groups.blocks[kind.dimension][kind.corners]) {
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
  /// The corners of a box; all 0 if it is empty.
  [[nodiscard]] static std::array<Vec3, 2> cornersOf(const Box& box) {
    if (box.low[0] > box.high[0]) return {};
    return {box.low, box.high};
  }

  // The sections of a file, in order. Each function ends the section before it.

  /// Writes everything before the entities.
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
    const std::array<Vec3, 2> corners = cornersOf(box);
    // A point has a position instead of a box.
    for (std::size_t corner = 0; corner < (dimension == 0 ? 1U : 2U); ++corner) {
      for (const double coordinate : corners[corner]) Numbers::write(output_, coordinate);
    }
    sizes({1});
    integers({entity.physical});
    // No bounding entities: patches of features need not be closed.
    if (dimension > 0) sizes({0});
    endLine();
  }
  /// Overwrites the box of the last entity; binary files only.
  void rewriteBox(const Box& box) {
    output_.flush();
    std::array<char, sizeof(Vec3) * 2> bytes;  // NOLINT(*-member-init): filled at once
    char* place = bytes.data();
    for (const Vec3& corner : cornersOf(box)) place = putBytes(place, corner);
    output_.writeBytesAt(boxPosition_, bytes.data(), bytes.size());
  }

  /// Writes everything before the points.
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
    for (const auto& ofDimension : groups.blocks) {
      for (const auto& ofKind : ofDimension) {
        for (const GmshEntity& entity : ofKind) blocks += entity.size() > 0 ? 1 : 0;
      }
    }
    sizes({blocks, count, std::min<std::size_t>(count, 1), count});
    endLine();
  }

  /// Begins the block of an entity, if it has elements.
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

  void end() { endSection("$EndElements\n"); }

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
    // After binary data, the end marker must start a new line.
    if (Numbers::kIsBinary) output_.write('\n');
    output_.write(end);
  }

  OutputFile& output_;
  LineWriter lines_;
  LoopProgress* progress_ = nullptr;
  std::uint64_t boxPosition_ = 0;
};

// Whole meshes, and meshes in pieces.

template <std::size_t n>
constexpr std::integral_constant<std::size_t, n> kNodes;

/// Calls f(kind) for all kinds of elements, in file order.
template <class F>
void forEachKind(const HexMesh& mesh, const OtherCells& others, const GmshGroups& groups,
                 const F& f) {
  const auto of = [](const auto& elements) {
    return [&elements](std::size_t i) -> const auto& { return elements[i]; };
  };
  f(GmshKind{0U, 1, kGmshPoint, kNodes<1>, of(groups.vertices.elements)});
  f(GmshKind{1U, 2, kGmshLine, kNodes<2>, of(groups.edges.elements)});
  f(GmshKind{2U, 4, kGmshQuad, kNodes<4>, of(groups.quads.elements)});
  f(GmshKind{2U, 3, kGmshTriangle, kNodes<3>, of(groups.quads.elements)});
  f(GmshKind{3U, 8, kGmshHexahedron, kNodes<8>,
             [&](std::size_t i) -> const Hex& { return mesh.cells[groups.cells.at(i)]; }});
  std::size_t first = mesh.cells.size();
  forEachOtherKind(others, [&]<std::size_t n>(std::span<const std::array<Index, n>> cells) {
    const auto cellAt = [&groups, cells, first](std::size_t i) -> const std::array<Index, n>& {
      return cells[groups.cells.at(i) - first];
    };
    f(GmshKind{3U, n, static_cast<unsigned>(typeWith(n).gmshType), kNodes<n>, cellAt});
    first += cells.size();
  });
}

template <class Numbers>
void writeMsh41(const HexMesh& mesh, OutputFile& output, const WriteOptions& options,
                Stage& stage) {
  const GmshGroups groups(mesh, options, stage);
  const auto kinds = [&](const auto& f) { forEachKind(mesh, othersOf(options), groups, f); };
  Msh41Writer<Numbers>(output, stage.context().threads()).write(mesh.points, groups, kinds, stage);
}

/// Streams a mesh as one volume. Its box precedes the nodes but is known only after them, so it is
/// overwritten at the end.
class GmshStream : private Msh41Writer<BinaryNumbers> {
 public:
  GmshStream(OutputFile& output, int threads) : Msh41Writer(output, threads) {
    output.requirePositions("to which a .msh file cannot be written in pieces");
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

void writeGmsh41Binary(const HexMesh& mesh, OutputFile& output, const WriteOptions& options,
                       Stage& stage) {
  writeMsh41<BinaryNumbers>(mesh, output, options, stage);
}

void writeGmsh41Text(const HexMesh& mesh, OutputFile& output, const WriteOptions& options,
                     Stage& stage) {
  writeMsh41<TextNumbers>(mesh, output, options, stage);
}

void writeGmsh22Text(const HexMesh& mesh, OutputFile& output, const WriteOptions& options,
                     Stage& stage) {
  const GmshGroups groups(mesh, options, stage);
  requireInt32(mesh.points.size(), "MSH 2.2 numbers nodes", "write MSH 4.1");
  requireInt32(groups.elementCount(), "MSH 2.2 numbers elements", "write MSH 4.1");
  LineWriter lines(output, stage.context().threads());
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
  forEachKind(mesh, othersOf(options), groups, [&](const auto& kind) {
    for (const GmshEntity& entity : groups.blocks[kind.dimension][kind.corners]) {
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
}

std::unique_ptr<MeshSink> openGmsh41BinarySink(const std::filesystem::path& file,
                                               Context& context) {
  return openWriterSink<GmshStream>(file, context);
}

namespace {

// Lagrange cells.

/// The nodes of a cell in file order.
struct NodesInOrder {
  const Index* nodes;
  const std::uint32_t* order;

  Index operator[](std::size_t k) const { return nodes[order[k]]; }
};

void appendGmshHex(std::vector<Node>& nodes, int low, int high) {
  constexpr std::array<std::array<std::size_t, 4>, 6> kFaces = {
      {{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}}};
  if (low > high) return;
  if (low == high) {
    nodes.push_back(corner(0, low, high));
    return;
  }
  for (std::size_t i = 0; i < 8; ++i) nodes.push_back(corner(i, low, high));
  auto edges = adjacency::kHexEdges;  // ascending, from the smaller corner to the larger one
  for (auto& edge : edges) edge = {std::min(edge[0], edge[1]), std::max(edge[0], edge[1])};
  std::sort(edges.begin(), edges.end());
  for (const auto& [a, b] : edges) {
    append(nodes, between(corner(a, low, high), corner(b, low, high), high - low - 1));
  }
  for (const auto& face : kFaces) {
    std::array<Node, 4> inner{};
    for (std::size_t i = 0; i < 4; ++i) {
      const Node from = corner(face[i], low, high);
      inner[i] = between(from, corner(face[(i + 2) % 4], low, high), 1)[0];
    }
    appendQuad(nodes, inner, high - low - 2);
  }
  appendGmshHex(nodes, low + 1, high - 1);
}

}  // namespace

std::vector<std::uint32_t> gmshNodeOrder(int order) {
  std::vector<Node> nodes;
  appendGmshHex(nodes, 0, order);
  return placesOf(nodes, order);
}

void writeLagrangeGmsh(const LagrangeMesh& mesh, OutputFile& output, const WriteOptions& options,
                       Stage& stage) {
  HexMesh straight = straightMesh(mesh);
  const GmshGroups groups(straight, options, stage);
  GroupNodes nodes;
  withThreads(stage.context().threads(),
              [&] { nodes = nodesOfGroups(mesh, straight, groups.edges, groups.quads, stage); });
  straight = {};

  const std::vector<std::uint32_t> order = gmshNodeOrder(mesh.order);
  const std::size_t perEdge = static_cast<std::size_t>(mesh.order) + 1;
  const std::size_t perQuad = perEdge * perEdge;
  const std::size_t type = perEdge - 2;
  const auto forEachKind = [&](const auto& f) {
    f(GmshKind{0U, 1, kGmshPoint, 1U, [&](std::size_t i) { return groups.vertices.elements[i]; }});
    f(GmshKind{1U, 2, kGmshLines[type], perEdge,
               [&](std::size_t i) { return nodes.edges.data() + i * perEdge; }});
    f(GmshKind{2U, 4, kGmshQuads[type], perQuad,
               [&](std::size_t i) { return nodes.quads.data() + i * perQuad; }});
    f(GmshKind{
        3U, 8, kGmshHexahedra[type], order.size(), [&](std::size_t i) {
          return NodesInOrder{mesh.nodes.data() + groups.cells.at(i) * order.size(), order.data()};
        }});
  };
  Msh41Writer<TextNumbers>(output, stage.context().threads())
      .write(mesh.points, groups, forEachKind, stage);
}

}  // namespace hexhex::io
