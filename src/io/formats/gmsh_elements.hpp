// What the elements of a `.msh` file are tagged with: the number of their physical group, or what
// its name says; and the nodes that they name, by tags of the file's choice. This library calls
// groups "point_7", "curve_7", "surface_7" and "region_7" for the tag 7 ("_m7" for -7), and
// "boundary", "hexahedra" and "patch_7" where there is no tag.
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
#include <utility>
#include <vector>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/number_source.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {

// Types of elements in files of all versions.
inline constexpr unsigned kGmshLine = 1;
inline constexpr unsigned kGmshTriangle = 2;
inline constexpr unsigned kGmshQuad = 3;
inline constexpr unsigned kGmshHexahedron = 5;
inline constexpr unsigned kGmshPoint = 15;

/// Dimension of elements, and the number of a physical group.
using GmshGroup = std::pair<std::int64_t, std::int64_t>;

/// The number of a group. Its sign tells the direction of an entity.
[[nodiscard]] constexpr std::int64_t withoutSign(std::int64_t number) noexcept {
  if (number == std::numeric_limits<std::int64_t>::min()) return 0;
  return number < 0 ? -number : number;
}

/// The tag that a name of this library gives, or nothing if another program chose it.
[[nodiscard]] inline std::optional<std::int32_t> tagInGroupName(std::string_view name) {
  constexpr std::array<std::string_view, 4> kTagged = {"point_", "curve_", "surface_", "region_"};
  if (name == "boundary" || name == "hexahedra" || name.starts_with("patch_")) return 0;
  for (const std::string_view prefix : kTagged) {
    if (!name.starts_with(prefix)) continue;
    std::string_view digits = name.substr(prefix.size());
    const bool negative = digits.starts_with('m');
    if (negative) digits.remove_prefix(1);
    if (negative && digits.starts_with('-')) return {};  // one sign is enough
    std::int64_t tag = 0;
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), tag);
    if (result.ec != std::errc{} || result.ptr != digits.data() + digits.size()) return {};
    tag = negative ? -tag : tag;
    if (!std::in_range<std::int32_t>(tag)) return {};
    return static_cast<std::int32_t>(tag);
  }
  return {};
}

