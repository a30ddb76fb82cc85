// The reading half of gmsh.hpp.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/cell_mesh.hpp>
#include <io/gmsh.hpp>
#include <io/gmsh_tags.hpp>
#include <io/node_tags.hpp>
#include <io/number_source.hpp>
#include <io/ovmb_bytes.hpp>
#include <io/read_with.hpp>
#include <io/text_scanner.hpp>
#include <io/token_index.hpp>

namespace hexhex {
namespace {

// Nodes per element by type; 0 for types without a fixed number. From Gmsh's documentation.
constexpr std::array<std::uint8_t, 32> kNodesOfType = {0,  2,  3,  4,  4, 8, 6,  5,  3,  6, 9,
                                                       10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10,
                                                       12, 15, 15, 21, 4, 5, 6,  20, 35, 56};
constexpr std::int64_t kHexahedronOf64 = 92;
constexpr std::int64_t kHexahedronOf125 = 93;

/// The sign of a group's number tells which way an entity runs.
std::int64_t withoutSign(std::int64_t number) {
  if (number == std::numeric_limits<std::int64_t>::min()) return 0;
  return number < 0 ? -number : number;
}

/// The dimension of the elements that may have a tag here.
std::int64_t dimensionOf(std::int64_t type) {
  if (type == kGmshPoint) return 0;
  if (type == kGmshLine) return 1;
  return type == kGmshQuad ? 2 : 3;
}

/// The number of nodes, or 0 if it is not known.
std::size_t nodesOfType(std::int64_t type) {
  if (type == kHexahedronOf64) return 64;
  if (type == kHexahedronOf125) return 125;
  const bool known = type > 0 && type < static_cast<std::int64_t>(kNodesOfType.size());
  return known ? kNodesOfType[static_cast<std::size_t>(type)] : 0;
}

template <class Source>
std::size_t requireType(const Source& source, std::int64_t type) {
  const std::size_t nodes = nodesOfType(type);
  if (nodes > 0) return nodes;
  source.fail(
      ErrorCode::FileUnsupported,
      "elements of type " + std::to_string(type) +
          " have a number of nodes that is not known here, so that they cannot be skipped.");
}

template <class Source>
void requireRoom(const Source& source, std::uint64_t n, RecordShape shape, const char* what) {
  const std::size_t room = source.room(shape);
  if (n <= room) return;
  source.fail(ErrorCode::FileSyntax, "announces " + std::to_string(n) + " " + what +
                                         ", but the rest of the file has room for at most " +
                                         std::to_string(room) +
                                         ": either the number is wrong or the file is incomplete.");
}

template <class Source>
void requireIndexable(const Source& source, std::uint64_t n, std::string_view what) {
  if (n <= kNone) return;
  source.fail(ErrorCode::TooLarge, "has " + std::to_string(n) + " " + std::string(what) +
                                       "; at most " + std::to_string(kNone) + " are supported.");
}

bool areFinite(const char* place, std::size_t reals) {
  for (std::size_t k = 0; k < reals; ++k) {
    if (!std::isfinite(loadLittle<double>(place + k * sizeof(double)))) return false;
  }
  return true;
}

/// Reads the sections of one file from top to bottom.
template <std::size_t corners>
class MshReader {
 public:
  MshReader(std::string_view text, const std::string& fileName, Stage& stage)
      : text_(text), bytes_(text), fileName_(fileName), scanner_(text, fileName), stage_(stage) {}

  CellMesh<corners> read();

 private:
  static constexpr CellKind kKind = kCellKind<corners>;

  void readFormat();
  void readSection(std::string_view name);
  void skipSection(std::string_view name);
  void readPhysicalNames();
  void readEntities();
  template <class Source>
  static std::int64_t firstOf(Source& source, const char* what);
  void failIfRepeated(bool present, std::string_view name);

  /// Calls f(source) with a source that stands at the scanner's place, and goes on behind what it
  /// read.
  template <class F>
  void withSource(const F& f);
  /// The same, with bytes beginning on the next line.
  void skipLineBreak();

