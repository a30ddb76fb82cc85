// The section $Elements of `.msh` files: cells, their regions, and features. An element's tag is
// the number of its physical group or comes from the group's name. This library names groups
// "point_7", "curve_7", "surface_7" and "region_7" for the tag 7 ("_m7" for -7), and "boundary",
// "hexahedra" and "patch_7" without a tag.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <hexhex/curved.hpp>
#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/number_source.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

// Element types common to all versions.
inline constexpr unsigned kGmshLine = 1;
inline constexpr unsigned kGmshTriangle = 2;
inline constexpr unsigned kGmshQuad = 3;
inline constexpr unsigned kGmshHexahedron = 5;
inline constexpr unsigned kGmshPoint = 15;
// Order 2, without face and interior nodes.
inline constexpr unsigned kGmshQuad8 = 16;
inline constexpr unsigned kGmshHexahedron20 = 17;
// Complete elements of order 1 to 9.
using GmshTypes = std::array<unsigned, kMaxOrder>;
inline constexpr GmshTypes kGmshLines = {kGmshLine, 8, 26, 27, 28, 62, 63, 64, 65};
inline constexpr GmshTypes kGmshQuads = {kGmshQuad, 10, 36, 37, 38, 47, 48, 49, 50};
inline constexpr GmshTypes kGmshHexahedra = {kGmshHexahedron, 12, 92, 93, 94, 95, 96, 97, 98};

/// The order of a type in a table; 0 if it is not there.
[[nodiscard]] constexpr int orderIn(const GmshTypes& types, std::int64_t type) noexcept {
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (std::int64_t{types[i]} == type) return static_cast<int>(i) + 1;
  }
  return 0;
}
[[nodiscard]] constexpr bool isGmshHexahedron(std::int64_t type) noexcept {
  return type == kGmshHexahedron20 || orderIn(kGmshHexahedra, type) > 0;
}

/// Dimension of elements, and number of a physical group.
using GmshGroup = std::pair<std::int64_t, std::int64_t>;

/// The number of a group without the sign, which gives the orientation of an entity.
[[nodiscard]] constexpr std::int64_t withoutSign(std::int64_t number) noexcept {
  if (number == std::numeric_limits<std::int64_t>::min()) return 0;
  return number < 0 ? -number : number;
}

/// The tag encoded in a group name of this library; empty for other names.
[[nodiscard]] inline std::optional<std::int32_t> tagInGroupName(std::string_view name) {
  constexpr std::array<std::string_view, 4> kTagged = {"point_", "curve_", "surface_", "region_"};
  if (name == "boundary" || name == "hexahedra" || name.starts_with("patch_")) return 0;
  for (const std::string_view prefix : kTagged) {
    if (!name.starts_with(prefix)) continue;
    std::string_view digits = name.substr(prefix.size());
    const bool negative = digits.starts_with('m');
    if (negative) digits.remove_prefix(1);
    if (negative && digits.starts_with('-')) return {};  // only one sign is allowed
    std::int64_t tag = 0;
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), tag);
    if (result.ec != std::errc{} || result.ptr != digits.data() + digits.size()) return {};
    tag = negative ? -tag : tag;
    if (!std::in_range<std::int32_t>(tag)) return {};
    return static_cast<std::int32_t>(tag);
  }
  return {};
}

/// Gives groups unique numbers across dimensions, since programs such as meshio and GetFEM merge
/// groups with equal numbers. Numbers that are tags are kept where possible, earlier kinds first.
inline void numberApart(std::initializer_list<std::vector<ElementGroup>*> kinds) {
  std::set<std::uint32_t> taken;
  std::vector<ElementGroup*> others;
  for (std::vector<ElementGroup>* const groups : kinds) {
    for (ElementGroup& group : *groups) {
      // Given names do not encode the tag.
      const auto tag = tagInGroupName(group.name).value_or(group.tag);
      const bool isTag = tag == static_cast<std::int64_t>(group.number);
      if (!isTag || !taken.insert(group.number).second) others.push_back(&group);
    }
  }
  std::uint32_t next = 1;
  for (ElementGroup* const group : others) {
    if (taken.insert(group->number).second) continue;
    while (!taken.insert(next).second) ++next;
    group->number = next;
  }
}

