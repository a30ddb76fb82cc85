// Reads `.msh` files (see formats.hpp) section by section; streams binary files of version 4.1.
#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/input_file.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/number_source.hpp>
#include <io/core/plain_mesh.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {

namespace {

/// The order of a type in a table; 0 if it is not there.
constexpr int orderIn(const GmshTypes& types, std::int64_t type) noexcept {
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (std::int64_t{types[i]} == type) return static_cast<int>(i) + 1;
  }
  return 0;
}
constexpr bool isGmshHexahedron(std::int64_t type) noexcept {
  return type == kGmshHexahedron20 || orderIn(kGmshHexahedra, type) > 0;
}

/// The number of nodes; 0 if unknown.
constexpr std::size_t nodesOfGmshType(std::int64_t type) noexcept {
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

/// The number of corners of points, lines, triangles and quads, which can be features; 0 for
/// others.
constexpr std::size_t featureCorners(std::int64_t type) noexcept {
  if (type == kGmshPoint) return 1;
  if (orderIn(kGmshLines, type) > 0) return 2;
  if (type == kGmshTriangle) return 3;
  return type == kGmshQuad8 || orderIn(kGmshQuads, type) > 0 ? 4 : 0;
}

/// The dimension of element types that may be cells or features.
constexpr std::int64_t dimensionOfGmshType(std::int64_t type) noexcept {
  constexpr std::array<std::int64_t, 5> kDimensions = {3, 0, 1, 2, 2};
  return kDimensions[featureCorners(type)];
}

/// Dimension of elements, and number of a physical group.
using GmshGroup = std::pair<std::int64_t, std::int64_t>;

/// The number of a group without the sign, which gives the orientation of an entity.
constexpr std::int64_t withoutSign(std::int64_t number) noexcept {
  if (number == std::numeric_limits<std::int64_t>::min()) return 0;
  return number < 0 ? -number : number;
}

/// Versions that differ: 1 is text only; 4.0 uses 4-byte tags of nodes and elements, 4.1 uses 8.
enum class GmshVersion : std::uint8_t { V1, V2, V40, V41 };

constexpr bool hasEntities(GmshVersion version) noexcept { return version >= GmshVersion::V40; }

/// The tag of a node or element. Negative tags wrap to large numbers.
template <class Record>
[[nodiscard]] std::uint64_t readGmshTag(Record& record, GmshVersion version,
                                        std::string_view what) {
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

/// Maps groups and entities to tags of elements.
class GmshTags {
 public:
  /// Adds the name of a physical group.
  void addName(GmshGroup group, std::string_view name) {
    if (group.first < 0 || group.first > 3) return;
    const auto dimension = static_cast<int>(group.first);
    if (tagInGroupName(name, dimension) == 0) untagged_.insert(group);
    if (ofPhysical(group) == 0) return;
    names.push_back({dimension, ofPhysical(group), std::string(name)});
  }
  std::vector<TagName> names;
  /// Sets the first physical group of an MSH 4.1 entity; 0 if it has none.
  void addEntity(GmshGroup entity, std::int64_t physical) { physicals_.emplace(entity, physical); }

  /// The tag of a physical group; 0 if there is none.
  [[nodiscard]] std::int32_t ofPhysical(GmshGroup group) const {
    if (untagged_.contains(group)) return 0;
    return std::in_range<std::int32_t>(group.second) ? static_cast<std::int32_t>(group.second) : 0;
  }
  [[nodiscard]] std::int32_t ofEntity(GmshGroup entity) const {
    const auto found = physicals_.find(entity);
    return found == physicals_.end() ? 0 : ofPhysical({entity.first, found->second});
  }

 private:
  // As many as the file has groups and entities, which are few.
  std::set<GmshGroup> untagged_;  ///< by their names
  std::map<GmshGroup, std::int64_t> physicals_;
};

std::optional<GmshVersion> gmshVersionOf(std::string_view version) {
  using Named = std::pair<std::string_view, GmshVersion>;
  constexpr std::array<Named, 7> kVersions = {{{"4.1", GmshVersion::V41},
                                               {"4", GmshVersion::V40},
                                               {"4.0", GmshVersion::V40},
                                               {"2.2", GmshVersion::V2},
                                               {"2.1", GmshVersion::V2},
                                               {"2", GmshVersion::V2},
                                               {"2.0", GmshVersion::V2}}};
  for (const auto& [name, value] : kVersions) {
    if (name == version) return value;
  }
  return {};
}

/// The frame of a file: version, encoding, and the sequence of sections.
class GmshFile {
 public:
  /// Reads the section $MeshFormat, which version 1 lacks, and any comments before it.
  /// @param text  must outlive this, as must the other references
  /// @throws Error FileSyntax, FileUnsupported
  GmshFile(std::string_view text, const std::string& fileName, Stage& stage)
      : text_(text), bytes_(text, fileName), scanner_(text, fileName, stage), stage_(stage) {
    skipComments();
    const std::string_view first = scanner_.peekToken();
    if (first == "$NOD" || first == "$PARA") {
      scanner_.makeIndex();
      return;
    }
    if (scanner_.readToken() != "$MeshFormat") {
      scanner_.fail(ErrorCode::FileSyntax,
                    "a .msh file begins with \"$MeshFormat\", or \"$NOD\" in version 1, found ",
                    quoted(scanner_.currentToken()), ".");
    }
    readVersion();
    readEncoding();
    endSection("MeshFormat");
  }

  [[nodiscard]] GmshVersion version() const noexcept { return version_; }

  /// Moves to the next section and returns its name without '$'; empty at the end of the file.
  [[nodiscard]] std::optional<std::string_view> nextSection() {
    if (!scanner_.skipSpace()) return {};
    const std::string_view token = scanner_.readToken();
    if (token.front() != '$') {
      scanner_.fail(ErrorCode::FileSyntax, "a section begins with '$' and its name, found ",
                    quoted(token), ".");
    }
    return token.substr(1);
  }

  /// Reads the end of a section.
  void endSection(std::string_view name) {
    const std::string end = endOf(name);
    if (scanner_.readToken() != end) scanner_.failToken('"' + end + '"');
  }

  /// Skips and returns the rest of a section; reads its end.
  std::string_view skipSection(std::string_view name) {
    const std::string end = endOf(name);
    const std::size_t begin = scanner_.position();
    const std::size_t place = text_.find(end, begin);
    if (place == std::string_view::npos) {
      scanner_.fail(ErrorCode::FileSyntax, "the section has no ", quoted(std::string_view(end)),
                    ": the file is incomplete.");
    }
    scanner_.moveTo(place + end.size());
    return text_.substr(begin, place + end.size() - begin);
  }

  [[nodiscard]] Stage& stage() const noexcept { return stage_; }
  /// The scanner at the current position.
  [[nodiscard]] TextScanner& scanner() noexcept { return scanner_; }
  /// Calls f(source) with a source of numbers at the scanner's position (for binary files, on the
  /// next line), and advances past what it reads.
  template <class F>
  void withSource(const F& f) {
    if (binary_) {
      scanner_.skipLineBreak();
      BinarySource source(bytes_, scanner_.position(), stage_);
      f(source);
      scanner_.moveTo(source.position());
    } else {
      f(scanner_);
    }
  }

 private:
  [[nodiscard]] std::string endOf(std::string_view name) const {
    return concat((version_ == GmshVersion::V1 ? "$END" : "$End"), name);
  }

  /// Skips comment lines and sections $Comments.
  void skipComments() {
    for (std::string_view token = scanner_.peekToken(); !token.empty();
         token = scanner_.peekToken()) {
      if (token.starts_with("#") || token.starts_with("//")) {
        static_cast<void>(scanner_.takeLine());
      } else if (token == "$Comments") {
        static_cast<void>(scanner_.readToken());
        version_ = GmshVersion::V2;  // has version 2's ends of sections
        skipSection("Comments");
      } else {
        break;
      }
    }
    version_ = GmshVersion::V1;
  }

  void readVersion() {
    const std::string_view version = scanner_.readToken();
    const std::optional<GmshVersion> known = gmshVersionOf(version);
    if (known) {
      version_ = *known;
      return;
    }
    scanner_.fail(ErrorCode::FileUnsupported, "version ", quoted(version),
                  " of the format is not supported; save the mesh as version 4.1 or 2.2.");
  }

  void readEncoding() {
    const std::int64_t type = scanner_.integer("the file type");
    if (type != 0 && type != 1) {
      scanner_.fail(ErrorCode::FileSyntax, "the file type is 0 (text) or 1 (binary), found ", type,
                    ".");
    }
    binary_ = type == 1;
    const std::int64_t size = scanner_.integer("the size of numbers");
    if (size != 8) {
      scanner_.fail(ErrorCode::FileUnsupported, "numbers of ", size,
                    " bytes are not supported, only 8.");
    }
    if (!binary_) {
      scanner_.makeIndex();
      return;
    }
    withSource([](auto& source) {
      if (source.integer("the mark of the byte order") == 1) return;
      source.fail(ErrorCode::FileUnsupported,
                  "the bytes of numbers come in the order of another kind of computers; save the "
                  "mesh as text.");
    });
  }

  std::string_view text_;
  ByteFile bytes_;
  TextSource scanner_;
  Stage& stage_;
  bool binary_ = false;
  GmshVersion version_ = GmshVersion::V1;
};

/// Reads names of groups from the section $PhysicalNames: lines "dimension number name", which are
/// text even in binary files. Other lines are ignored.
void readNames(std::string_view section, GmshTags& tags) {
  while (!section.empty()) {
    const std::size_t length = std::min(section.find('\n'), section.size());
    std::string_view line = section.substr(0, length);
    section.remove_prefix(std::min(length + 1, section.size()));
    const auto read = [&line](std::int64_t& number) {
      line = trimmed(line);
      const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
      line.remove_prefix(static_cast<std::size_t>(end - line.data()));
      return error == std::errc{};
    };
    GmshGroup group;
    if (!read(group.first) || !read(group.second)) continue;
    const std::size_t quote = line.find('"');
    if (quote == std::string_view::npos) continue;
    const std::string_view name = line.substr(quote + 1);
    tags.addName(group, name.substr(0, std::min(name.find('"'), name.size())));
  }
}

/// Reads a list preceded by its length; returns its first number, 0 if it is empty.
template <class Source>
std::int64_t firstOfGmshList(Source& source, const char* what) {
  const std::uint64_t count = source.size("the length of a list");
  requireRoom(source, count, {.integers = 1}, "numbers");
  const std::int64_t first = count > 0 ? source.integer(what) : 0;
  if (count > 1) source.skip(static_cast<std::size_t>(count - 1), {.integers = 1});
  return first;
}

/// Reads entities of one dimension: tags, bounding boxes, groups and bounding entities.
/// @param partitioned  whether they tell the entity that they are of, and their parts
template <class Source>
void readEntitiesOf(Source& source, GmshVersion version, std::size_t dimension, std::uint64_t count,
                    bool partitioned, GmshTags& tags) {
  const std::size_t reals = dimension == 0 && version == GmshVersion::V41 ? 3 : 6;
  requireRoom(source, count, {.integers = 1, .reals = reals}, "entities");
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::int64_t entity = source.integer("the tag of an entity");
    if (partitioned) {
      static_cast<void>(source.integer("the dimension of a parent"));
      static_cast<void>(source.integer("the tag of a parent"));
      firstOfGmshList(source, "a part");
    }
    for (std::size_t k = 0; k < reals; ++k) {
      static_cast<void>(source.real("a coordinate of an entity"));
    }
    const std::int64_t physical = firstOfGmshList(source, "the tag of a physical group");
    if (dimension > 0) firstOfGmshList(source, "the tag of a bounding entity");
    tags.addEntity({static_cast<std::int64_t>(dimension), entity}, withoutSign(physical));
  }
}

/// Reads the groups of entities from the section $Entities or
/// $PartitionedEntities of version 4.
template <class Source>
void readEntities(Source& source, GmshVersion version, bool partitioned, GmshTags& tags) {
  if (partitioned) {
    static_cast<void>(source.size("the number of parts"));
    const std::uint64_t ghosts = source.size("the number of ghost entities");
    requireRoom(source, ghosts, {.integers = 2}, "ghost entities");
    source.skip(static_cast<std::size_t>(ghosts), {.integers = 2});
  }
  std::array<std::uint64_t, 4> counts{};
  for (std::uint64_t& count : counts) count = source.size("the number of entities");
  for (std::size_t dimension = 0; dimension < counts.size(); ++dimension) {
    readEntitiesOf(source, version, dimension, counts[dimension], partitioned, tags);
  }
}

/// Reads the nodes of a file.
/// @param lists  gets their points
class GmshNodes {
 public:
  GmshNodes(GmshVersion version, ElementLists& lists) : version_(version), points_(lists.points) {}

  /// Reads the section of version 4.
  template <class Source>
  void readBlocks(Source& source) {
    const std::uint64_t blocks = source.size("the number of blocks of nodes");
    const std::uint64_t total = source.size("the number of nodes");
    if (version_ == GmshVersion::V41) {
      static_cast<void>(source.size("the smallest tag of a node"));
      static_cast<void>(source.size("the largest tag of a node"));
    }
    requireRoom(source, total, shape(3), "nodes");
    requireIndexable(source, total, "nodes");
    resize(total);
    std::size_t done = 0;
    for (std::uint64_t block = 0; block < blocks; ++block) done += readBlock(source, done);
    if (done == total) return;
    source.fail(ErrorCode::FileSyntax, "the blocks have ", done, " of the ", total,
                " nodes of the section.");
  }

  /// Reads the section of versions 1 and 2, after the number of nodes.
  template <class Source>
  void readAll(Source& source, std::size_t count) {
    requireRoom(source, count, shape(3), "nodes");
    resize(count);
    source.records(count, shape(3), [&](auto& record, std::size_t i) {
      tags[i] = readGmshTag(record, version_, "the number of a node");
      readPoint(record, i);
    });
  }

  /// Reads the section $ParametricNodes of version 2, where nodes tell their entities, too.
  template <class Source>
  void readParametric(Source& source, std::size_t count) {
    requireRoom(source, count, {.integers = 3, .reals = 3}, "nodes");
    resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      tags[i] = readGmshTag(source, version_, "the number of a node");
      readPoint(source, i);
      const std::int64_t dimension = readDimension(source, GmshVersion::V41);
      for (std::int64_t k = 0; k < dimension && dimension < 3; ++k) {
        static_cast<void>(source.real("a parameter of a node"));
      }
    }
  }

  Array<std::uint64_t> tags;

 private:
  void resize(std::uint64_t count) {
    points_.resize(count);
    tags.resize(count);
  }
  /// The record of a node with its tag.
  [[nodiscard]] RecordShape shape(std::size_t reals) const {
    if (version_ == GmshVersion::V41) return {.sizes = 1, .reals = reals};
    return {.integers = 1, .reals = reals};
  }

  /// Reads an entity. @return its dimension, 0 to 3
  template <class Source>
  static std::int64_t readDimension(Source& source, GmshVersion version) {
    const std::int64_t dimension = readGmshEntity(source, version).first;
    if (dimension < 0 || dimension > 3) {
      source.fail(ErrorCode::FileSyntax, "an entity has the dimension ", dimension, ".");
    }
    return dimension;
  }

  /// Reads the nodes of one entity; version 4.1 lists all tags, then all points.
  /// @param done  number of nodes read before
  /// @return number of nodes in the block
  template <class Source>
  std::size_t readBlock(Source& source, std::size_t done) {
    const std::int64_t dimension = readDimension(source, version_);
    const bool parametric = source.integer("whether nodes have parameters") != 0;
    const std::uint64_t count = source.size("the number of nodes of a block");
    if (count > points_.size() - done) {
      source.fail(ErrorCode::FileSyntax, "the blocks have more nodes than the ", points_.size(),
                  " of the section.");
    }
    const bool tagsFirst = version_ == GmshVersion::V41;
    const auto readTag = [&](auto& record, std::size_t i) {
      tags[done + i] = readGmshTag(record, version_, "the tag of a node");
    };
    if (tagsFirst) {
      requireRoom(source, count, {.sizes = 1}, "nodes");
      source.records(count, {.sizes = 1}, readTag);
    }
    const std::size_t reals = 3 + (parametric ? static_cast<std::size_t>(dimension) : 0);
    const RecordShape record = tagsFirst ? RecordShape{.reals = reals} : shape(reals);
    requireRoom(source, count, record, "nodes");
    source.records(count, record, [&](auto& numbers, std::size_t i) {
      if (!tagsFirst) readTag(numbers, i);
      readPoint(numbers, done + i);
      for (std::size_t k = 3; k < reals; ++k) {
        static_cast<void>(numbers.real("a parameter of a node"));
      }
    });
    return count;
  }

  template <class Record>
  void readPoint(Record& record, std::size_t node) {
    for (double& coordinate : points_[node]) coordinate = record.real("a coordinate of a node");
  }

  GmshVersion version_;
  Array<Vec3>& points_;
};