  template <class Source>
  void readNodes41(Source& source);
  template <class Source>
  void readElements41(Source& source);
  /// Cells of one entity: where they are in the file, how many, and their region.
  struct CellBlock {
    std::size_t position;
    std::size_t count;
    std::int32_t tag;
  };
  template <class Source>
  void readCells41(Source& source, const std::vector<CellBlock>& blocks);
  template <class Source>
  void readNodes22(Source& source, std::size_t count);
  void readElements22(TextSource& source, std::size_t count);
  void readElements22(BinarySource& source, std::size_t count);
  static std::int64_t readPhysical22(BinarySource& record, std::size_t tags);
  void readCells22(BinarySource& source, std::size_t first, std::size_t count, std::size_t tags);
  void readFeatures22(BinarySource& source, std::int64_t type, std::size_t count, std::size_t tags);

  [[nodiscard]] static bool isFeature(std::int64_t type);
  template <class Source>
  void readFeatures41(Source& source, std::int64_t type, std::size_t count, std::int32_t tag);
  template <class Source>
  void addFeature(const Source& source, std::int64_t type,
                  const std::array<std::uint64_t, 4>& nodes, std::int32_t tag);
  void setRegions(std::size_t first, std::size_t count, std::int32_t region);
  template <class Source>
  void readPoint(Source& record, std::size_t node);
  template <class Source>
  void readCorners(Source& record, std::size_t cell, bool wide);
  void finishNodes();