/// Maps groups and entities to tags of elements.
class GmshTags {
 public:
  /// Adds the name of a physical group.
  void addName(GmshGroup group, std::string_view name) {
    if (const std::optional<std::int32_t> tag = tagInGroupName(name)) {
      named_.emplace(group, *tag);
    } else if (group.first >= 0 && group.first <= 3 && ofPhysical(group) != 0) {
      names.push_back({static_cast<int>(group.first), ofPhysical(group), std::string(name)});
    }
  }
  std::vector<TagName> names;  ///< given by other programs
  /// Sets the first physical group of an MSH 4.1 entity; 0 if it has none.
  void addEntity(GmshGroup entity, std::int64_t physical) { physicals_.emplace(entity, physical); }

  /// The tag of a physical group; 0 if there is none.
  [[nodiscard]] std::int32_t ofPhysical(GmshGroup group) const {
    const auto found = named_.find(group);
    if (found != named_.end()) return found->second;
    return std::in_range<std::int32_t>(group.second) ? static_cast<std::int32_t>(group.second) : 0;
  }
  [[nodiscard]] std::int32_t ofEntity(GmshGroup entity) const {
    const auto found = physicals_.find(entity);
    return found == physicals_.end() ? 0 : ofPhysical({entity.first, found->second});
  }

 private:
  // As many as the file has groups and entities, which are few.
  std::map<GmshGroup, std::int32_t> named_;
  std::map<GmshGroup, std::int64_t> physicals_;
};

// The section consists of blocks of elements of one type in version 4, and in binary files of
// version 2; in text files of versions 1 and 2, each element gives its type.

/// The number of nodes; 0 if unknown.
[[nodiscard]] constexpr std::size_t nodesOfGmshType(std::int64_t type) noexcept {
  // By type; 0 for types of variable size. From Gmsh's documentation.
  constexpr std::array<std::uint8_t, 32> kNodes = {0,  2,  3,  4,  4, 8, 6,  5,  3,  6, 9,
                                                   10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10,
                                                   12, 15, 15, 21, 4, 5, 6,  20, 35, 56};
  if (type > 0 && type < static_cast<std::int64_t>(kNodes.size())) {
    return kNodes[static_cast<std::size_t>(type)];
  }
  std::size_t nodes = 1;
  for (const GmshTypes* const types : {&kGmshLines, &kGmshQuads, &kGmshHexahedra}) {
    const auto order = static_cast<std::size_t>(orderIn(*types, type));
    const auto dimension = types == &kGmshLines ? 1 : (types == &kGmshQuads ? 2 : 3);
    for (int axis = 0; order > 0 && axis < dimension; ++axis) nodes *= order + 1;
  }
  return nodes > 1 ? nodes : 0;
}

/// The dimension of element types that may be cells or features.
[[nodiscard]] constexpr std::int64_t dimensionOfGmshType(std::int64_t type) noexcept {
  if (type == kGmshPoint) return 0;
  if (orderIn(kGmshLines, type) > 0) return 1;
  const bool flat = type == kGmshTriangle || type == kGmshQuad8 || orderIn(kGmshQuads, type) > 0;
  return flat ? 2 : 3;
}

/// Versions that differ: 1 is text only; 4.0 uses 4-byte tags of nodes and elements, 4.1 uses 8.
enum class GmshVersion : std::uint8_t { V1, V2, V40, V41 };

[[nodiscard]] constexpr bool hasEntities(GmshVersion version) noexcept {
  return version >= GmshVersion::V40;
}

/// The tag of a node or element. Negative tags wrap to large numbers.
template <class Record>
[[nodiscard]] std::uint64_t readGmshTag(Record& record, GmshVersion version, const char* what) {
  if (version == GmshVersion::V41) return record.size(what);
  return static_cast<std::uint64_t>(record.integer(what));
}