/// Gives groups of all dimensions numbers of their own, since programs such as meshio and GetFEM
/// take groups with one number for one group. Numbers that are tags stay where they can, those of
/// the first kinds first.
inline void numberApart(std::initializer_list<std::vector<ElementGroup>*> kinds) {
  std::set<std::uint32_t> taken;
  std::vector<ElementGroup*> others;
  for (std::vector<ElementGroup>* const groups : kinds) {
    for (ElementGroup& group : *groups) {
      // Groups with names of their own say it by themselves.
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

/// Tags of elements by their groups or entities.
class GmshTags {
 public:
  /// The name of a physical group.
  void addName(GmshGroup group, std::string_view name) {
    if (const std::optional<std::int32_t> tag = tagInGroupName(name)) {
      named_.emplace(group, *tag);
    } else if (group.first >= 0 && group.first <= 3 && ofPhysical(group) != 0) {
      names.push_back({static_cast<int>(group.first), ofPhysical(group), std::string(name)});
    }
  }
  std::vector<TagName> names;  ///< that another program chose
  /// The first physical group of an entity of MSH 4.1; 0 if it has none.
  void addEntity(GmshGroup entity, std::int64_t physical) { physicals_.emplace(entity, physical); }

  /// The tag of a physical group; 0 without one.
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

/// Finds nodes by their tags.
class NodeTags {
 public:
  NodeTags() = default;
  /// @param tags  of the nodes in their order; fewer than kNone
  explicit NodeTags(const Array<std::uint64_t>& tags) : count_(tags.size()) {
    if (tags.empty()) return;
    first_ = tags[0];
    std::size_t i = 0;
    while (i < tags.size() && tags[i] == first_ + i) ++i;
    if (i < tags.size()) sortTags(tags);
  }

  /// The node with a tag, or kNone.
  [[nodiscard]] Index find(std::uint64_t tag) const {
    if (sorted_.empty()) {
      return tag - first_ < count_ ? static_cast<Index>(tag - first_) : kNone;
    }
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), Entry{tag, 0});
    return found == sorted_.end() || found->first != tag ? kNone : found->second;
  }

  /// A node whose tag an earlier node has, too; kNone if there is none.
  [[nodiscard]] Index repeated() const {
    for (std::size_t i = 1; i < sorted_.size(); ++i) {
      if (sorted_[i].first == sorted_[i - 1].first) return sorted_[i].second;
    }
    return kNone;
  }

 private:
  using Entry = std::pair<std::uint64_t, Index>;

  void sortTags(const Array<std::uint64_t>& tags) {
    sorted_.resize(tags.size());
    for (std::size_t i = 0; i < tags.size(); ++i) sorted_[i] = {tags[i], static_cast<Index>(i)};
    std::sort(sorted_.begin(), sorted_.end());
  }

  // The usual case needs no table: consecutive tags from first_ on.
  std::uint64_t first_ = 0;
  std::size_t count_ = 0;
  Array<Entry> sorted_;
};

// The section $Elements of `.msh` files: cells of one kind, their regions, and features. Blocks of
// elements of one type make up the section of version 4, and that of version 2 in bytes; as text,
// each element of versions 1 and 2 says its type.

/// The number of nodes, or 0 if it is not known.
[[nodiscard]] constexpr std::size_t nodesOfGmshType(std::int64_t type) noexcept {
  // By type; 0 for types without a fixed number. From Gmsh's documentation.
  constexpr std::array<std::uint8_t, 32> kNodes = {0,  2,  3,  4,  4, 8, 6,  5,  3,  6, 9,
                                                   10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10,
                                                   12, 15, 15, 21, 4, 5, 6,  20, 35, 56};
  constexpr std::int64_t kHexahedronOf64 = 92;
  constexpr std::int64_t kHexahedronOf125 = 93;
  if (type == kHexahedronOf64) return 64;
  if (type == kHexahedronOf125) return 125;
  const bool known = type > 0 && type < static_cast<std::int64_t>(kNodes.size());
  return known ? kNodes[static_cast<std::size_t>(type)] : 0;
}

/// The dimension of elements that may be cells or features.
[[nodiscard]] constexpr std::int64_t dimensionOfGmshType(std::int64_t type) noexcept {
  if (type == kGmshPoint) return 0;
  if (type == kGmshLine) return 1;
  return type == kGmshTriangle || type == kGmshQuad ? 2 : 3;
}

/// What differs between versions: 1 has text only; 4.0 numbers nodes and elements with 4 bytes, 4.1
/// with 8.
enum class GmshVersion : std::uint8_t { V1, V2, V40, V41 };

[[nodiscard]] constexpr bool hasEntities(GmshVersion version) noexcept {
  return version >= GmshVersion::V40;
}

/// The tag of a node or element. A negative one becomes large.
template <class Record>
[[nodiscard]] std::uint64_t readGmshTag(Record& record, GmshVersion version, const char* what) {
  if (version == GmshVersion::V41) return record.size(what);
  return static_cast<std::uint64_t>(record.integer(what));
}

/// Dimension and tag of an entity, at the head of a block.
template <class Source>
[[nodiscard]] GmshGroup readGmshEntity(Source& source, GmshVersion version) {
  const auto tag = [&source] { return source.integer("the tag of an entity"); };
  GmshGroup entity;
  if (version == GmshVersion::V40) entity.second = tag();
  entity.first = source.integer("the dimension of an entity");
  if (version != GmshVersion::V40) entity.second = tag();
  return entity;
}

/// Elements of one type that follow each other.
struct GmshBlock {
  GmshVersion version = GmshVersion::V2;
  std::int64_t type = 0;
  std::size_t nodes = 0;  ///< of each element
  std::size_t count = 0;
  std::size_t tags = 0;      ///< version 2: of each element, in front of its nodes
  std::int32_t tag = 0;      ///< version 4: of all elements
  std::size_t position = 0;  ///< version 4: in the file

  [[nodiscard]] RecordShape shape() const {
    if (version == GmshVersion::V41) return {.sizes = 1 + nodes};
    return {.integers = 1 + tags + nodes};
  }
};

/// Fills the cells of a mesh, hexahedra (8 corners) or tetrahedra (4), and its features.
template <std::size_t corners>
class GmshElements {
 public:
  /// @param tags  of all groups and entities; outlive this, and so do the others
  GmshElements(const GmshTags& tags, const NodeTags& nodes, CellMesh<corners>& mesh,
               CellCounts& counts, Stage& stage)
      : tags_(tags), nodes_(nodes), mesh_(mesh), counts_(counts), stage_(stage) {}

  /// Reads the section of version 4 behind its name. Cells are read last, when it is known how
  /// many there are.
  /// @throws Error FileSyntax, FileUnsupported, IndexOutOfRange, TooLarge
  template <class Source>
  void read4(Source& source, GmshVersion version) {
    const std::uint64_t blocks = source.size("the number of blocks of elements");
    const std::uint64_t total = source.size("the number of elements");
    if (version == GmshVersion::V41) {
      static_cast<void>(source.size("the smallest tag of an element"));
      static_cast<void>(source.size("the largest tag of an element"));
    }
    std::vector<GmshBlock> ofCells;
    std::uint64_t done = 0;
    std::uint64_t cells = 0;
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const GmshBlock block = readHead4(source, version);
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
      source.fail(ErrorCode::FileSyntax, "the blocks have " + std::to_string(done) +
                                             " elements instead of the " + std::to_string(total) +
                                             " of the section.");
    }
    requireIndexable(source, cells, kKind.plural);
    mesh_.cells.resize(cells);
    const std::size_t end = source.position();
    std::size_t first = 0;
    for (const GmshBlock& block : ofCells) {
      source.moveTo(block.position);
      readCells(source, block, first);
      first += block.count;
    }
    source.moveTo(end);
  }

  /// The same of version 2, behind the number of elements.
  void read22(BinarySource& source, std::size_t count) {
    mesh_.cells.resize(count);
    std::size_t cells = 0;
    for (std::size_t done = 0; done < count;) {
      const GmshBlock block = readHead22(source, count - done);
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

  /// The same of versions 1 and 2 as text.
  void readText(TextSource& source, GmshVersion version, std::size_t count) {
    LoopProgress progress(stage_, count);
    // Enough for all; lines have different lengths, so that only reading tells how many there are.
    mesh_.cells.resize(count);
    std::size_t cells = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % kElementGrain == 0) progress.advance(std::min(kElementGrain, count - i));
      static_cast<void>(source.integer("the number of an element"));
      GmshBlock element{
          .version = version, .type = source.integer("the type of an element"), .count = 1};
      element.nodes = readNodeCount(source, element.type);
      counts_.addGmsh(element.type, 1);
      const std::int64_t physical =
          version == GmshVersion::V1 ? readPhysical1(source, element) : readPhysical(source);
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

  /// Whether there are other elements than cells.
  [[nodiscard]] bool hasOthers() const noexcept { return hasOthers_; }

 private:
  static constexpr CellKind kKind = kCellKind<corners>;

  [[nodiscard]] static constexpr bool isCell(std::int64_t type) { return type == kKind.gmshType; }
  static constexpr unsigned kFace = corners == 4 ? kGmshTriangle : kGmshQuad;
  /// Whether elements of a type can be features of a mesh of these cells.
  [[nodiscard]] static constexpr bool isFeature(std::int64_t type) {
    return type == kGmshPoint || type == kGmshLine || type == kFace;
  }
  [[nodiscard]] std::int32_t tagOf(const GmshBlock& block, std::int64_t physical) const {
    if (hasEntities(block.version)) return block.tag;
    return tags_.ofPhysical({dimensionOfGmshType(block.type), withoutSign(physical)});
  }

  template <class Source>
  [[nodiscard]] static std::size_t readNodeCount(const Source& source, std::int64_t type) {
    const std::size_t nodes = nodesOfGmshType(type);
    if (nodes > 0) return nodes;
    source.fail(
        ErrorCode::FileUnsupported,
        "elements of type " + std::to_string(type) +
            " have a number of nodes that is not known here, so that they cannot be skipped.");
  }

  template <class Source>
  [[nodiscard]] GmshBlock readHead4(Source& source, GmshVersion version) const {
    GmshBlock block{.version = version};
    const GmshGroup entity = readGmshEntity(source, version);
    block.type = source.integer("the type of elements");
    const std::uint64_t count = source.size("the number of elements of a block");
    block.tag = tags_.ofEntity(entity);
    block.nodes = readNodeCount(source, block.type);
    requireRoom(source, count, block.shape(), "elements");
    block.count = static_cast<std::size_t>(count);
    block.position = source.position();
    return block;
  }

  /// @param left  elements that have not been read
  [[nodiscard]] static GmshBlock readHead22(BinarySource& source, std::size_t left) {
    GmshBlock block{.type = source.integer("the type of elements")};
    const std::int64_t follow = source.integer("the number of elements that follow");
    const std::int64_t tags = source.integer("the number of tags");
    if (follow <= 0 || static_cast<std::uint64_t>(follow) > left || tags < 0) {
      source.fail(ErrorCode::FileSyntax, "a block of " + std::to_string(follow) +
                                             " elements with " + std::to_string(tags) +
                                             " tags each cannot be: " + std::to_string(left) +
                                             " elements are left.");
    }
    block.count = static_cast<std::size_t>(follow);
    block.tags = static_cast<std::size_t>(tags);
    block.nodes = readNodeCount(source, block.type);
    requireRoom(source, block.count, block.shape(), "elements");
    return block;
  }

  /// The physical group of an element of version 2, which is the first of its tags, or 0.
  [[nodiscard]] static std::int64_t readPhysical(TextSource& source) {
    const std::uint64_t tags = source.size("the number of tags");
    std::int64_t physical = 0;
    for (std::uint64_t tag = 0; tag < tags; ++tag) {
      const std::int64_t number = source.integer("a tag");
      if (tag == 0) physical = number;
    }
    return physical;
  }

  /// The same of version 1, where the number of nodes follows.
  [[nodiscard]] static std::int64_t readPhysical1(TextSource& source, const GmshBlock& element) {
    const std::int64_t physical = source.integer("the physical region of an element");
    static_cast<void>(source.integer("the elementary region of an element"));
    const std::uint64_t nodes = source.size("the number of nodes of an element");
    if (nodes == element.nodes) return physical;
    source.fail(ErrorCode::FileSyntax, "an element of type " + std::to_string(element.type) +
                                           " has " + std::to_string(element.nodes) +
                                           " nodes, found " + std::to_string(nodes) + ".");
  }

  /// The same in a block; reads all that stands in front of an element's nodes.
  template <class Record>
  [[nodiscard]] static std::int64_t readPhysical(Record& record, const GmshBlock& block) {
    static_cast<void>(readGmshTag(record, block.version, "the tag of an element"));
    if (block.tags == 0) return 0;
    const std::int64_t physical = record.integer("a tag");
    record.skip(block.tags - 1, {.integers = 1});
    return physical;
  }

  /// Reads cells of a block, from number `first` on.
  template <class Source>
  void readCells(Source& source, const GmshBlock& block, std::size_t first) {
    Array<std::int64_t> physicals(block.tags > 0 ? block.count : 0);
    source.records(block.count, block.shape(), [&](auto& record, std::size_t i) {
      const std::int64_t physical = readPhysical(record, block);
      if (!physicals.empty()) physicals[i] = physical;
      readCorners(record, block.version, first + i);
    });
    if (physicals.empty()) return setRegions(first, block.count, tagOf(block, 0));
    // Cells of a group mostly follow each other.
    for (std::size_t begin = 0; begin < block.count;) {
      std::size_t end = begin + 1;
      while (end < block.count && physicals[end] == physicals[begin]) ++end;
      setRegions(first + begin, end - begin, tagOf(block, physicals[begin]));
      begin = end;
    }
  }

  template <class Record>
  void readCorners(Record& record, GmshVersion version, std::size_t cell) {
    for (Index& corner : mesh_.cells[cell]) {
      const std::uint64_t tag = readGmshTag(record, version, "a node of a cell");
      corner = nodes_.find(tag);
      if (corner == kNone) failCorner(record, tag, cell);
    }
  }

  // Apart, with a record by value, so that what is read stays in registers.
  template <class Record>
  [[noreturn]] static void failCorner(Record record, std::uint64_t tag, std::size_t cell) {
    record.fail(ErrorCode::IndexOutOfRange,
                std::string(kKind.singular) + " " + std::to_string(cell) +
                    " (counted from 0) names node " +
                    std::to_string(static_cast<std::int64_t>(tag)) +
                    ", which is not in the section $Nodes.",
                Place{kKind.place, cell});
  }

  /// Regions of consecutive cells. Without any, there is no array.
  void setRegions(std::size_t first, std::size_t count, std::int32_t region) {
    if (mesh_.regions.empty() && region != 0) mesh_.regions.assign(mesh_.cells.size(), 0);
    if (mesh_.regions.empty()) return;
    std::fill_n(mesh_.regions.begin() + static_cast<std::ptrdiff_t>(first), count, region);
  }

  /// Keeps so many cells.
  void keep(std::size_t cells) {
    mesh_.cells.resize(cells);
    if (!mesh_.regions.empty()) mesh_.regions.resize(cells);
  }

  /// Goes behind elements that are no cells, and takes features.
  template <class Source>
  void readOthers(Source& source, const GmshBlock& block) {
    if (block.count > 0) hasOthers_ = true;
    if (!isFeature(block.type) || (hasEntities(block.version) && block.tag == 0)) {
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
    if (tag != 0 && isFeature(block.type)) addFeature(source, block.type, nodes, tag);
  }

  template <class Source>
  void addFeature(const Source& source, std::int64_t type,
                  const std::array<std::uint64_t, 4>& nodes, std::int32_t tag) {
    Quad vertices{};
    for (std::size_t k = 0; k < nodesOfGmshType(type); ++k) {
      vertices[k] = nodes_.find(nodes[k]);
      if (vertices[k] != kNone) continue;
      source.fail(ErrorCode::IndexOutOfRange,
                  "an element names node " + std::to_string(static_cast<std::int64_t>(nodes[k])) +
                      ", which is not in the section $Nodes.");
    }
    auto& features = mesh_.features;
    if (type == kGmshPoint) features.vertices.push_back({vertices[0], tag});
    if (type == kGmshLine) features.edges.push_back({{vertices[0], vertices[1]}, tag});
    if (type != kFace) return;
    auto& face = facesIn(features).emplace_back();
    std::copy_n(vertices.begin(), face.vertices.size(), face.vertices.begin());
    face.tag = tag;
  }

  const GmshTags& tags_;
  const NodeTags& nodes_;
  CellMesh<corners>& mesh_;
  CellCounts& counts_;
  Stage& stage_;
  bool hasOthers_ = false;
};

}  // namespace hexhex::io