// The section of elements consists of blocks of one type in version 4, and in binary files of
// version 2; in text files of versions 1 and 2, each element gives its type.

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
GmshBlock readGmshHead22(BinarySource& source, std::size_t left) {
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

/// Entry k: the place in VTK's order of Gmsh's node k.
std::vector<std::uint32_t> gmshPlaces(std::int64_t type, std::size_t nodes) {
  std::vector<std::uint32_t> places(nodes);
  std::iota(places.begin(), places.end(), 0U);
  const int order = type == kGmshHexahedron20 ? 2 : orderIn(kGmshHexahedra, type);
  if (order < 2) return places;
  const std::vector<std::uint32_t> inVtk = vtkNodeOrder(order);
  const std::vector<std::uint32_t> inGmsh = gmshNodeOrder(order);
  std::vector<std::uint32_t> placeInVtk(inVtk.size());
  for (std::uint32_t k = 0; k < inVtk.size(); ++k) placeInVtk[inVtk[k]] = k;
  for (std::size_t k = 0; k < nodes; ++k) places[k] = placeInVtk[inGmsh[k]];
  return places;
}

/// Reads the sections of a file in order. If only types are asked for, the first hexahedra decide.
class GmshReader {
 public:
  GmshReader(std::string_view text, const Input& input, ElementParts parts, Stage& stage)
      : file_(text, input.name(), stage), input_(input), parts_(parts) {}

  ElementLists read() {
    while (const std::optional<std::string_view> name = file_.nextSection()) {
      readSection(*name);
      if (isDone()) return std::move(lists_);
    }
    if (!hasElements_ && parts_ == ElementParts::All) {
      input_.fail(ErrorCode::FileUnsupported,
                  "the file holds no cells: it has no section $Elements.");
    }
    for (int dimension = 0; dimension <= 3; ++dimension) useNames(dimension);
    if (!hasEntities(file_.version())) removeRepeatedElements();
    lists_.mayBeEmpty = lists_.blocks.empty();
    return std::move(lists_);
  }

 private:
  [[nodiscard]] bool isDone() const {
    return parts_ == ElementParts::Types && !lists_.blocks.empty();
  }

  void readSection(std::string_view name) {
    const bool version1 = file_.version() == GmshVersion::V1;
    const bool all = parts_ == ElementParts::All;
    if (name == (version1 ? "ELM" : "Elements")) {
      readElements(name);
      if (isDone()) return;
    } else if (all && name == "PhysicalNames") {
      return readNames(file_.skipSection(name), tags_);
    } else if (all && name == "Entities" && hasEntities(file_.version())) {
      file_.withSource(
          [this](auto& source) { readEntities(source, file_.version(), false, tags_); });
    } else if (all && name == "PartitionedEntities" && hasEntities(file_.version())) {
      file_.withSource(
          [this](auto& source) { readEntities(source, file_.version(), true, tags_); });
    } else if (all && (name == (version1 ? "NOD" : "Nodes") ||
                       (name == "ParametricNodes" && file_.version() == GmshVersion::V2))) {
      readNodes(name);
    } else {
      file_.skipSection(name);
      return;
    }
    file_.endSection(name);
  }

  /// Versions 1 and 2 list an element once for each of its groups: keeps the first.
  void removeRepeatedElements() {
    removeRepeated(lists_.vertices);
    removeRepeated(lists_.lines);
    removeRepeated(lists_.triangles);
    removeRepeated(lists_.quads);
    for (ElementBlock& block : lists_.blocks) {
      const auto isFirst = [&block](std::int32_t region) { return region == block.regions[0]; };
      if (!std::all_of(block.regions.begin(), block.regions.end(), isFirst))
        removeRepeatedCells(block);
    }
  }

  /// Compares two nodes before the rest, which is fast.
  static void removeRepeatedCells(ElementBlock& block) {
    const std::size_t each = block.nodesEach;
    const auto row = [&block, each](std::size_t i) {
      return std::span(block.nodes).subspan(i * each, each);
    };
    using Entry = std::pair<std::uint64_t, std::size_t>;  // two nodes, and the element
    const auto isLess = [&row](const Entry& a, const Entry& b) {
      if (a.first != b.first) return a.first < b.first;
      const auto [u, v] = std::pair(row(a.second), row(b.second));
      return std::lexicographical_compare(u.begin(), u.end(), v.begin(), v.end());
    };
    std::vector<Entry> order(block.count());
    for (std::size_t i = 0; i < order.size(); ++i) {
      order[i] = {(std::uint64_t{row(i)[0]} << 32U) | row(i)[1], i};
    }
    std::stable_sort(order.begin(), order.end(), isLess);
    std::vector<bool> repeats(order.size(), false);
    for (std::size_t i = 1; i < order.size(); ++i) {
      repeats[order[i].second] = !isLess(order[i - 1], order[i]);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (repeats[i]) continue;
      std::copy_n(row(i).begin(), each, row(kept).begin());
      block.regions[kept++] = block.regions[i];
    }
    block.nodes.resize(kept * each);
    block.regions.resize(kept);
    block.numbers.resize(kept);  // from 0 on
  }

  /// Calls f with the tag of each element of a dimension.
  template <class F>
  void eachTag(int dimension, const F& f) {
    const auto each = [&f](auto& features) {
      for (auto& feature : features) f(feature.tag);
    };
    if (dimension == 0) each(lists_.vertices);
    if (dimension == 1) each(lists_.lines);
    if (dimension == 2) each(lists_.triangles);
    if (dimension == 2) each(lists_.quads);
    for (ElementBlock& block : lists_.blocks) {
      if (dimension == 3) std::for_each(block.regions.begin(), block.regions.end(), f);
    }
  }

  /// Replaces numbers of groups by the tags in names of this library; keeps other names.
  void useNames(int dimension) {
    std::map<std::int64_t, std::string> known;
    bool areNumbers = true;  // all tags in names
    for (const TagName& name : tags_.names) {
      if (name.dimension != dimension) continue;
      areNumbers =
          areNumbers && tagInGroupName(name.name, dimension).value_or(name.tag) == name.tag;
      known.emplace(name.tag, name.name);
    }
    std::set<std::int32_t> used;
    if (!areNumbers) eachTag(dimension, [&](std::int32_t tag) { used.insert(tag); });
    std::vector<NumberedGroup> groups;
    groups.reserve(used.size());
    for (const std::int32_t number : used) groups.push_back({known[number], number});
    const std::vector<std::int32_t> tags = tagsOfGroups(groups, dimension);
    std::map<std::int32_t, std::int32_t> tagOf;
    for (std::size_t i = 0; i < tags.size(); ++i) {
      tagOf.emplace(static_cast<std::int32_t>(groups[i].number), tags[i]);
    }
    if (!areNumbers) eachTag(dimension, [&](std::int32_t& tag) { tag = tagOf[tag]; });
    for (const auto& [number, name] : known) {
      const auto tag = static_cast<std::int32_t>(number);
      lists_.addName(dimension, areNumbers ? tag : tagOf[tag], name);
    }
  }

  void readNodes(std::string_view name) {
    file_.scanner().failIfRepeated(hasNodes_, concat("$", name));
    hasNodes_ = true;
    GmshNodes nodes(file_.version(), lists_);
    if (hasEntities(file_.version())) {
      file_.withSource([&](auto& source) { nodes.readBlocks(source); });
    } else {
      const std::size_t count = file_.scanner().readCount("nodes", 8);
      file_.withSource([&](auto& source) {
        name == "ParametricNodes" ? nodes.readParametric(source, count)
                                  : nodes.readAll(source, count);
      });
    }
    nodes_ = nodesByNumber(nodes.tags, input_);
  }

  void readElements(std::string_view name) {
    file_.scanner().failIfRepeated(hasElements_, concat("$", name));
    hasElements_ = true;
    if (!hasNodes_ && parts_ == ElementParts::All) {
      file_.scanner().fail(ErrorCode::FileUnsupported, "the section $", name,
                           " stands before the nodes; exchange them.");
    }
    if (hasEntities(file_.version())) {
      return file_.withSource([this](auto& source) { readBlocks(source); });
    }
    const std::size_t count = file_.scanner().readCount("elements", 8);
    file_.withSource([&](auto& source) { readCounted(source, count); });
  }

  /// Version 4.
  template <class Source>
  void readBlocks(Source& source) {
    const auto [blocks, total] = readGmshCounts4(source, file_.version());
    std::uint64_t done = 0;
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const GmshBlock block = readGmshHead4(source, file_.version(), &tags_);
      done += block.count;
      readBlock(source, block);
      if (isDone()) return;
    }
    if (done == total) return;
    source.fail(ErrorCode::FileSyntax, "the blocks have ", done, " elements instead of the ", total,
                " of the section.");
  }

  /// Version 2, binary.
  void readCounted(BinarySource& source, std::size_t count) {
    for (std::size_t done = 0; done < count && !isDone();) {
      const GmshBlock block = readGmshHead22(source, count - done);
      done += block.count;
      readBlock(source, block);
    }
  }

  /// Versions 1 and 2 as text.
  void readCounted(TextSource& source, std::size_t count) {
    LoopProgress progress(file_.stage(), count);
    const std::size_t room = source.room({.integers = 1});
    for (std::size_t i = 0; i < count && !isDone(); ++i) {
      if (i % kElementGrain == 0) progress.advance(std::min(kElementGrain, count - i));
      std::int64_t physical = 0;
      GmshBlock element = readGmshElement(source, file_.version(), physical);
      element.tag = tagOf(element, physical);
      // The last one may be incomplete.
      const std::size_t most = std::min(count - i, room / (1 + element.nodes) + 1);
      if (ElementBlock* const cells = cellsFor(element, most)) {
        if (!isDone()) readCell(source, *cells, cells->count() - 1);
      } else {
        readFeature(source, element, element.tag);
      }
    }
  }

  [[nodiscard]] std::int32_t tagOf(const GmshBlock& block, std::int64_t physical) const {
    if (hasEntities(block.version)) return block.tag;
    return tags_.ofPhysical({dimensionOfGmshType(block.type), withoutSign(physical)});
  }

  /// Reads the part of an element in a block before its nodes. @return its tag
  template <class Record>
  [[nodiscard]] std::int32_t readTag(Record& record, const GmshBlock& block) const {
    static_cast<void>(readGmshTag(record, block.version, "the tag of an element"));
    if (block.tags == 0) return block.tag;
    const std::int64_t physical = record.integer("a tag");
    record.skip(block.tags - 1, {.integers = 1});
    return tagOf(block, physical);
  }

  template <class Source>
  void readBlock(Source& source, const GmshBlock& block) {
    if (block.count == 0) return;
    if (ElementBlock* const cells = cellsFor(block, block.count)) {
      if (isDone()) return;
      const std::size_t first = cells->count() - block.count;
      source.records(block.count, block.shape(), [&](auto& record, std::size_t i) {
        cells->regions[first + i] = readTag(record, block);
        readCell(record, *cells, first + i);
      });
      return;
    }
    const bool untagged = hasEntities(block.version) && block.tag == 0;
    if (untagged || featureCorners(block.type) == 0 || parts_ == ElementParts::Types) {
      return source.skip(block.count, block.shape());
    }
    for (std::size_t i = 0; i < block.count; ++i) {
      readFeature(source, block, readTag(source, block));
    }
  }

  /// Adds elements to those of their type.
  /// @param expected  how many there will be at most, with these
  /// @return their block, if their nodes are to be stored
  ElementBlock* cellsFor(const GmshBlock& added, std::size_t expected) {
    const VolumeCells* const type = volumeCells(&VolumeCells::gmshType, added.type);
    const bool isHexahedron = isGmshHexahedron(added.type);
    if (parts_ == ElementParts::Types && !isHexahedron) return nullptr;
    if (last_ >= lists_.blocks.size() || lists_.blocks[last_].type != type) {
      const auto found =
          std::find_if(lists_.blocks.begin(), lists_.blocks.end(),
                       [type](const ElementBlock& block) { return block.type == type; });
      last_ = static_cast<std::size_t>(found - lists_.blocks.begin());
    }
    const bool isStored = isHexahedron || (type != nullptr && type->meditVertices == added.nodes);
    if (last_ == lists_.blocks.size()) {
      ElementBlock& block = lists_.blocks.emplace_back();
      block.type = type;
      block.nodesEach = added.nodes;
      places_.push_back(gmshPlaces(added.type, added.nodes));
      if (isStored) {
        block.nodes.reserve(expected * added.nodes);
        block.regions.reserve(expected);
        block.numbers.reserve(expected);
      }
    }
    ElementBlock& block = lists_.blocks[last_];
    if (type != nullptr) block.numbers.resize(block.count() + added.count);
    if (!isStored) return nullptr;
    block.nodes.resize(block.count() * added.nodes);
    block.regions.resize(block.count(), added.tag);
    return &block;
  }

  template <class Record>
  void readCell(Record& record, ElementBlock& block, std::size_t i) const {
    const std::vector<std::uint32_t>& places = places_[last_];
    Index* const row = block.nodes.data() + i * places.size();
    for (const std::uint32_t place : places) {
      const std::uint64_t tag = readGmshTag(record, file_.version(), "a node of a cell");
      row[place] = nodes_.find(tag);
      if (row[place] == kNone) failNode(record, block, i, tag);
    }
    block.numbers[i] = i;
  }

  // A separate function that takes the record by value, so that the loop keeps it in registers.
  template <class Record>
  [[noreturn]] void failNode(Record record, const ElementBlock& block, std::size_t i,
                             std::uint64_t tag) const {
    const PlaceKind place = block.nodesEach == 4 ? PlaceKind::Tet : PlaceKind::Cell;
    record.fail(ErrorCode::IndexOutOfRange, Place{place, i}, singular(block.type->plural), " ", i,
                " (counted from 0) names node ", static_cast<std::int64_t>(tag),
                ", which is not in the section $Nodes.");
  }

  /// Reads the nodes of an element that is no cell; if it has a tag, it becomes a feature.
  template <class Source>
  void readFeature(Source& source, const GmshBlock& element, std::int32_t tag) {
    std::array<Index, 4> v{};
    const std::size_t corners = featureCorners(element.type);
    const bool isFeature = tag != 0 && parts_ == ElementParts::All;
    for (std::size_t k = 0; k < element.nodes; ++k) {
      const std::uint64_t node = readGmshTag(source, element.version, "a node of an element");
      if (!isFeature || k >= corners) continue;
      v[k] = nodes_.find(node);
      if (v[k] != kNone) continue;
      source.fail(ErrorCode::IndexOutOfRange, "an element names node ",
                  static_cast<std::int64_t>(node), ", which is not in the section $Nodes.");
    }
    if (isFeature) lists_.addFlat(std::span(v).first(corners), tag);
  }

  GmshFile file_;
  const Input& input_;
  ElementParts parts_;
  GmshTags tags_;
  NodeTags nodes_;
  bool hasNodes_ = false;
  bool hasElements_ = false;
  ElementLists lists_;
  std::vector<std::vector<std::uint32_t>> places_;  ///< per block: gmshPlaces()
  std::size_t last_ = 0;                            ///< the block that got the last elements
};

}  // namespace