/// Dimension and tag of an entity, from the head of a block.
template <class Source>
[[nodiscard]] GmshGroup readGmshEntity(Source& source, GmshVersion version) {
  const auto tag = [&source] { return source.integer("the tag of an entity"); };
  GmshGroup entity;
  if (version == GmshVersion::V40) entity.second = tag();
  entity.first = source.integer("the dimension of an entity");
  if (version != GmshVersion::V40) entity.second = tag();
  return entity;
}

/// Consecutive elements of one type.
struct GmshBlock {
  GmshVersion version = GmshVersion::V2;
  std::int64_t type = 0;
  std::size_t nodes = 0;  ///< per element
  std::size_t count = 0;
  std::size_t tags = 0;      ///< version 2: per element, before its nodes
  std::int32_t tag = 0;      ///< version 4: of all elements
  std::size_t position = 0;  ///< version 4: in the file

  [[nodiscard]] RecordShape shape() const {
    if (version == GmshVersion::V41) return {.sizes = 1 + nodes};
    return {.integers = 1 + tags + nodes};
  }
};

template <class Source>
[[nodiscard]] std::size_t readGmshNodeCount(const Source& source, std::int64_t type) {
  const std::size_t nodes = nodesOfGmshType(type);
  if (nodes > 0) return nodes;
  source.fail(ErrorCode::FileUnsupported, "elements of type ", type,
              " have a number of nodes that is not known here, so that they cannot be skipped.");
}

/// The numbers of blocks and elements in the section, in version 4.
template <class Source>
[[nodiscard]] std::array<std::uint64_t, 2> readGmshCounts4(Source& source, GmshVersion version) {
  const std::uint64_t blocks = source.size("the number of blocks of elements");
  const std::uint64_t total = source.size("the number of elements");
  if (version == GmshVersion::V41) {
    static_cast<void>(source.size("the smallest tag of an element"));
    static_cast<void>(source.size("the largest tag of an element"));
  }
  return {blocks, total};
}

/// @param tags  of all entities; null: not needed
template <class Source>
[[nodiscard]] GmshBlock readGmshHead4(Source& source, GmshVersion version, const GmshTags* tags) {
  GmshBlock block{.version = version};
  const GmshGroup entity = readGmshEntity(source, version);
  block.type = source.integer("the type of elements");
  const std::uint64_t count = source.size("the number of elements of a block");
  if (tags != nullptr) block.tag = tags->ofEntity(entity);
  block.nodes = readGmshNodeCount(source, block.type);
  requireRoom(source, count, block.shape(), "elements");
  block.count = static_cast<std::size_t>(count);
  block.position = source.position();
  return block;
}

/// @param left  elements not read yet
[[nodiscard]] inline GmshBlock readGmshHead22(BinarySource& source, std::size_t left) {
  GmshBlock block{.type = source.integer("the type of elements")};
  const std::int64_t follow = source.integer("the number of elements that follow");
  const std::int64_t tags = source.integer("the number of tags");
  if (follow <= 0 || static_cast<std::uint64_t>(follow) > left || tags < 0) {
    source.fail(ErrorCode::FileSyntax, "a block of ", follow, " elements with ", tags,
                " tags each cannot be: ", left, " elements are left.");
  }
  block.count = static_cast<std::size_t>(follow);
  block.tags = static_cast<std::size_t>(tags);
  block.nodes = readGmshNodeCount(source, block.type);
  requireRoom(source, block.count, block.shape(), "elements");
  return block;
}

/// An element of version 1 or 2 as text, up to its nodes.
/// @param[out] physical  its physical group, the first of its tags in version 2, or 0
template <class Source>
[[nodiscard]] GmshBlock readGmshElement(Source& source, GmshVersion version,
                                        std::int64_t& physical) {
  static_cast<void>(source.integer("the number of an element"));
  GmshBlock element{
      .version = version, .type = source.integer("the type of an element"), .count = 1};
  element.nodes = readGmshNodeCount(source, element.type);
  physical = 0;
  if (version == GmshVersion::V2) {
    const std::uint64_t tags = source.size("the number of tags");
    for (std::uint64_t tag = 0; tag < tags; ++tag) {
      const std::int64_t number = source.integer("a tag");
      if (tag == 0) physical = number;
    }
    return element;
  }
  physical = source.integer("the physical region of an element");
  static_cast<void>(source.integer("the elementary region of an element"));
  const std::uint64_t nodes = source.size("the number of nodes of an element");
  if (nodes == element.nodes) return element;
  source.fail(ErrorCode::FileSyntax, "an element of type ", element.type, " has ", element.nodes,
              " nodes, found ", nodes, ".");
}