  std::string_view text_;
  ByteFile bytes_;
  const std::string& fileName_;
  TextScanner scanner_;
  Stage& stage_;
  std::optional<TokenIndex> index_;  ///< only of text
  bool binary_ = false;
  bool version4_ = false;
  bool hasNodes_ = false;
  bool hasElements_ = false;
  bool hasOtherElements_ = false;
  Array<std::uint64_t> tags_;
  NodeTags nodes_;
  GmshTags gmshTags_;
  CellMesh<corners> mesh_;
};

template <std::size_t corners>
CellMesh<corners> MshReader<corners>::read() {
  readFormat();
  while (scanner_.skipSpace()) {
    const std::string_view token = scanner_.readToken();
    if (token.front() != '$') {
      scanner_.fail(ErrorCode::FileSyntax,
                    "a section begins with '$' and its name, found " + quoted(token) + ".");
    }
    readSection(token.substr(1));
  }
  if (!hasElements_) {
    throw Error(ErrorCode::FileUnsupported, fileName_ + ": the file holds no " +
                                                std::string(kKind.plural) +
                                                ": it has no section $Elements.");
  }
  if (mesh_.cells.empty() && hasOtherElements_) {
    throw Error(ErrorCode::FileUnsupported,
                fileName_ + ": the file holds no " + std::string(kKind.plural) + " with " +
                    std::to_string(corners) + " nodes (type " + std::to_string(kKind.gmshType) +
                    "), but other elements only.");
  }
  return std::move(mesh_);
}

template <std::size_t corners>
void MshReader<corners>::readFormat() {
  if (scanner_.readToken() != "$MeshFormat") {
    scanner_.fail(ErrorCode::FileSyntax, "a .msh file begins with \"$MeshFormat\", found " +
                                             quoted(scanner_.currentToken()) + ".");
  }
  const std::string_view version = scanner_.readToken();
  version4_ = version == "4.1";
  if (!version4_ && version != "2.2" && version != "2.1" && version != "2" && version != "2.0") {
    scanner_.fail(ErrorCode::FileUnsupported,
                  "version " + quoted(version) +
                      " of the format is not supported; save the mesh as version 4.1 or 2.2.");
  }
  std::int64_t type = 0;
  if (!scanner_.readInteger(type)) scanner_.failInteger("the file type");
  if (type != 0 && type != 1) {
    scanner_.fail(ErrorCode::FileSyntax,
                  "the file type is 0 (text) or 1 (binary), found " + std::to_string(type) + ".");
  }
  binary_ = type == 1;
  std::int64_t size = 0;
  if (!scanner_.readInteger(size)) scanner_.failInteger("the size of numbers");
  if (size != 8) {
    scanner_.fail(ErrorCode::FileUnsupported,
                  "numbers of " + std::to_string(size) + " bytes are not supported, only 8.");
  }
  if (!binary_) index_.emplace(text_, stage_);
  if (binary_) {
    withSource([](auto& source) {
      if (source.integer("the mark of the byte order") == 1) return;
      source.fail(ErrorCode::FileUnsupported,
                  "the bytes of numbers come in the order of another kind of computers; save the "
                  "mesh as text.");
    });
  }
  if (scanner_.readToken() != "$EndMeshFormat") {
    scanner_.fail(ErrorCode::FileSyntax,
                  "expected \"$EndMeshFormat\", found " + quoted(scanner_.currentToken()) + ".");
  }
}

template <std::size_t corners>
void MshReader<corners>::readSection(std::string_view name) {
  if (name == "PhysicalNames") return readPhysicalNames();
  if (name == "Entities" && version4_) return readEntities();
  if (name != "Nodes" && name != "Elements") return skipSection(name);
  const bool nodes = name == "Nodes";
  failIfRepeated(nodes ? hasNodes_ : hasElements_, name);
  (nodes ? hasNodes_ : hasElements_) = true;
  if (!hasNodes_) {
    scanner_.fail(ErrorCode::FileUnsupported,
                  "the section $Elements stands before the section $Nodes; exchange them.");
  }
  if (version4_) {
    withSource([&](auto& source) { nodes ? readNodes41(source) : readElements41(source); });
  } else {
    const std::size_t count = scanner_.readCount(nodes ? "nodes" : "elements", 8);
    withSource(
        [&](auto& source) { nodes ? readNodes22(source, count) : readElements22(source, count); });
  }
  if (nodes) finishNodes();
  const std::string_view end = scanner_.readToken();
  if (end.starts_with("$End") && end.substr(4) == name) return;
  scanner_.fail(ErrorCode::FileSyntax,
                "expected \"$End" + std::string(name) + "\", found " + quoted(end) + ".");
}

/// Lines "dimension number name", as text in binary files, too.
template <std::size_t corners>
void MshReader<corners>::readPhysicalNames() {
  const std::size_t begin = scanner_.position();
  skipSection("PhysicalNames");
  std::string_view rest = text_.substr(begin, scanner_.position() - begin);
  while (!rest.empty()) {
    const std::size_t length = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, length);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    GmshGroup group;
    const char* const end = line.data() + line.size();
    const auto dimension = std::from_chars(line.data(), end, group.first);
    if (dimension.ec != std::errc{} || dimension.ptr == end || *dimension.ptr != ' ') continue;
    const auto number = std::from_chars(dimension.ptr + 1, end, group.second);
    const std::size_t quote = line.find('"');
    if (number.ec != std::errc{} || quote == std::string_view::npos) continue;
    const std::string_view name = line.substr(quote + 1);
    gmshTags_.addName(group, name.substr(0, std::min(name.find('"'), name.size())));
  }
}

template <std::size_t corners>
void MshReader<corners>::readEntities() {
  withSource([this](auto& source) {
    std::array<std::uint64_t, 4> counts{};
    for (std::uint64_t& count : counts) count = source.size("the number of entities");
    for (std::size_t dimension = 0; dimension < counts.size(); ++dimension) {
      const std::size_t reals = dimension == 0 ? 3 : 6;
      requireRoom(source, counts[dimension], {.integers = 1, .reals = reals}, "entities");
      for (std::uint64_t i = 0; i < counts[dimension]; ++i) {
        const std::int64_t entity = source.integer("the tag of an entity");
        for (std::size_t k = 0; k < reals; ++k) {
          static_cast<void>(source.real("a coordinate of an entity"));
        }
        const std::int64_t physical = this->firstOf(source, "the tag of a physical group");
        if (dimension > 0) this->firstOf(source, "the tag of a bounding entity");
        gmshTags_.addEntity({static_cast<std::int64_t>(dimension), entity}, withoutSign(physical));
      }
    }
  });
  if (scanner_.readToken() == "$EndEntities") return;
  scanner_.fail(ErrorCode::FileSyntax,
                "expected \"$EndEntities\", found " + quoted(scanner_.currentToken()) + ".");
}

/// The first number of a list, which begins with its length; 0 if it is empty.
template <std::size_t corners>
template <class Source>
std::int64_t MshReader<corners>::firstOf(Source& source, const char* what) {
  const std::uint64_t count = source.size("the length of a list");
  requireRoom(source, count, {.integers = 1}, "numbers");
  const std::int64_t first = count > 0 ? source.integer(what) : 0;
  if (count > 1) source.skip(static_cast<std::size_t>(count - 1), {.integers = 1});
  return first;
}

template <std::size_t corners>
void MshReader<corners>::skipSection(std::string_view name) {
  const std::string end = "$End" + std::string(name);
  const std::size_t place = text_.find(end, scanner_.position());
  if (place == std::string_view::npos) {
    scanner_.fail(ErrorCode::FileSyntax, "the section has no " + quoted(std::string_view(end)) +
                                             ": the file is incomplete.");
  }
  scanner_.moveTo(place + end.size());
}

template <std::size_t corners>
void MshReader<corners>::failIfRepeated(bool present, std::string_view name) {
  if (!present) return;
  scanner_.fail(ErrorCode::FileSyntax,
                "the section $" + std::string(name) + " occurs a second time.");
}

template <std::size_t corners>
template <class F>
void MshReader<corners>::withSource(const F& f) {
  if (binary_) {
    skipLineBreak();
    BinarySource source(bytes_, scanner_.position(), fileName_, stage_);
    f(source);
    scanner_.moveTo(source.position());
  } else {
    TextSource source(scanner_, *index_, stage_);
    f(source);
  }
}

template <std::size_t corners>
void MshReader<corners>::skipLineBreak() {
  std::size_t place = scanner_.position();
  while (place < text_.size() && (text_[place] == ' ' || text_[place] == '\r')) ++place;
  if (place == text_.size() || text_[place] != '\n') {
    scanner_.fail(ErrorCode::FileSyntax,
                  "the line has to end behind " + quoted(scanner_.currentToken()) +
                      ", since the bytes of numbers begin on the next line.");
  }
  scanner_.moveTo(place + 1);
}

template <std::size_t corners>
template <class Source>
void MshReader<corners>::readPoint(Source& record, std::size_t node) {
  for (double& coordinate : mesh_.points[node]) coordinate = record.real("a coordinate of a node");
}

template <std::size_t corners>
template <class Source>
void MshReader<corners>::readNodes41(Source& source) {
  const std::uint64_t blocks = source.size("the number of blocks of nodes");
  const std::uint64_t total = source.size("the number of nodes");
  static_cast<void>(source.size("the smallest tag of a node"));
  static_cast<void>(source.size("the largest tag of a node"));
  requireRoom(source, total, {.sizes = 1, .reals = 3}, "nodes");
  requireIndexable(source, total, "nodes");
  mesh_.points.resize(total);
  tags_.resize(total);
  std::size_t done = 0;
  for (std::uint64_t block = 0; block < blocks; ++block) {
    const std::int64_t dimension = source.integer("the dimension of an entity");
    static_cast<void>(source.integer("the tag of an entity"));
    const bool parametric = source.integer("whether nodes have parameters") != 0;
    const std::uint64_t count = source.size("the number of nodes of a block");
    if (dimension < 0 || dimension > 3) {
      source.fail(ErrorCode::FileSyntax,
                  "an entity has the dimension " + std::to_string(dimension) + ".");
    }
    if (count > total - done) {
      source.fail(ErrorCode::FileSyntax, "the blocks have more nodes than the " +
                                             std::to_string(total) + " of the section.");
    }
    const std::size_t reals = 3 + (parametric ? static_cast<std::size_t>(dimension) : 0);
    requireRoom(source, count, {.sizes = 1}, "nodes");
    const auto takeTag = [&](const char* place, std::size_t i) {
      tags_[done + i] = loadLittle<std::uint64_t>(place);
      return true;
    };
    source.records(count, {.sizes = 1}, takeTag, [&](Source& record, std::size_t i) {
      tags_[done + i] = record.size("the tag of a node");
    });
    requireRoom(source, count, {.reals = reals}, "nodes");
    const auto takePoint = [&](const char* place, std::size_t i) {
      return areFinite(place, reals) && loadPoint(place, mesh_.points[done + i]);
    };
    source.records(count, {.reals = reals}, takePoint, [&](Source& record, std::size_t i) {
      readPoint(record, done + i);
      for (std::size_t k = 3; k < reals; ++k) {
        static_cast<void>(record.real("a parameter of a node"));
      }
    });
    done += count;
  }
  if (done == total) return;
  source.fail(ErrorCode::FileSyntax, "the blocks have " + std::to_string(done) + " of the " +
                                         std::to_string(total) + " nodes of the section.");
}

template <std::size_t corners>
template <class Source>
void MshReader<corners>::readCorners(Source& record, std::size_t cell, bool wide) {
  for (Index& corner : mesh_.cells[cell]) {
    const char* const what = "a node of a cell";
    const std::uint64_t tag =
        wide ? record.size(what) : static_cast<std::uint64_t>(record.integer(what));
    corner = nodes_.find(tag);
    if (corner != kNone) continue;
    record.fail(ErrorCode::IndexOutOfRange,
                std::string(kKind.singular) + " " + std::to_string(cell) +
                    " (counted from 0) names node " +
                    std::to_string(static_cast<std::int64_t>(tag)) +
                    ", which is not in the section $Nodes.",
                Place{kKind.place, cell});
  }
}

template <std::size_t corners>
template <class Source>
void MshReader<corners>::readElements41(Source& source) {
  std::vector<CellBlock> wanted;
  std::size_t cells = 0;
  const std::uint64_t blocks = source.size("the number of blocks of elements");
  const std::uint64_t total = source.size("the number of elements");
  static_cast<void>(source.size("the smallest tag of an element"));
  static_cast<void>(source.size("the largest tag of an element"));
  std::uint64_t done = 0;
  for (std::uint64_t block = 0; block < blocks; ++block) {
    const std::int64_t dimension = source.integer("the dimension of an entity");
    const std::int64_t entity = source.integer("the tag of an entity");
    const std::int64_t type = source.integer("the type of elements");
    const std::uint64_t count = source.size("the number of elements of a block");
    const std::int32_t tag = gmshTags_.ofEntity({dimension, entity});
    const RecordShape shape{.sizes = 1 + requireType(source, type)};
    requireRoom(source, count, shape, "elements");
    done += count;
    if (type == kKind.gmshType) {
      wanted.push_back({source.position(), count, tag});
      cells += count;
    } else if (count > 0) {
      hasOtherElements_ = true;
    }
    if (tag != 0 && isFeature(type)) {
      readFeatures41(source, type, count, tag);
    } else {
      source.skip(count, shape);
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
  readCells41(source, wanted);
  source.moveTo(end);
}

template <std::size_t corners>
template <class Source>
void MshReader<corners>::readCells41(Source& source, const std::vector<CellBlock>& blocks) {
  std::size_t first = 0;
  for (const CellBlock& block : blocks) {
    source.moveTo(block.position);
    const auto takeCorners = [&](const char* place, std::size_t i) {
      bool known = true;
      for (Index& corner : mesh_.cells[first + i]) {
        place += sizeof(std::uint64_t);  // the first one is the element's tag
        corner = nodes_.find(loadLittle<std::uint64_t>(place));
        known = known && corner != kNone;
      }
      return known;
    };
    const RecordShape shape{.sizes = corners + 1};
    source.records(block.count, shape, takeCorners, [&](Source& record, std::size_t i) {
      static_cast<void>(record.size("the tag of an element"));
      readCorners(record, first + i, true);
    });
    setRegions(first, block.count, block.tag);
    first += block.count;
  }
}

/// Whether elements of a type can be features of a mesh of hexahedra.
template <std::size_t corners>
bool MshReader<corners>::isFeature(std::int64_t type) {
  return corners == 8 && (type == kGmshPoint || type == kGmshLine || type == kGmshQuad);
}

/// Reads elements of a block of MSH 4.1, which have the same tag.
template <std::size_t corners>
template <class Source>
void MshReader<corners>::readFeatures41(Source& source, std::int64_t type, std::size_t count,
                                        std::int32_t tag) {
  std::array<std::uint64_t, 4> nodes{};
  const std::size_t size = nodesOfType(type);
  for (std::size_t i = 0; i < count; ++i) {
    static_cast<void>(source.size("the tag of an element"));
    for (std::size_t k = 0; k < size; ++k) nodes[k] = source.size("a node of an element");
    addFeature(source, type, nodes, tag);
  }
}

template <std::size_t corners>
template <class Source>
void MshReader<corners>::addFeature(const Source& source, std::int64_t type,
                                    const std::array<std::uint64_t, 4>& nodes, std::int32_t tag) {
  Quad vertices{};
  for (std::size_t k = 0; k < nodesOfType(type); ++k) {
    vertices[k] = nodes_.find(nodes[k]);
    if (vertices[k] != kNone) continue;
    source.fail(ErrorCode::IndexOutOfRange,
                "an element names node " + std::to_string(static_cast<std::int64_t>(nodes[k])) +
                    ", which is not in the section $Nodes.");
  }
  HexFeatures& features = mesh_.features;
  if (type == kGmshPoint) features.vertices.push_back({vertices[0], tag});
  if (type == kGmshLine) features.edges.push_back({{vertices[0], vertices[1]}, tag});
  if (type == kGmshQuad) features.quads.push_back({vertices, tag});
}

/// Regions of consecutive cells. Without any, there is no array.
template <std::size_t corners>
void MshReader<corners>::setRegions(std::size_t first, std::size_t count, std::int32_t region) {
  if (mesh_.regions.empty() && region != 0) mesh_.regions.assign(mesh_.cells.size(), 0);
  if (mesh_.regions.empty()) return;
  std::fill_n(mesh_.regions.begin() + static_cast<std::ptrdiff_t>(first), count, region);
}

template <std::size_t corners>
template <class Source>
void MshReader<corners>::readNodes22(Source& source, std::size_t count) {
  const RecordShape shape{.integers = 1, .reals = 3};
  requireRoom(source, count, shape, "nodes");
  mesh_.points.resize(count);
  tags_.resize(count);
  source.records(count, shape, [&](Source& record, std::size_t i) {
    tags_[i] = static_cast<std::uint64_t>(record.integer("the number of a node"));
    readPoint(record, i);
  });
}

template <std::size_t corners>
void MshReader<corners>::readElements22(TextSource& source, std::size_t count) {
  LoopProgress progress(stage_, count);
  // Enough for all; lines have different lengths, so that only reading tells how many there are.
  mesh_.cells.resize(count);
  std::size_t cells = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kElementGrain == 0) progress.advance(std::min(kElementGrain, count - i));
    static_cast<void>(source.integer("the number of an element"));
    const std::int64_t type = source.integer("the type of an element");
    const std::size_t nodes = requireType(source, type);
    const std::uint64_t tags = source.size("the number of tags");
    std::int64_t physical = 0;  // the first one
    for (std::uint64_t tag = 0; tag < tags; ++tag) {
      const std::int64_t number = source.integer("a tag");
      if (tag == 0) physical = number;
    }
    const std::int32_t tag = gmshTags_.ofPhysical({dimensionOf(type), withoutSign(physical)});
    if (type == kKind.gmshType) {
      setRegions(cells, 1, tag);
      readCorners(source, cells++, false);
      continue;
    }
    hasOtherElements_ = true;
    std::array<std::uint64_t, 4> corner{};
    for (std::size_t node = 0; node < nodes; ++node) {
      const std::int64_t number = source.integer("a node of an element");
      if (node < corner.size()) corner[node] = static_cast<std::uint64_t>(number);
    }
    if (tag != 0 && isFeature(type)) addFeature(source, type, corner, tag);
  }
  mesh_.cells.resize(cells);
  if (!mesh_.regions.empty()) mesh_.regions.resize(cells);
}

template <std::size_t corners>
void MshReader<corners>::readElements22(BinarySource& source, std::size_t count) {
  mesh_.cells.resize(count);
  std::size_t cells = 0;
  for (std::size_t done = 0; done < count;) {
    const std::int64_t type = source.integer("the type of elements");
    const std::int64_t follow = source.integer("the number of elements that follow");
    const std::int64_t tags = source.integer("the number of tags");
    if (follow <= 0 || static_cast<std::uint64_t>(follow) > count - done || tags < 0) {
      source.fail(
          ErrorCode::FileSyntax,
          "a block of " + std::to_string(follow) + " elements with " + std::to_string(tags) +
              " tags each cannot be: " + std::to_string(count - done) + " elements are left.");
    }
    const auto size = static_cast<std::size_t>(follow);
    const RecordShape shape{.integers =
                                1 + static_cast<std::size_t>(tags) + requireType(source, type)};
    requireRoom(source, size, shape, "elements");
    done += size;
    const auto ownTags = static_cast<std::size_t>(tags);
    if (type == kKind.gmshType) {
      readCells22(source, cells, size, ownTags);
      cells += size;
      continue;
    }
    hasOtherElements_ = true;
    if (isFeature(type)) {
      readFeatures22(source, type, size, ownTags);
    } else {
      source.skip(size, shape);
    }
  }
  mesh_.cells.resize(cells);
  if (!mesh_.regions.empty()) mesh_.regions.resize(cells);
}

/// The physical group of an element of MSH 2, which is the first of its tags, or 0.
template <std::size_t corners>
std::int64_t MshReader<corners>::readPhysical22(BinarySource& record, std::size_t tags) {
  static_cast<void>(record.integer("the number of an element"));
  if (tags == 0) return 0;
  const std::int64_t physical = record.integer("a tag");
  record.skip(tags - 1, {.integers = 1});
  return physical;
}

/// Reads cells of a block, from number `first` on.
template <std::size_t corners>
void MshReader<corners>::readCells22(BinarySource& source, std::size_t first, std::size_t count,
                                     std::size_t tags) {
  const RecordShape shape{.integers = 1 + tags + corners};
  Array<std::int64_t> physicals(count);
  source.records(count, shape, [&](BinarySource& record, std::size_t i) {
    physicals[i] = readPhysical22(record, tags);
    readCorners(record, first + i, false);
  });
  // Cells of a group mostly follow each other.
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin + 1;
    while (end < count && physicals[end] == physicals[begin]) ++end;
    setRegions(first + begin, end - begin,
               gmshTags_.ofPhysical({3, withoutSign(physicals[begin])}));
    begin = end;
  }
}