ElementLists readGmsh(const Input& input, ElementParts parts, Stage& stage) {
  Array<char> room;
  return GmshReader(input.text(room, stage, "$#/"), input, parts, stage).read();
}

namespace {

// Streams binary `.msh` files of version 4.1.

constexpr RecordShape kTag{.sizes = 1};
constexpr RecordShape kPoint{.reals = 3};

/// A file with one block of nodes, numbered from 1, and one of hexahedra, as this library writes
/// them. Functions throw Error for most other files.
class GmshPieces {
 public:
  GmshPieces(const ByteFile& file, Context& context)
      : words_(file, context, TextWindow::kWords), source_(words_.file(), 0, words_.stage()) {}

  /// @return whether the file has this layout
  [[nodiscard]] bool look() {
    if (!lookAtFormat()) return false;
    for (std::string word = words_.token(); !word.empty(); word = words_.token()) {
      if (!lookAtSection(word)) return false;
      const std::string end = "$End" + word.substr(1);
      for (word = words_.token(); word != end; word = words_.token()) {
        if (word.empty()) return false;
      }
    }
    return layout.isComplete();
  }

  PlainLayout layout{.integerBytes = 8, .inFrontOfCell = 1};

 private:
  /// Checks the section $MeshFormat.
  [[nodiscard]] bool lookAtFormat() {
    for (const char* const expected : {"$MeshFormat", "4.1", "1", "8"}) {
      if (words_.token() != expected) return false;
    }
    return lookInside([this] { return source_.integer("the mark of the byte order") == 1; }) &&
           words_.token() == "$EndMeshFormat";
  }