/// The type of the first hexahedra of a section, straight or curved; 0 if there are none.
/// @param source  after the section's name or, in versions 1 and 2, after the number of elements
template <class Source>
[[nodiscard]] std::int64_t firstGmshHexahedra(Source& source, GmshVersion version,
                                              std::uint64_t count) {
  if (hasEntities(version)) {
    const std::uint64_t blocks = readGmshCounts4(source, version)[0];
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const GmshBlock block = readGmshHead4(source, version, nullptr);
      if (isGmshHexahedron(block.type) && block.count > 0) return block.type;
      source.skip(block.count, block.shape());
    }
  } else if constexpr (std::is_same_v<Source, BinarySource>) {
    while (count > 0) {
      const GmshBlock block = readGmshHead22(source, static_cast<std::size_t>(count));
      if (isGmshHexahedron(block.type)) return block.type;
      source.skip(block.count, block.shape());
      count -= block.count;
    }
  } else {
    for (std::int64_t physical = 0; count > 0; --count) {
      const GmshBlock element = readGmshElement(source, version, physical);
      if (isGmshHexahedron(element.type)) return element.type;
      source.skip(1, {.integers = element.nodes});
    }
  }
  return 0;
}

/// Stands for cells of higher order where a number of corners is expected.
inline constexpr std::size_t kCurved = 0;
template <std::size_t corners>
using GmshMesh = std::conditional_t<corners == kCurved, LagrangeMesh, CellMesh<corners>>;

/// Reads the cells of a mesh and its features. Cells are hexahedra (8 corners), tetrahedra (4), or
/// hexahedra of higher order.
template <std::size_t corners>
class GmshElements {
 public:
  /// @param kind  of the cells
  /// @param places  of curved cells: position of each node in its row
  /// @param tags  of all groups and entities; must outlive this, as must the other references
  GmshElements(const CellKind& kind, const std::vector<std::uint32_t>& places, const GmshTags& tags,
               const NodeTags& nodes, GmshMesh<corners>& mesh, CellCounts& counts, Stage& stage)
      : kind_(kind),
        places_(places),
        tags_(tags),
        nodes_(nodes),
        mesh_(mesh),
        counts_(counts),
        stage_(stage) {}

  /// Reads the section.
  /// @param count  versions 1 and 2: number of elements, already read
  /// @throws Error FileSyntax, FileUnsupported, IndexOutOfRange, TooLarge
  template <class Source>
  void read(Source& source, GmshVersion version, std::size_t count) {
    if (hasEntities(version)) return read4(source, version);
    if constexpr (std::is_same_v<Source, TextSource>) {
      readText(source, version, count);
    } else {
      read22(source, count);
    }
  }

  /// Whether there are elements other than cells.
  [[nodiscard]] bool hasOthers() const noexcept { return hasOthers_; }

