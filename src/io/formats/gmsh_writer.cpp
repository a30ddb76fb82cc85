// Writes `.msh` files (see formats.hpp): MSH 4.1 in text and binary, which share a writer over two
// encodings of numbers, for whole meshes, in pieces, in parts, and of higher order; and MSH 2.2.
//
// A file of MSH 4.1 consists of four heads with up to three sections between them:
//
//     entities ... [nodes] counts of elements [elements] count of ghosts [ghosts] end
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <adjacency/hex_topology.hpp>

#include <hexhex/error.hpp>
#include <hexhex/parts.hpp>
#include <hexhex/team.hpp>
#include <hexhex/types.hpp>

#include <base/box.hpp>
#include <base/concat.hpp>
#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/output_file.hpp>
#include <io/core/output_folder.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {

namespace {

/// A set of elements.
struct GmshEntity {
  std::uint32_t dimension;
  std::uint32_t tag;
  std::uint32_t physical;  ///< number of the physical group
  std::uint32_t part;      ///< from 1 on; 0 if the mesh is whole
  std::size_t begin;
  std::size_t end;
  Box box = {};

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
  /// Of a part. Tagged edges and vertices are left out.
  GmshGroups(const MeshPart& part, const PartsInfo& info, Stage& stage)
      : GmshGroups(withoutCurves(groupPart(part, info, stage))) {}
  /// For elements of one kind in each dimension.
  explicit GmshGroups(MeshGroups all) : MeshGroups(std::move(all)) {
    numberApart({&quads.groups, &cells.groups, &edges.groups, &vertices.groups});
    // A point entity is a single point, so each vertex of a group gets its own.
    for (const ElementGroup& group : vertices.groups) {
      for (std::size_t i = group.begin; i < group.end; ++i) {
        entities[0].push_back({0, static_cast<std::uint32_t>(i + 1), group.number, 0, i, i + 1});
      }
    }
    for (std::uint32_t d = 1; d < 4; ++d) {
      for (const ElementGroup& group : *byDimension()[d]) {
        entities[d].push_back({d, group.number, group.number, 0, group.begin, group.end});
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
    for (GmshEntity entity : std::exchange(lists[std::size_t{1} << dimension], {})) {
      const auto add = [&](const ElementGroup& ofKind) {
        entity.begin = ofKind.begin;
        entity.end = ofKind.end;
        lists[corners(entity.begin)].push_back(entity);
      };
      splitByCorners({entity.tag, {}, entity.begin, entity.end}, corners, add);
    }
  }
  static MeshGroups withoutCurves(MeshGroups all) {
    return {{}, {}, std::move(all.quads), std::move(all.cells)};
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

std::string physicalNames(const GmshGroups& groups) {
  std::size_t count = 0;
  for (const auto* const kind : groups.byDimension()) count += kind->size();
  std::string text = concat("$PhysicalNames\n", count, '\n');
  for (unsigned dimension = 0; dimension < 4; ++dimension) {
    for (const ElementGroup& group : *groups.byDimension()[dimension]) {
      text += concat(dimension, ' ', group.number, " \"", group.name, "\"\n");
    }
  }
  return text += "$EndPhysicalNames\n";
}

/// Numbers of MSH 4.1 as text: followed by a space or a line break.
struct TextNumbers {
  static constexpr bool kIsBinary = false;
  static constexpr std::size_t kRoom = kNumberRoom + 1;

  template <class Number>
  static char* put(char* place, Number number) {
    return io::put(io::put(place, number), ' ');
  }
  static char* point(char* place, const Vec3& point) { return putNumbers(place, point); }
  static char* endLine(char* place) { return io::put(place, '\n'); }
};

/// Numbers of MSH 4.1 in binary.
struct BinaryNumbers {
  static constexpr bool kIsBinary = true;
  static constexpr std::size_t kRoom = 8;

  template <class Number>
  static char* put(char* place, Number number) {
    return putBytes(place, number);
  }
  static char* point(char* place, const Vec3& point) { return putBytes(place, point); }
  static char* endLine(char* place) { return place; }
};

/// The bytes of a ghost in a file.
constexpr std::size_t kGhostBytes = 24;

/// Collects the lines of a head.
template <class Numbers>
class GmshHead {
 public:
  GmshHead& add(std::string_view text) {
    text_ += text;
    return *this;
  }
  GmshHead& integers(std::initializer_list<std::uint32_t> numbers) { return addAll(numbers); }
  GmshHead& sizes(std::initializer_list<std::uint64_t> numbers) { return addAll(numbers); }
  /// All 0 for an empty box. A point has a position instead of a box.
  GmshHead& box(const Box& box, std::size_t dimension) {
    const bool isEmpty = box.low[0] > box.high[0];
    addAll(isEmpty ? Vec3{} : box.low);
    return dimension == 0 ? *this : addAll(isEmpty ? Vec3{} : box.high);
  }
  GmshHead& endLine() { return add(Numbers::kIsBinary ? "" : "\n"); }
  /// After binary data, the end marker must start a new line.
  GmshHead& endSection(std::string_view end) {
    return add(Numbers::kIsBinary ? "\n" : "").add(end);
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  template <class List>
  GmshHead& addAll(const List& numbers) {
    std::array<char, Numbers::kRoom> room;  // NOLINT(*-member-init): filled at once
    for (const auto number : numbers) text_.append(room.data(), Numbers::put(room.data(), number));
    return *this;
  }

  std::string text_;
};

/// The contents of a file, or what a part contributes to it.
struct GmshShare {
  std::uint64_t nodeBlocks;
  std::uint64_t nodes;
  std::uint64_t ghosts;
  std::vector<GmshEntity> blocks = {};  ///< of elements

  GmshShare(std::uint64_t nodes_, std::uint64_t ghosts_)
      : nodeBlocks(std::min<std::uint64_t>(nodes_, 1)), nodes(nodes_), ghosts(ghosts_) {}
  GmshShare(std::uint64_t nodes_, std::uint64_t ghosts_, const GmshGroups& groups)
      : GmshShare(nodes_, ghosts_) {
    for (const auto& ofDimension : groups.blocks) {
      for (const auto& ofKind : ofDimension) {
        std::copy_if(ofKind.begin(), ofKind.end(), std::back_inserter(blocks),
                     [](const GmshEntity& entity) { return entity.size() > 0; });
      }
    }
  }
  [[nodiscard]] std::uint64_t elements() const {
    std::uint64_t count = 0;
    for (const GmshEntity& block : blocks) count += block.size();
    return count;
  }
  /// The bytes of nodes, elements and ghosts, for a part.
  [[nodiscard]] std::array<std::uint64_t, 3> bytes() const {
    constexpr std::uint64_t kBlockHead = 20;
    std::uint64_t ofElements = 0;
    for (const GmshEntity& block : blocks) {
      ofElements += kBlockHead + block.size() * 8 * (1 + (std::uint64_t{1} << block.dimension));
    }
    return {kBlockHead * nodeBlocks + 32 * nodes, ofElements, kGhostBytes * ghosts};
  }
  /// Adds the next part.
  void add(const GmshShare& part) {
    nodeBlocks += part.nodeBlocks;
    nodes += part.nodes;
    ghosts += part.ghosts;
    blocks.insert(blocks.end(), part.blocks.begin(), part.blocks.end());
  }
};

using EntityWords = std::array<std::uint64_t, sizeof(GmshEntity) / sizeof(std::uint64_t)>;

/// The share of a part in numbers, for the other processes of a team.
std::vector<std::uint64_t> inNumbers(const GmshShare& share) {
  std::vector<std::uint64_t> numbers = {share.nodes, share.ghosts};
  for (const GmshEntity& block : share.blocks) {
    const auto words = std::bit_cast<EntityWords>(block);
    numbers.insert(numbers.end(), words.begin(), words.end());
  }
  return numbers;
}

GmshShare shareOf(std::span<const std::uint64_t> numbers) {
  GmshShare share(numbers[0], numbers[1]);
  EntityWords words{};
  for (numbers = numbers.subspan(2); !numbers.empty(); numbers = numbers.subspan(words.size())) {
    std::copy_n(numbers.begin(), words.size(), words.begin());
    share.blocks.push_back(std::bit_cast<GmshEntity>(words));
  }
  return share;
}

template <class Numbers>
void addEntities(GmshHead<Numbers>& head, std::vector<GmshEntity> entities) {
  std::stable_sort(entities.begin(), entities.end(), [](const GmshEntity& a, const GmshEntity& b) {
    return a.dimension < b.dimension;
  });
  std::array<std::uint64_t, 4> counts{};
  for (const GmshEntity& entity : entities) ++counts[entity.dimension];
  head.sizes({counts[0], counts[1], counts[2], counts[3]}).endLine();
  for (const auto& [dimension, tag, physical, part, begin, end, box] : entities) {
    head.integers({tag});
    if (part > 0) head.integers({dimension, physical}).sizes({1}).integers({part});
    head.box(box, dimension).sizes({1}).integers({physical});
    // No bounding entities: patches of features need not be closed.
    if (dimension > 0) head.sizes({0});
    head.endLine();
  }
}

/// The text before the nodes, elements and ghosts of a file, and at its end.
using GmshHeads = std::array<std::string, 4>;

/// @param parts  0: not partitioned
template <class Numbers>
GmshHeads headsOf(const GmshGroups& groups, const GmshShare& share, std::uint64_t largestNode,
                  std::uint64_t largestElement, std::uint32_t parts = 0) {
  std::array<GmshHead<Numbers>, 4> heads;
  const auto counts = [&](std::size_t k, std::uint64_t blocks, std::uint64_t count,
                          std::uint64_t largest) {
    heads[k].sizes({blocks, count, std::min<std::uint64_t>(count, 1), largest}).endLine();
  };
  heads[0].add("$MeshFormat\n4.1 ").add(Numbers::kIsBinary ? "1 8\n" : "0 8\n");
  if (Numbers::kIsBinary) heads[0].integers({1}).add("\n");
  heads[0].add("$EndMeshFormat\n").add(physicalNames(groups)).add("$Entities\n");
  std::vector<GmshEntity> entities;
  for (const auto& ofDimension : groups.entities) {
    entities.insert(entities.end(), ofDimension.begin(), ofDimension.end());
  }
  addEntities(heads[0], std::move(entities));
  heads[0].endSection("$EndEntities\n");
  if (parts > 0) {
    heads[0].add("$PartitionedEntities\n").sizes({parts, 0});
    addEntities(heads[0], share.blocks);
    heads[0].endSection("$EndPartitionedEntities\n");
  }
  heads[0].add("$Nodes\n");
  counts(0, share.nodeBlocks, share.nodes, largestNode);
  heads[1].endSection("$EndNodes\n").add("$Elements\n");
  counts(1, share.blocks.size(), share.elements(), largestElement);
  heads[2].endSection("$EndElements\n");
  if (share.ghosts > 0) {
    heads[2].add("$GhostElements\n").sizes({share.ghosts}).endLine();
    heads[3].endSection("$EndGhostElements\n");
  }
  return {heads[0].text(), heads[1].text(), heads[2].text(), heads[3].text()};
}

/// Writes the nodes and elements. All numbers given are from 0 on; those in the file are from 1 on.
template <class Numbers>
class GmshBlocks {
 public:
  explicit GmshBlocks(LineWriter& lines, LoopProgress* progress = nullptr)
      : lines_(lines), progress_(progress) {}

  /// Begins a block of nodes; their points come next.
  /// @param number  number(i): of node i
  template <class NumberOf>
  void beginNodes(const GmshEntity& volume, std::size_t count, const NumberOf& number) {
    if (count == 0) return;
    lines_.write(GmshHead<Numbers>().integers({3, volume.tag, 0}).sizes({count}).endLine().text());
    const auto node = [&number](char* place, std::size_t i) {
      return Numbers::endLine(Numbers::put(place, std::uint64_t{number(i)} + 1));
    };
    lines_.write(count, Numbers::kRoom + 1, node, progress_);
  }
  /// @param at  at(i): of node i
  template <class At>
  void points(std::size_t count, const At& at) {
    const auto point = [&at](char* place, std::size_t i) {
      return Numbers::endLine(Numbers::point(place, at(i)));
    };
    lines_.write(count, 3 * Numbers::kRoom + 1, point, progress_);
  }
  /// Begins the block of an entity's elements, which come next.
  void beginElements(const GmshEntity& entity, unsigned type) {
    GmshHead<Numbers> head;
    head.integers({entity.dimension, entity.tag, type}).sizes({entity.size()}).endLine();
    lines_.write(head.text());
  }
  /// @param nodes, at  as in GmshKind
  /// @param number     number(i): of element i
  template <class Count, class NumberOf, class At>
  void elements(std::size_t count, Count nodes, const NumberOf& number, const At& at) {
    const auto element = [&](char* place, std::size_t i) {
      place = Numbers::put(place, std::uint64_t{number(i)} + 1);
      const auto& ofElement = at(i);
      for (std::size_t k = 0; k < nodes; ++k) {
        place = Numbers::put(place, std::uint64_t{ofElement[k]} + 1);
      }
      return Numbers::endLine(place);
    };
    lines_.write(count, (nodes + 1) * Numbers::kRoom + 1, element, progress_);
  }

 private:
  LineWriter& lines_;
  LoopProgress* progress_;
};

/// Writes all elements of a mesh, whole or a part.
/// @param kinds   kinds(f) calls f with the GmshKind of each dimension, 0 to 3
/// @param number  number(entity, i, k): of the entity's element i, the k-th in the file
template <class Numbers, class Kinds, class NumberOf>
void writeElements(GmshBlocks<Numbers> blocks, const GmshGroups& groups, const Kinds& kinds,
                   const NumberOf& number) {
  std::uint64_t written = 0;
  kinds([&](const auto& kind) {
    for (const GmshEntity& entity : groups.blocks[kind.dimension][kind.corners]) {
      if (entity.size() == 0) continue;
      blocks.beginElements(entity, kind.type);
      blocks.elements(
          entity.size(), kind.nodes,
          [&](std::size_t i) { return number(entity, entity.begin + i, written + i); },
          [&](std::size_t i) -> decltype(auto) { return kind.at(entity.begin + i); });
      written += entity.size();
    }
  });
}

// Whole meshes, and meshes in pieces.

template <class Kind>
Box boxOf(const Kind& kind, const GmshEntity& entity, std::span<const Vec3> points) {
  Box box;
  for (std::size_t i = entity.begin; i < entity.end; ++i) {
    const auto& element = kind.at(i);
    for (std::size_t k = 0; k < kind.nodes; ++k) box.add(points[element[k]]);
  }
  return box;
}

template <class Numbers>
GmshHeads wholeHeads(std::uint64_t points, const GmshGroups& groups) {
  return headsOf<Numbers>(groups, {points, 0, groups}, points, groups.elementCount());
}

/// Writes a whole mesh.
template <class Numbers, class Kinds>
void writeMsh41(OutputFile& output, std::span<const Vec3> points, GmshGroups& groups,
                const Kinds& kinds, Stage& stage) {
  Box all;
  for (const Vec3& point : points) all.add(point);
  kinds([&](const auto& kind) {
    if (kind.corners != 1U << kind.dimension) return;  // one kind of each dimension suffices
    for (GmshEntity& entity : groups.entities[kind.dimension]) {
      // Use the box of all points for volumes: no need to visit their cells.
      entity.box = kind.dimension == 3 ? all : boxOf(kind, entity, points);
    }
  });
  const GmshHeads heads = wholeHeads<Numbers>(points.size(), groups);
  LoopProgress progress(stage, 2 * points.size() + groups.elementCount());
  LineWriter lines(output, stage.context().threads());
  GmshBlocks<Numbers> blocks(lines, &progress);
  lines.write(heads[0]);
  blocks.beginNodes(groups.entities[3].front(), points.size(), [](std::size_t i) { return i; });
  blocks.points(points.size(), [points](std::size_t i) -> const Vec3& { return points[i]; });
  lines.write(heads[1]);
  writeElements(blocks, groups, kinds,
                [](const GmshEntity&, std::size_t, std::uint64_t k) { return k; });
  lines.write(heads[2]);
}

template <std::size_t n>
constexpr std::integral_constant<std::size_t, n> kNodes;

/// Numbers of an element's nodes, looked up in an array.
template <class Number>
struct NodesAmong {
  const Number* numbers;
  const std::uint32_t* places;

  Number operator[](std::size_t k) const { return numbers[places[k]]; }
};

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
  GmshGroups groups(mesh, options, stage);
  const auto kinds = [&](const auto& f) { forEachKind(mesh, othersOf(options), groups, f); };
  writeMsh41<Numbers>(output, mesh.points, groups, kinds, stage);
}

/// Streams a mesh as one volume. Its box precedes the nodes but is known only after them, so the
/// head is overwritten at the end.
class GmshStream {
 public:
  GmshStream(OutputFile& output, int threads) : output_(output), lines_(output, threads) {
    output.requirePositions("to which a .msh file cannot be written in pieces");
  }

  void begin(std::uint64_t points, std::uint64_t cells) {
    points_ = points;
    groups_ = GmshGroups(MeshGroups(cells));
    lines_.write(heads()[0]);
    blocks_.beginNodes(volume(), points, [](std::size_t i) { return i; });
  }
  void points(const PointPiece& piece) {
    for (const Vec3& point : piece.points) volume().box.add(point);
    blocks_.points(piece.points.size(),
                   [&piece](std::size_t i) -> const Vec3& { return piece.points[i]; });
  }
  void beginCells() {
    lines_.write(heads()[1]);
    if (volume().size() > 0) blocks_.beginElements(volume(), kGmshHexahedron);
  }
  template <class Cell>
  void cells(std::uint64_t first, std::span<const Cell> cells) {
    blocks_.elements(
        cells.size(), kNodes<8>, [first](std::size_t i) { return first + i; },
        [cells](std::size_t i) -> const Cell& { return cells[i]; });
  }
  void end() {
    lines_.write(heads()[2]);
    output_.flush();
    output_.writeBytesAt(0, heads()[0].data(), heads()[0].size());
  }

 private:
  [[nodiscard]] GmshEntity& volume() { return groups_.entities[3].front(); }
  [[nodiscard]] GmshHeads heads() const { return wholeHeads<BinaryNumbers>(points_, groups_); }

  OutputFile& output_;
  LineWriter lines_;
  GmshBlocks<BinaryNumbers> blocks_{lines_};
  GmshGroups groups_{MeshGroups(0)};
  std::uint64_t points_ = 0;
};

// Meshes in parts, binary: one file with all parts, or a file per part.

/// One part, by global numbers: its nodes, elements and ghosts.
class GmshPart {
 public:
  /// @param firstQuad  number of the part's first quad
  /// @param onlyOwned  whether to leave out vertices of other parts and ghost elements
  GmshPart(const MeshPart& part, GmshGroups groups, std::uint64_t firstQuad, bool onlyOwned)
      : part_(part), groups_(std::move(groups)), firstQuad_(firstQuad) {
    Box box;
    for (const Vec3& point : part.mesh.points) box.add(point);
    for (const std::uint32_t dimension : {2U, 3U}) {
      groups_.blocks[dimension][std::size_t{1} << dimension].clear();
      for (std::size_t g = 0; g < groups_.entities[dimension].size(); ++g) {
        groups_.entities[dimension][g].box = box;
        add(groups_.entities[dimension][g], g, part.part);
      }
    }
    cells_.reserve(part.mesh.cells.size());
    for (Index i = 0; i < part.ownCells; ++i) {
      cells_.push_back(static_cast<Index>(groups_.cells.at(i)));
    }
    if (!onlyOwned) addGhostCells();
    for (Index v = 0; v < part.mesh.points.size(); ++v) {
      if (!onlyOwned || part.pointOwners[v] == part.part) nodes_.push_back(v);
    }
  }
  [[nodiscard]] GmshShare share() const {
    return {nodes_.size(), part_.ghostParts.size(), groups_};
  }

  void write(std::size_t section, LineWriter& lines) const {
    if (section == 0) writeNodes(GmshBlocks<BinaryNumbers>(lines));
    if (section == 1) writeElements(GmshBlocks<BinaryNumbers>(lines));
    if (section == 2) writeGhosts(lines);
  }

 private:
  /// Adds a block of elements in a group, unless there are none. Its entity is unique among all
  /// parts, and above the entities of whole meshes.
  void add(GmshEntity entity, std::size_t group, std::uint32_t part) {
    if (entity.size() == 0) return;
    std::uint64_t tag = 0;
    for (const GmshEntity& each : groups_.entities[entity.dimension]) {
      tag = std::max<std::uint64_t>(tag, each.tag);
    }
    tag += 1 + group * part_.parts + part;
    requireInt32(tag, "Gmsh numbers entities");
    entity.tag = static_cast<std::uint32_t>(tag);
    entity.part = part + 1;
    groups_.blocks[entity.dimension][std::size_t{1} << entity.dimension].push_back(entity);
  }
  /// Adds the ghost cells, in entities of the parts that own them.
  void addGhostCells() {
    std::vector<std::array<Index, 3>> ghosts;  // owner, group, cell
    ghosts.reserve(part_.ghostParts.size());
    for (std::size_t i = 0; i < part_.ghostParts.size(); ++i) {
      const auto cell = static_cast<Index>(part_.ownCells + i);
      ghosts.push_back({part_.ghostParts[i], groupOf(cell), cell});
    }
    std::sort(ghosts.begin(), ghosts.end());
    for (std::size_t i = 0; i < ghosts.size();) {
      const auto [owner, group, first] = ghosts[i];
      GmshEntity entity = groups_.entities[3][group];
      entity.begin = cells_.size();
      for (; i < ghosts.size() && ghosts[i][0] == owner && ghosts[i][1] == group; ++i) {
        cells_.push_back(ghosts[i][2]);
      }
      entity.end = cells_.size();
      add(entity, group, owner);
    }
  }
  [[nodiscard]] Index groupOf(Index cell) const {
    if (part_.mesh.regions.empty()) return 0;
    const std::vector<ElementGroup>& groups = groups_.cells.groups;
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const ElementGroup& group) {
      return group.tag == part_.mesh.regions[cell];
    });
    return static_cast<Index>(found - groups.begin());
  }
  void writeNodes(GmshBlocks<BinaryNumbers> blocks) const {
    if (nodes_.empty()) return;
    blocks.beginNodes(groups_.blocks[3][8].front(), nodes_.size(),
                      [this](std::size_t i) { return part_.globalPoints[nodes_[i]]; });
    blocks.points(nodes_.size(),
                  [this](std::size_t i) -> const Vec3& { return part_.mesh.points[nodes_[i]]; });
  }
  void writeElements(GmshBlocks<BinaryNumbers> blocks) const {
    const auto global = [this](const auto& element) {
      return NodesAmong<std::uint64_t>{part_.globalPoints.data(), element.data()};
    };
    const auto kinds = [&](const auto& f) {
      f(GmshKind{2U, 4, kGmshQuad, kNodes<4>,
                 [&](std::size_t i) { return global(groups_.quads.elements[i]); }});
      f(GmshKind{3U, 8, kGmshHexahedron, kNodes<8>,
                 [&](std::size_t i) { return global(part_.mesh.cells[cells_[i]]); }});
    };
    io::writeElements(
        blocks, groups_, kinds, [this](const GmshEntity& entity, std::size_t i, std::uint64_t k) {
          return entity.dimension == 2 ? firstQuad_ + k : part_.globalCells[cells_[i]];
        });
  }
  /// Lists the ghosts by number: cells owned by other parts.
  void writeGhosts(LineWriter& lines) const {
    const auto ghost = [&](char* place, std::size_t i) {
      place = putBytes(place, part_.globalCells[part_.ownCells + i] + 1);
      place = putBytes(place, part_.ghostParts[i] + 1);
      place = putBytes(place, std::uint64_t{1});
      return putBytes(place, part_.part + 1);
    };
    lines.write(part_.ghostParts.size(), kGhostBytes, ghost, nullptr);
  }

  const MeshPart& part_;
  GmshGroups groups_;
  std::uint64_t firstQuad_;
  std::vector<Index> cells_;  ///< in file order
  std::vector<Index> nodes_;
};

/// Base of the sinks for one file and for split files.
class GmshSink : public PartSink {
 public:
  GmshSink(Context& context, ProcessTeam* team) : context_(context), team_(team) {}
  void begin(const PartsInfo& info) override {
    Stage stage(context_, "write mesh");
    info_ = info;
    groups_ = GmshGroups(MeshPart{}, info_, stage);
    nextQuad_ = info.cellCount;
  }

 protected:
  [[nodiscard]] GmshPart gmshPart(const MeshPart& part, bool onlyOwned, Stage& stage) {
    GmshGroups groups(part, info_, stage);
    const std::uint64_t quads = groups.quads.elements.size();
    if (team_ != nullptr) passQuadsBefore(quads);
    nextQuad_ += quads;
    return {part, std::move(groups), nextQuad_ - quads, onlyOwned};
  }
  [[nodiscard]] GmshHeads headsOf(const GmshShare& share, std::uint64_t largestElement) {
    Box all;
    for (const GmshEntity& entity : share.blocks) {
      all.add(entity.box.low);
      all.add(entity.box.high);
    }
    for (auto& ofDimension : groups_.entities) {
      for (GmshEntity& entity : ofDimension) entity.box = all;
    }
    return io::headsOf<BinaryNumbers>(groups_, share, info_.pointCount, largestElement,
                                      info_.parts);
  }
  Context& context_;
  ProcessTeam* team_;
  PartsInfo info_;
  std::uint64_t nextQuad_ = 0;

 private:
  /// Reserves smaller numbers for the quads of processes of lower rank.
  void passQuadsBefore(std::uint64_t own) {
    const GatheredNumbers all = team_->gather(std::span(&own, 1));
    for (std::uint32_t r = 0; r < team_->rank(); ++r) nextQuad_ += all.numbers[r];
  }

  GmshGroups groups_{MeshGroups(0)};  ///< the same for all parts
};

/// Counts of everything precede the data but are known only at the end: sections are kept in
/// temporary files. In a team, the counts are known once each process has made its part.
class OneGmshFile final : public GmshSink {
 public:
  OneGmshFile(const std::filesystem::path& file, Context& context, ProcessTeam* team)
      : GmshSink(context, team), output_(file, team) {
    for (std::size_t k = 0; team == nullptr && k < kSections; ++k) {
      sections_.emplace_back(file, OutputFile::Target::Regular);
    }
  }

  void part(MeshPart&& part) override {
    Stage stage(context_, Stage::kInner);
    const GmshPart own = gmshPart(part, true, stage);
    if (team_ != nullptr) return writeTogether(own);
    share_.add(own.share());
    for (std::size_t k = 0; k < kSections; ++k) {
      LineWriter lines(sections_[k], context_.threads());
      own.write(k, lines);
    }
  }
  void end() override {
    Stage stage(context_, "write mesh");
    if (team_ == nullptr) {
      const GmshHeads heads = this->heads();
      for (std::size_t k = 0; k < heads.size(); ++k) {
        output_.output().write(heads[k]);
        if (k < kSections) copyAll(sections_[k], output_.output());
      }
      sections_.clear();
    }
    output_.commit();
  }

 private:
  static constexpr std::size_t kSections = 3;

  [[nodiscard]] GmshHeads heads() { return headsOf(share_, share_.elements()); }

  /// Copies everything written to a file.
  static void copyAll(OutputFile& from, OutputFile& to) {
    from.flush();
    std::string bytes;
    constexpr std::uint64_t kPieceBytes = std::uint64_t{1} << 22;
    for (std::uint64_t begin = 0; begin < from.position(); begin += bytes.size()) {
      bytes.resize(static_cast<std::size_t>(std::min(kPieceBytes, from.position() - begin)));
      from.readBytesAt(begin, bytes.data(), bytes.size());
      to.write(bytes);
    }
  }

  void writeTogether(const GmshPart& own) {
    const GatheredNumbers shares = team_->gather(inNumbers(own.share()));
    std::array<std::uint64_t, kSections> before{};
    for (std::uint32_t r = 0; r < team_->size(); ++r) {
      if (r == team_->rank()) before = share_.bytes();
      share_.add(shareOf(shares.of(r)));
    }
    const std::array<std::uint64_t, kSections> all = share_.bytes();
    const GmshHeads heads = this->heads();
    std::uint64_t place = 0;
    for (std::size_t k = 0; k < heads.size(); ++k) {
      if (isFirst(team_)) output_.output().writeBytesAt(place, heads[k].data(), heads[k].size());
      place += heads[k].size();
      if (k == kSections) break;
      FilePart file(output_.output(), place + before[k]);
      LineWriter lines(file, context_.threads());
      own.write(k, lines);
      file.flush();
      place += all[k];
    }
  }

  SharedFile output_;
  std::deque<OutputFile> sections_;  ///< temporary, never committed
  GmshShare share_{0, 0};
};

class ManyGmshFiles final : public GmshSink {
 public:
  ManyGmshFiles(std::filesystem::path file, Context& context, ProcessTeam* team)
      : GmshSink(context, team), file_(std::move(file)), files_(team) {}

  void part(MeshPart&& part) override {
    Stage stage(context_, Stage::kInner);
    std::string file = file_.string();
    file.insert(file.size() - file_.extension().string().size(), concat('_', part.part + 1));
    files_.write(part.part, file, [&](OutputFile& output) {
      LineWriter lines(output, context_.threads());
      const GmshPart own = gmshPart(part, false, stage);
      const GmshHeads heads = headsOf(own.share(), nextQuad_);
      for (std::size_t k = 0; k < heads.size(); ++k) {
        lines.write(heads[k]);
        own.write(k, lines);
      }
    });
  }
  void end() override { files_.commit(); }

 private:
  std::filesystem::path file_;
  FileSet files_;
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
  output.write(physicalNames(groups)).write("$Nodes\n").write(mesh.points.size()).write('\n');
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

std::unique_ptr<PartSink> openGmshPartSink(const std::filesystem::path& file, Context& context,
                                           ProcessTeam* team) {
  return std::make_unique<OneGmshFile>(file, context, team);
}

std::unique_ptr<PartSink> openSplitGmshPartSink(const std::filesystem::path& file, Context& context,
                                                ProcessTeam* team) {
  return std::make_unique<ManyGmshFiles>(file, context, team);
}

namespace {

// Lagrange cells.

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
  GmshGroups groups(straight, options, stage);
  const GroupNodes nodes = nodesOfGroups(mesh, straight, groups.edges, groups.quads, stage);
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
    f(GmshKind{3U, 8, kGmshHexahedra[type], order.size(), [&](std::size_t i) {
                 return NodesAmong<Index>{mesh.nodes.data() + groups.cells.at(i) * order.size(),
                                          order.data()};
               }});
  };
  writeMsh41<TextNumbers>(output, mesh.points, groups, forEachKind, stage);
}

}  // namespace hexhex::io