  [[nodiscard]] bool lookAtSection(std::string_view name) {
    if (name == "$Nodes") return lookInside([this] { return lookAtNodes(); });
    if (name == "$Elements") return lookInside([this] { return lookAtElements(); });
    if (name != "$Entities") return name == "$PhysicalNames";
    // Entities only assign groups to whole blocks, which pieces do not carry.
    GmshTags ignored;
    return lookInside(
        [&] { return readEntities(source_, GmshVersion::V41, false, ignored), true; });
  }

  /// Runs look() on the data that begins on the next line, and moves past it.
  template <class Look>
  [[nodiscard]] bool lookInside(const Look& look) {
    if (!words_.skipLineBreak()) return false;
    source_.moveTo(words_.position());
    if (!look()) return false;
    words_.moveTo(source_.position());
    return true;
  }

  [[nodiscard]] bool lookAtNodes() {
    const bool isFirst = layout.points.position == 0;
    const std::uint64_t blocks = source_.size("the number of blocks");
    const std::uint64_t points = source_.size("the number of nodes");
    source_.skip(2, kTag);  // minimum and maximum tag
    const bool isOfVolume = readGmshEntity(source_, GmshVersion::V41).first == 3;
    const bool hasParameters = source_.integer("whether nodes have parameters") != 0;
    const std::uint64_t count = source_.size("the number of nodes of a block");
    if (!isFirst || blocks != 1 || !isOfVolume || hasParameters || count != points) return false;
    requireRoom(source_, points, {.sizes = 1, .reals = 3}, "nodes");
    if (!areNumbered(points)) return false;
    layout.points = {source_.position(), points};
    source_.skip(static_cast<std::size_t>(points), kPoint);
    return true;
  }