/// Reads what may be features of a block.
template <std::size_t corners>
void MshReader<corners>::readFeatures22(BinarySource& source, std::int64_t type, std::size_t count,
                                        std::size_t tags) {
  std::array<std::uint64_t, 4> nodes{};
  const std::size_t size = nodesOfType(type);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t physical = readPhysical22(source, tags);
    for (std::size_t k = 0; k < size; ++k) {
      nodes[k] = static_cast<std::uint64_t>(source.integer("a node of an element"));
    }
    const std::int32_t tag = gmshTags_.ofPhysical({dimensionOf(type), withoutSign(physical)});
    if (tag != 0) addFeature(source, type, nodes, tag);
  }
}

template <std::size_t corners>
void MshReader<corners>::finishNodes() {
  nodes_ = NodeTags(tags_);
  const Index repeated = nodes_.repeated();
  if (repeated == kNone) return;
  scanner_.fail(ErrorCode::FileSyntax,
                "two nodes have the tag " + std::to_string(tags_[repeated]) + ".");
}

}  // namespace

HexMesh parseGmsh(std::string_view text, const std::string& fileName, Context& context) {
  return toHexMesh(parseWith<MshReader<8>>(text, fileName, "read mesh", context));
}

HexMesh readGmsh(const std::filesystem::path& file, Context& context) {
  return toHexMesh(readWith<MshReader<8>>(file, "read mesh", context));
}

TetCells parseGmshTets(std::string_view text, const std::string& fileName, Context& context) {
  return parseWith<MshReader<4>>(text, fileName, "read tets", context);
}

TetCells readGmshTets(const std::filesystem::path& file, Context& context) {
  return readWith<MshReader<4>>(file, "read tets", context);
}

}  // namespace hexhex