 private:
  /// Version 4. Reads cells last, once their number is known.
  template <class Source>
  void read4(Source& source, GmshVersion version) {
    const auto [blocks, total] = readGmshCounts4(source, version);
    std::vector<GmshBlock> ofCells;
    std::uint64_t done = 0;
    std::uint64_t cells = 0;
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const GmshBlock block = readGmshHead4(source, version, &tags_);
      done += block.count;
      counts_.addGmsh(block.type, block.count);
      if (isCell(block.type)) {
        ofCells.push_back(block);
        cells += block.count;
        source.skip(block.count, block.shape());
      } else {
        readOthers(source, block);
      }
    }
    if (done != total) {
      source.fail(ErrorCode::FileSyntax, "the blocks have ", done, " elements instead of the ",
                  total, " of the section.");
    }
    requireIndexable(source, cells, kind_.plural);
    resize(static_cast<std::size_t>(cells));
    const std::size_t end = source.position();
    std::size_t first = 0;
    for (const GmshBlock& block : ofCells) {
      source.moveTo(block.position);
      readCells(source, block, first);
      first += block.count;
    }
    source.moveTo(end);
  }

  /// Version 2, binary, after the number of elements.
  void read22(BinarySource& source, std::size_t count) {
    makeRoom(source, count);
    std::size_t cells = 0;
    for (std::size_t done = 0; done < count;) {
      const GmshBlock block = readGmshHead22(source, count - done);
      done += block.count;
      counts_.addGmsh(block.type, block.count);
      if (isCell(block.type)) {
        readCells(source, block, cells);
        cells += block.count;
      } else {
        readOthers(source, block);
      }
    }
    keep(cells);
  }

  /// Versions 1 and 2 as text.
  void readText(TextSource& source, GmshVersion version, std::size_t count) {
    LoopProgress progress(stage_, count);
    makeRoom(source, count);
    std::size_t cells = 0;
    std::int64_t physical = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % kElementGrain == 0) progress.advance(std::min(kElementGrain, count - i));
      const GmshBlock element = readGmshElement(source, version, physical);
      counts_.addGmsh(element.type, 1);
      const std::int32_t tag = tagOf(element, physical);
      if (isCell(element.type)) {
        setRegions(cells, 1, tag);
        readCorners(source, version, cells++);
      } else {
        hasOthers_ = true;
        readOther(source, element, tag);
      }
    }
    keep(cells);
  }

  [[nodiscard]] bool isCell(std::int64_t type) const { return type == kind_.gmshType; }
  static constexpr unsigned kFace = corners == 4 ? kGmshTriangle : kGmshQuad;
  /// The number of corners of elements that can be features in a mesh of these cells; otherwise 0.
  [[nodiscard]] static constexpr std::size_t featureCorners(std::int64_t type) {
    if (type == kGmshPoint) return 1;
    if (type == kGmshLine) return 2;
    if (type == kFace) return corners == 4 ? 3 : 4;
    if (corners != kCurved) return 0;
    if (orderIn(kGmshLines, type) > 0) return 2;
    return type == kGmshQuad8 || orderIn(kGmshQuads, type) > 0 ? 4 : 0;
  }
  [[nodiscard]] std::int32_t tagOf(const GmshBlock& block, std::int64_t physical) const {
    if (hasEntities(block.version)) return block.tag;
    return tags_.ofPhysical({dimensionOfGmshType(block.type), withoutSign(physical)});
  }

  /// Allocates for the maximum number of cells in versions 1 and 2, which do not count them.
  template <class Source>
  void makeRoom(const Source& source, std::size_t count) {
    // The last one may be incomplete.
    resize(std::min(count, source.room({.integers = 1 + kind_.corners}) + 1));
  }
  void resize(std::size_t cells) {
    if constexpr (corners == kCurved) {
      mesh_.nodes.resize(cells * mesh_.nodesPerCell());
    } else {
      mesh_.cells.resize(cells);
    }
    room_ = cells;
  }

  /// Reads the part of an element in a block before its nodes. @return its physical group, or 0
  template <class Record>
  [[nodiscard]] static std::int64_t readPhysical(Record& record, const GmshBlock& block) {
    static_cast<void>(readGmshTag(record, block.version, "the tag of an element"));
    if (block.tags == 0) return 0;
    const std::int64_t physical = record.integer("a tag");
    record.skip(block.tags - 1, {.integers = 1});
    return physical;
  }

  /// Reads the cells of a block, from index `first` on.
  template <class Source>
  void readCells(Source& source, const GmshBlock& block, std::size_t first) {
    Array<std::int64_t> physicals(block.tags > 0 ? block.count : 0);
    source.records(block.count, block.shape(), [&](auto& record, std::size_t i) {
      const std::int64_t physical = readPhysical(record, block);
      if (!physicals.empty()) physicals[i] = physical;
      readCorners(record, block.version, first + i);
    });
    if (physicals.empty()) return setRegions(first, block.count, tagOf(block, 0));
    // Cells of a group are mostly consecutive.
    for (std::size_t begin = 0; begin < block.count;) {
      std::size_t end = begin + 1;
      while (end < block.count && physicals[end] == physicals[begin]) ++end;
      setRegions(first + begin, end - begin, tagOf(block, physicals[begin]));
      begin = end;
    }
  }

  template <class Record>
  void readCorners(Record& record, GmshVersion version, std::size_t cell) {
    const auto read = [&](Index& node) {
      const std::uint64_t tag = readGmshTag(record, version, "a node of a cell");
      node = nodes_.find(tag);
      if (node == kNone) failCorner(record, tag, cell);
    };
    if constexpr (corners == kCurved) {
      Index* const row = mesh_.nodes.data() + cell * mesh_.nodesPerCell();
      for (const std::uint32_t place : places_) read(row[place]);
    } else {
      for (Index& corner : mesh_.cells[cell]) read(corner);
    }
  }

  // A separate function that takes the record by value, so that the loop keeps it in registers.
  template <class Record>
  [[noreturn]] void failCorner(Record record, std::uint64_t tag, std::size_t cell) const {
    record.fail(ErrorCode::IndexOutOfRange, Place{kind_.place, cell}, kind_.singular, " ", cell,
                " (counted from 0) names node ", static_cast<std::int64_t>(tag),
                ", which is not in the section $Nodes.");
  }

  /// Sets the region of consecutive cells. The array is allocated for the first nonzero region.
  void setRegions(std::size_t first, std::size_t count, std::int32_t region) {
    if (mesh_.regions.empty() && region != 0) mesh_.regions.assign(room_, 0);
    if (mesh_.regions.empty()) return;
    std::fill_n(mesh_.regions.begin() + static_cast<std::ptrdiff_t>(first), count, region);
  }

  /// Truncates the mesh to this number of cells.
  void keep(std::size_t cells) {
    resize(cells);
    if (!mesh_.regions.empty()) mesh_.regions.resize(cells);
  }

  /// Skips elements that are not cells, and reads features.
  template <class Source>
  void readOthers(Source& source, const GmshBlock& block) {
    if (block.count > 0) hasOthers_ = true;
    if (featureCorners(block.type) == 0 || (hasEntities(block.version) && block.tag == 0)) {
      return source.skip(block.count, block.shape());
    }
    for (std::size_t i = 0; i < block.count; ++i) {
      readOther(source, block, tagOf(block, readPhysical(source, block)));
    }
  }

  template <class Source>
  void readOther(Source& source, const GmshBlock& block, std::int32_t tag) {
    std::array<std::uint64_t, 4> nodes{};
    for (std::size_t k = 0; k < block.nodes; ++k) {
      const std::uint64_t node = readGmshTag(source, block.version, "a node of an element");
      if (k < nodes.size()) nodes[k] = node;
    }
    if (tag != 0 && featureCorners(block.type) > 0) addFeature(source, block.type, nodes, tag);
  }

  template <class Source>
  void addFeature(const Source& source, std::int64_t type,
                  const std::array<std::uint64_t, 4>& nodes, std::int32_t tag) {
    Quad vertices{};
    const std::size_t size = featureCorners(type);
    for (std::size_t k = 0; k < size; ++k) {
      vertices[k] = nodes_.find(nodes[k]);
      if (vertices[k] != kNone) continue;
      source.fail(ErrorCode::IndexOutOfRange, "an element names node ",
                  static_cast<std::int64_t>(nodes[k]), ", which is not in the section $Nodes.");
    }
    auto& features = mesh_.features;
    if (size == 1) features.vertices.push_back({vertices[0], tag});
    if (size == 2) features.edges.push_back({{vertices[0], vertices[1]}, tag});
    if (size < 3) return;
    auto& face = facesIn(features).emplace_back();
    std::copy_n(vertices.begin(), face.vertices.size(), face.vertices.begin());
    face.tag = tag;
  }

  CellKind kind_;
  const std::vector<std::uint32_t>& places_;
  const GmshTags& tags_;
  const NodeTags& nodes_;
  GmshMesh<corners>& mesh_;
  CellCounts& counts_;
  Stage& stage_;
  std::size_t room_ = 0;  ///< number of cells allocated
  bool hasOthers_ = false;
};

}  // namespace hexhex::io