  /// Whether the next tags are 1, 2, 3, ...
  [[nodiscard]] bool areNumbered(std::uint64_t points) {
    std::atomic<bool> all{true};
    for (std::uint64_t first = 0; first < points && all; first += kPieceElements) {
      source_.records(std::min<std::uint64_t>(kPieceElements, points - first), kTag,
                      [&](BinaryRecord& record, std::size_t i) {
                        if (record.size("the tag of a node") != first + i + 1) all = false;
                      });
    }
    return all;
  }

  [[nodiscard]] bool lookAtElements() {
    auto [blocks, left] = readGmshCounts4(source_, GmshVersion::V41);
    for (; blocks > 0; --blocks) {
      const GmshBlock block = readGmshHead4(source_, GmshVersion::V41, nullptr);
      const bool isHexahedra = block.type == kGmshHexahedron;
      if (block.count > left || (!isHexahedra && dimensionOfGmshType(block.type) == 3))
        return false;
      left -= block.count;
      if (isHexahedra) {
        if (layout.cells.position != 0) return false;
        layout.cells = {block.position, block.count};
      }
      source_.skip(block.count, block.shape());
    }
    return left == 0;
  }

  TextWindow words_;
  BinarySource source_;
};

std::optional<PlainLayout> lookAtGmsh(const ByteFile& file, Context& context) {
  GmshPieces pieces(file, context);
  if (!pieces.look()) return {};
  return pieces.layout;
}

}  // namespace

void readGmshTo(MeshSink& sink, const Input& input, Context& context) {
  readPlainMesh({lookAtGmsh, GmshFormat::readMesh}, sink, input, context);
}

}  // namespace hexhex::io
