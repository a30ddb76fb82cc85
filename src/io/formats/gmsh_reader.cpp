// Reads `.msh` files (see formats.hpp) section by section; streams binary files of version 4.1.
#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/input_file.hpp>
#include <io/core/number_source.hpp>
#include <io/core/plain_mesh.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/gmsh_elements.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {

namespace {

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
      : text_(text), bytes_(text, fileName), scanner_(text, fileName), stage_(stage) {
    skipComments();
    const std::string_view first = scanner_.peekToken();
    if (first == "$NOD" || first == "$PARA") {
      index_.emplace(text_, stage_);
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
      TextSource source(scanner_, &*index_, stage_);
      f(source);
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
    TextSource numbers(scanner_, nullptr, stage_);
    const std::int64_t type = numbers.integer("the file type");
    if (type != 0 && type != 1) {
      scanner_.fail(ErrorCode::FileSyntax, "the file type is 0 (text) or 1 (binary), found ", type,
                    ".");
    }
    binary_ = type == 1;
    const std::int64_t size = numbers.integer("the size of numbers");
    if (size != 8) {
      scanner_.fail(ErrorCode::FileUnsupported, "numbers of ", size,
                    " bytes are not supported, only 8.");
    }
    if (!binary_) {
      index_.emplace(text_, stage_);
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
  TextScanner scanner_;
  Stage& stage_;
  std::optional<TokenIndex> index_;  ///< text files only
  bool binary_ = false;
  GmshVersion version_ = GmshVersion::V1;
};

/// Reads names of groups from the section $PhysicalNames: lines "dimension number name", which are
/// text even in binary files. Other lines are ignored.
void readNames(std::string_view section, GmshTags& tags) {
  while (!section.empty()) {
    const std::size_t length = std::min(section.find('\n'), section.size());
    const std::string_view line = section.substr(0, length);
    section.remove_prefix(std::min(length + 1, section.size()));
    GmshGroup group;
    const char* const end = line.data() + line.size();
    const auto dimension = std::from_chars(line.data(), end, group.first);
    if (dimension.ec != std::errc{} || dimension.ptr == end || *dimension.ptr != ' ') continue;
    const auto number = std::from_chars(dimension.ptr + 1, end, group.second);
    const std::size_t quote = line.find('"');
    if (number.ec != std::errc{} || quote == std::string_view::npos) continue;
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
template <class Source>
void readEntitiesOf(Source& source, GmshVersion version, std::size_t dimension, std::uint64_t count,
                    GmshTags& tags) {
  const std::size_t reals = dimension == 0 && version == GmshVersion::V41 ? 3 : 6;
  requireRoom(source, count, {.integers = 1, .reals = reals}, "entities");
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::int64_t entity = source.integer("the tag of an entity");
    for (std::size_t k = 0; k < reals; ++k) {
      static_cast<void>(source.real("a coordinate of an entity"));
    }
    const std::int64_t physical = firstOfGmshList(source, "the tag of a physical group");
    if (dimension > 0) firstOfGmshList(source, "the tag of a bounding entity");
    tags.addEntity({static_cast<std::int64_t>(dimension), entity}, withoutSign(physical));
  }
}

/// Reads the groups of entities from the section $Entities of version 4.
template <class Source>
void readEntities(Source& source, GmshVersion version, GmshTags& tags) {
  std::array<std::uint64_t, 4> counts{};
  for (std::uint64_t& count : counts) count = source.size("the number of entities");
  for (std::size_t dimension = 0; dimension < counts.size(); ++dimension) {
    readEntitiesOf(source, version, dimension, counts[dimension], tags);
  }
}

/// Points with their tags.
class GmshNodes {
 public:
  template <class Source>
  void read4(Source& source, GmshVersion version) {
    const std::uint64_t blocks = source.size("the number of blocks of nodes");
    const std::uint64_t total = source.size("the number of nodes");
    if (version == GmshVersion::V41) {
      static_cast<void>(source.size("the smallest tag of a node"));
      static_cast<void>(source.size("the largest tag of a node"));
    }
    requireRoom(source, total, nodeShape(version, 3), "nodes");
    requireIndexable(source, total, "nodes");
    points_.resize(total);
    tags_.resize(total);
    std::size_t done = 0;
    for (std::uint64_t block = 0; block < blocks; ++block) done += readBlock(source, version, done);
    if (done == total) return;
    source.fail(ErrorCode::FileSyntax, "the blocks have ", done, " of the ", total,
                " nodes of the section.");
  }

  template <class Source>
  void read22(Source& source, std::size_t count) {
    const RecordShape shape{.integers = 1, .reals = 3};
    requireRoom(source, count, shape, "nodes");
    points_.resize(count);
    tags_.resize(count);
    source.records(count, shape, [&](auto& record, std::size_t i) {
      tags_[i] = static_cast<std::uint64_t>(record.integer("the number of a node"));
      readPoint(record, i);
    });
  }

  [[nodiscard]] Array<Vec3>& points() noexcept { return points_; }

  /// @throws Error FileSyntax if two nodes have the same tag
  [[nodiscard]] NodeTags index(const TextScanner& scanner) const {
    NodeTags index(tags_);
    const Index repeated = index.repeated();
    if (repeated == kNone) return index;
    scanner.fail(ErrorCode::FileSyntax, "two nodes have the tag ", tags_[repeated], ".");
  }

 private:
  /// The record of a node with its tag.
  [[nodiscard]] static RecordShape nodeShape(GmshVersion version, std::size_t reals) {
    if (version == GmshVersion::V41) return {.sizes = 1, .reals = reals};
    return {.integers = 1, .reals = reals};
  }

  /// Reads the nodes of one entity; version 4.1 lists all tags, then all points.
  /// @param done  number of nodes read before
  /// @return number of nodes in the block
  template <class Source>
  std::size_t readBlock(Source& source, GmshVersion version, std::size_t done) {
    const std::int64_t dimension = readGmshEntity(source, version).first;
    const bool parametric = source.integer("whether nodes have parameters") != 0;
    const std::uint64_t count = source.size("the number of nodes of a block");
    if (dimension < 0 || dimension > 3) {
      source.fail(ErrorCode::FileSyntax, "an entity has the dimension ", dimension, ".");
    }
    if (count > points_.size() - done) {
      source.fail(ErrorCode::FileSyntax, "the blocks have more nodes than the ", points_.size(),
                  " of the section.");
    }
    const bool tagsFirst = version == GmshVersion::V41;
    const auto readTag = [&](auto& record, std::size_t i) {
      tags_[done + i] = readGmshTag(record, version, "the tag of a node");
    };
    if (tagsFirst) {
      requireRoom(source, count, {.sizes = 1}, "nodes");
      source.records(count, {.sizes = 1}, readTag);
    }
    const std::size_t reals = 3 + (parametric ? static_cast<std::size_t>(dimension) : 0);
    const RecordShape shape = tagsFirst ? RecordShape{.reals = reals} : nodeShape(version, reals);
    requireRoom(source, count, shape, "nodes");
    source.records(count, shape, [&](auto& record, std::size_t i) {
      if (!tagsFirst) readTag(record, i);
      readPoint(record, done + i);
      for (std::size_t k = 3; k < reals; ++k) {
        static_cast<void>(record.real("a parameter of a node"));
      }
    });
    return count;
  }

  template <class Record>
  void readPoint(Record& record, std::size_t node) {
    for (double& coordinate : points_[node]) coordinate = record.real("a coordinate of a node");
  }

  Array<Vec3> points_;
  Array<std::uint64_t> tags_;
};

/// The kind of the requested cells, for messages; for curved cells, the type is not known yet.
template <std::size_t corners>
constexpr CellKind kGmshKind = kCellKind<corners>;
template <>
constexpr CellKind kGmshKind<kCurved> = {
    .singular = "hexahedron", .plural = "hexahedra of higher order", .place = PlaceKind::Cell};

/// Reads the sections of a file in order.
/// @tparam corners  per cell; kCurved: hexahedra of the type that comes first in the file
template <std::size_t corners>
class GmshReader {
 public:
  static constexpr std::string_view kFirst = "$#/";

  GmshReader(std::string_view text, const std::string& fileName, Stage& stage,
             const std::shared_ptr<CellCounts>& counts)
      : file_(text, fileName, stage), fileName_(fileName), counts_(*counts) {}

  GmshMesh<corners> read() {
    while (const std::optional<std::string_view> name = file_.nextSection()) readSection(*name);
    requireCells();
    mesh_.features.names = std::move(tags_.names);
    if constexpr (corners == kCurved) finishCurved();
    return std::move(mesh_);
  }

 private:
  void readSection(std::string_view name) {
    if (name == "PhysicalNames") return readNames(file_.skipSection(name), tags_);
    const bool version1 = file_.version() == GmshVersion::V1;
    if (name == "Entities" && hasEntities(file_.version())) {
      file_.withSource([this](auto& source) { readEntities(source, file_.version(), tags_); });
    } else if (name == (version1 ? "NOD" : "Nodes")) {
      readNodes(name);
    } else if (name == (version1 ? "ELM" : "Elements")) {
      readElements(name);
    } else {
      file_.skipSection(name);
      return;
    }
    file_.endSection(name);
  }

  void readNodes(std::string_view name) {
    file_.scanner().failIfRepeated(hasNodes_, concat("$", name));
    hasNodes_ = true;
    GmshNodes nodes;
    if (hasEntities(file_.version())) {
      file_.withSource([&](auto& source) { nodes.read4(source, file_.version()); });
    } else {
      const std::size_t count = file_.scanner().readCount("nodes", 8);
      file_.withSource([&](auto& source) { nodes.read22(source, count); });
    }
    nodes_ = nodes.index(file_.scanner());
    mesh_.points = std::move(nodes.points());
  }

  void readElements(std::string_view name) {
    file_.scanner().failIfRepeated(hasElements_, concat("$", name));
    hasElements_ = true;
    if (!hasNodes_) {
      file_.scanner().fail(ErrorCode::FileUnsupported, "the section $", name,
                           " stands before the nodes; exchange them.");
    }
    const bool counted = !hasEntities(file_.version());
    const std::size_t count = counted ? file_.scanner().readCount("elements", 8) : 0;
    file_.withSource([&](auto& source) {
      if constexpr (corners == kCurved) {
        const std::size_t begin = source.position();
        beginCurved(firstGmshHexahedra(source, file_.version(), count));
        source.moveTo(begin);
      }
      GmshElements<corners> elements(kind_, places_, tags_, nodes_, mesh_, counts_, file_.stage());
      elements.read(source, file_.version(), count);
      hasOtherElements_ = elements.hasOthers();
    });
  }

  // Cells of higher order. Rows of nodes are in VTK order.

  /// @param type  requested if it is of higher order
  void beginCurved(std::int64_t type) {
    const bool isCurved = isGmshHexahedron(type) && type != kGmshHexahedron;
    kind_.gmshType = isCurved ? type : kGmshHexahedron20;
    kind_.corners = nodesOfGmshType(kind_.gmshType);
    const auto* const known =
        std::find_if(kVolumeCells.begin(), kVolumeCells.end(),
                     [&](const VolumeCells& cells) { return cells.gmshType == kind_.gmshType; });
    if (isCurved) kind_.plural = known->plural;
    mesh_.order = std::max(2, orderIn(kGmshHexahedra, kind_.gmshType));
    std::vector<std::uint32_t> placeInVtk(mesh_.nodesPerCell());
    const std::vector<std::uint32_t> inVtk = vtkNodeOrder(mesh_.order);
    for (std::uint32_t k = 0; k < inVtk.size(); ++k) placeInVtk[inVtk[k]] = k;
    places_ = gmshNodeOrder(mesh_.order);
    places_.resize(kind_.corners);
    for (std::uint32_t& place : places_) place = placeInVtk[place];
  }

  void finishCurved() {
    counts_.requireOnly(kind_, fileName_, "Give the others a file of their own.");
    if (kind_.gmshType == kGmshHexahedron20) {
      std::vector<std::size_t> all(mesh_.cellCount());
      std::iota(all.begin(), all.end(), std::size_t{0});
      addMiddles(mesh_.points, mesh_.nodes, all, fileName_);
    }
    fromVtkOrder(mesh_, file_.stage());
  }

  [[nodiscard]] bool hasCells() const {
    if constexpr (corners == kCurved) {
      return !mesh_.nodes.empty();
    } else {
      return !mesh_.cells.empty();
    }
  }

  void requireCells() const {
    const std::string holdsNone = concat(fileName_, ": the file holds no ", kind_.plural);
    if (!hasElements_) {
      throw Error(ErrorCode::FileUnsupported, holdsNone + ": it has no section $Elements.");
    }
    if (hasCells() || (!hasOtherElements_ && corners != kCurved)) return;
    const std::string kind = corners == kCurved
                                 ? std::string()
                                 : concat(" with ", corners, " nodes (type ", kind_.gmshType, ")");
    throw Error(ErrorCode::FileUnsupported, holdsNone + kind + ", but " + otherElements() + "." +
                                                (corners == 8 ? counts_.adviceOnCurved() : ""));
  }

  [[nodiscard]] std::string otherElements() const {
    const std::string volume = counts_.instead();
    return volume.empty() ? "points, lines, triangles or quads only: a surface, not a volume"
                          : "other elements only" + volume;
  }

  GmshFile file_;
  const std::string& fileName_;
  CellCounts& counts_;
  GmshTags tags_;
  NodeTags nodes_;
  bool hasNodes_ = false;
  bool hasElements_ = false;
  bool hasOtherElements_ = false;
  CellKind kind_ = kGmshKind<corners>;
  std::vector<std::uint32_t> places_;  ///< position of each node of a curved cell in its row
  GmshMesh<corners> mesh_;
};

}  // namespace

HexMesh readGmsh(const Input& input, Stage& stage) {
  return readWith<GmshReader<8>>(input, stage, input.counts());
}

TetCells readGmshTets(const Input& input, Stage& stage) {
  return readWith<GmshReader<4>>(input, stage, input.counts());
}

LagrangeMesh readCurvedGmsh(const Input& input, Stage& stage) {
  return readWith<GmshReader<kCurved>>(input, stage, input.counts());
}

namespace {

// Detects cells of higher order without loading the whole file.

/// A source of numbers over a text window.
class WindowSource {
 public:
  explicit WindowSource(TextWindow& words) : words_(words) {}

  [[nodiscard]] std::int64_t integer(const NumberName& name) {
    const std::string word = words_.token();
    std::int64_t number = 0;
    const char* const end = word.data() + word.size();
    const auto result = std::from_chars(word.data(), end, number);
    if (word.empty() || result.ec != std::errc{} || result.ptr != end)
      fail(ErrorCode::FileSyntax, name.text());
    return number;
  }
  [[nodiscard]] std::uint64_t size(const NumberName& name) {
    return static_cast<std::uint64_t>(integer(name));
  }
  void skip(std::uint64_t n, RecordShape shape) {
    if (!words_.skip(n * shape.tokens())) fail(ErrorCode::FileSyntax, "the end of the file");
  }
  [[nodiscard]] std::uint64_t position() const { return words_.position(); }
  /// Unknown; a file that is too short fails in skip().
  [[nodiscard]] static std::size_t room(RecordShape /*shape*/) {
    return std::numeric_limits<std::size_t>::max();
  }
  /// Errors lack details, since the whole-file reader reports them.
  template <class... Parts>
  [[noreturn]] static void fail(ErrorCode code, Parts... sentence) {
    throw Error(code, concat(sentence...));
  }

 private:
  TextWindow& words_;
};

/// The first occurrence of a text in a file, at or after a position; empty if there is none.
std::optional<std::uint64_t> findInFile(const ByteFile& file, std::uint64_t from,
                                        std::string_view text, Context& context) {
  constexpr std::size_t kAtOnce = std::size_t{1} << 22;
  Array<char> bytes;
  while (from + text.size() <= file.size()) {
    context.throwIfCancelled();
    bytes.resize(std::min<std::uint64_t>(kAtOnce, file.size() - from));
    file.readAt(from, bytes.data(), bytes.size());
    const std::size_t place = asText(bytes).find(text);
    if (place != std::string_view::npos) return from + place;
    from += bytes.size() - text.size() + 1;
  }
  return {};
}

/// Reads the type of the first hexahedra of a file; 0 if there are none.
class FirstHexahedra {
 public:
  static constexpr std::string_view kFirst = "$#/";

  template <class File>
  FirstHexahedra(const File& file, const std::string& name, Stage& stage)
      : file_(file, name), context_(stage.context()), words_(file_, context_, TextWindow::kWords) {}

  std::int64_t read() {
    GmshVersion version = GmshVersion::V1;
    bool isBinary = false;
    constexpr std::string_view kFormat = "$MeshFormat";
    std::uint64_t place = 0;
    if (const auto format = findInFile(file_, 0, kFormat, context_)) {
      words_.moveTo(*format + kFormat.size());
      version = gmshVersionOf(words_.token()).value_or(version);
      isBinary = words_.token() == "1";
      place = *format;
    }
    const std::string_view section = version == GmshVersion::V1 ? "$ELM" : "$Elements";
    const auto elements = findInFile(file_, place, section, context_);
    if (!elements) return 0;
    words_.moveTo(*elements + section.size());
    const std::uint64_t count = hasEntities(version) ? 0 : words_.count().value_or(0);
    WindowSource numbers(words_);
    if (!isBinary) return firstGmshHexahedra(numbers, version, count);
    if (!words_.skipLineBreak()) return 0;
    BinarySource source(file_, static_cast<std::size_t>(words_.position()), words_.stage());
    return firstGmshHexahedra(source, version, count);
  }

 private:
  ByteFile file_;
  Context& context_;
  TextWindow words_;
};

}  // namespace

bool holdsCurvedGmsh(const Input& input, Stage& stage) {
  std::int64_t type = 0;
  try {
    type = readWith<FirstHexahedra>(input, stage);
  } catch (const Error& error) {
    // The whole-file reader reports what is wrong.
    if (error.code() != ErrorCode::FileSyntax && error.code() != ErrorCode::FileUnsupported) throw;
  }
  return isGmshHexahedron(type) && type != kGmshHexahedron;
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
      if (word == "$Nodes") {
        if (!lookInside([this] { return lookAtNodes(); })) return false;
      } else if (word == "$Elements") {
        if (!lookInside([this] { return lookAtElements(); })) return false;
      } else if (word == "$Entities") {
        // Entities only assign groups to whole blocks, which pieces do not carry.
        GmshTags ignored;
        if (!lookInside([&] { return readEntities(source_, GmshVersion::V41, ignored), true; })) {
          return false;
        }
      } else if (word != "$PhysicalNames") {
        return false;
      }
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
  readPlainMesh({lookAtGmsh, readGmsh}, sink, input, context);
}

}  // namespace hexhex::io
