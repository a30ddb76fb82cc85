// The reading half of medit.hpp: one reader of sections over two encodings of numbers.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <io/core/number_source.hpp>
#include <io/medit/medit.hpp>
#include <io/medit/vertex_tags.hpp>

namespace hexhex::io {
namespace {

constexpr CellKind kMeditEdges = {.corners = 2, .singular = "edge", .plural = "edges"};
constexpr CellKind kMeditQuads = {
    .corners = 4, .singular = "quadrilateral", .plural = "quadrilaterals"};
constexpr CellKind kMeditCorners = {.corners = 1, .singular = "corner", .plural = "corners"};

/// `.mesh`: keywords and numbers between white space.
class MeditText {
 public:
  static constexpr bool kIsText = true;
  static constexpr std::string_view kFirst = "M#";

  MeditText(std::string_view text, const std::string& fileName, Stage& stage)
      : scanner_(text, fileName, TextScanner::Comments::Hash) {
    if (text.find('#') == std::string_view::npos) index_.emplace(text, stage);
    source_.emplace(scanner_, index_ ? &*index_ : nullptr, stage);
  }

  [[nodiscard]] TextSource& source() { return *source_; }

  void readHead() {
    if (scanner_.readToken() != "MeshVersionFormatted") {
      scanner_.fail(ErrorCode::FileSyntax,
                    "a MEDIT file begins with \"MeshVersionFormatted\", found " +
                        quoted(scanner_.currentToken()) + ".");
    }
    static_cast<void>(source_->integer("the version of the format"));
  }

  /// What is between known keywords is passed over.
  std::optional<MeditSection> nextSection() {
    while (scanner_.skipSpace()) {
      const std::string_view keyword = scanner_.readToken();
      for (const auto& [section, name] : kMeditKeywords) {
        if (keyword != name) continue;
        if (section == MeditSection::End) return {};
        return section;
      }
      for (const VolumeCells& type : kVolumeCells) {
        if (keyword == type.meditKeyword) return static_cast<MeditSection>(type.meditCode);
      }
    }
    return {};
  }

  void requireDimension() const {}

  [[nodiscard]] static RecordShape shape(std::size_t integers, std::size_t reals = 0) {
    return {.integers = integers, .reals = reals};
  }
  [[nodiscard]] std::size_t readCount(std::string_view what, RecordShape shape) {
    return scanner_.readCount(what, 2 * shape.tokens());  // a digit and a separator each
  }

  static void beginElement(TextSource& record, std::size_t i, std::size_t count,
                           std::string_view what) {
    record.failIfAtEnd(i, count, what);
  }
  [[nodiscard]] static double coordinate(TextSource& record, std::size_t i) {
    return record.real({"a coordinate of ", "vertex", i + 1});
  }
  /// A negative one becomes large.
  [[nodiscard]] static std::uint64_t vertex(TextSource& record, const NumberName& name) {
    return static_cast<std::uint64_t>(record.integer(name));
  }
  [[nodiscard]] static std::int64_t reference(TextSource& record, const char* what) {
    const std::int64_t reference = record.integer(what);
    if (std::in_range<std::int32_t>(reference)) return reference;
    record.fail(ErrorCode::FileUnsupported, std::string(what) + " is " + std::to_string(reference) +
                                                ", which does not fit into 32 bits.");
  }

 private:
  TextScanner scanner_;
  std::optional<TokenIndex> index_;  ///< only for a text without comments
  std::optional<TextSource> source_;
};

/// `.meshb`: each section says where the next one begins.
class MeditBytes {
 public:
  static constexpr bool kIsText = false;
  static constexpr std::string_view kFirst = {};  // its head says more

  /// @param file  the bytes of the file, or the open file, a regular one
  template <class File>
  MeditBytes(const File& file, const std::string& fileName, Stage& stage)
      : bytes_(file, fileName), source_(bytes_, 0, stage) {}

  [[nodiscard]] BinarySource& source() { return source_; }

  void readHead() {
    constexpr std::int64_t kSwappedOne = std::int64_t{1} << 24U;
    const std::int64_t one = source_.integer("the mark of the byte order");
    if (one == kSwappedOne) {
      source_.fail(ErrorCode::FileUnsupported,
                   "the bytes of numbers come in the order of another kind of computers; convert "
                   "the file to .mesh.");
    }
    if (one != 1) {
      source_.fail(ErrorCode::FileSyntax,
                   "a .meshb file begins with the number 1, found " + std::to_string(one) + ".");
    }
    version_ = source_.integer("the version of the format");
    if (version_ < 1 || version_ > 4) {
      source_.fail(ErrorCode::FileUnsupported, "version " + std::to_string(version_) +
                                                   " of the format is not known, only 1 to 4.");
    }
    next_ = source_.position();
  }

  std::optional<MeditSection> nextSection() {
    if (next_ == 0) return {};  // how some programs mark the last section
    const std::uint64_t begin = next_;
    source_.moveTo(static_cast<std::size_t>(begin));
    const auto section = static_cast<MeditSection>(source_.integer("the keyword of a section"));
    if (section == MeditSection::End) return {};
    const char* const what = "the position of the next section";
    next_ = version_ >= 3 ? source_.size(what) : static_cast<std::uint64_t>(source_.integer(what));
    // Only forwards, so that reading ends.
    if (next_ != 0 && (next_ <= begin || next_ > bytes_.size())) {
      source_.fail(ErrorCode::FileSyntax,
                   "the section that begins at byte " + std::to_string(begin) +
                       " says that the next one begins at byte " + std::to_string(next_) + " of " +
                       std::to_string(bytes_.size()) +
                       ": either the number is wrong or the file is incomplete.");
    }
    if (section == MeditSection::Dimension) hasDimension_ = true;
    return section;
  }

  void requireDimension() const {
    if (hasDimension_) return;
    source_.fail(ErrorCode::FileSyntax,
                 "the section Dimension has to stand before the other sections.");
  }

  /// Integers have 64 bits from version 4 on, coordinates in version 1 single precision.
  [[nodiscard]] RecordShape shape(std::size_t integers, std::size_t reals = 0) const {
    RecordShape shape;
    (version_ >= 4 ? shape.sizes : shape.integers) = integers;
    (version_ == 1 ? shape.integers : shape.reals) += reals;
    return shape;
  }
  [[nodiscard]] std::size_t readCount(std::string_view what, RecordShape shape) {
    const std::uint64_t count = vertex(source_, {"the number of ", what});
    requireRoom(source_, count, shape, what);
    if (count > kNone) source_.fail(ErrorCode::TooLarge, exceedsLimit(count, what, kNone));
    return static_cast<std::size_t>(count);
  }

  static void beginElement(BinaryRecord& /*record*/, std::size_t /*i*/, std::size_t /*count*/,
                           std::string_view /*what*/) {}
  [[nodiscard]] double coordinate(BinaryRecord& record, std::size_t /*i*/) const {
    const char* const what = "a coordinate of a vertex";
    return version_ == 1 ? record.shortReal(what) : record.real(what);
  }
  template <class Source>
  [[nodiscard]] std::uint64_t vertex(Source& record, const NumberName& name) const {
    return version_ >= 4 ? record.size(name) : static_cast<std::uint32_t>(record.integer(name));
  }
  [[nodiscard]] std::int64_t reference(BinaryRecord& record, const char* what) const {
    return version_ >= 4 ? static_cast<std::int64_t>(record.size(what)) : record.integer(what);
  }

 private:
  ByteFile bytes_;
  BinarySource source_;
  std::int64_t version_ = 0;
  std::uint64_t next_ = 0;  ///< where the next section begins; 0: there is none
  bool hasDimension_ = false;
};

/// Whether references say anything, looked at by several threads: not if all are 0, or all are 1.
class SeenReferences {
 public:
  void add(std::int64_t reference) noexcept {
    const unsigned kind = reference == 0 ? kZero : (reference == 1 ? kOne : kOther);
    // Threads share one number, but change it three times at most.
    if ((seen_.load(std::memory_order_relaxed) & kind) == 0) {
      seen_.fetch_or(kind, std::memory_order_relaxed);
    }
  }
  [[nodiscard]] bool saySomething() const noexcept {
    const unsigned seen = seen_.load(std::memory_order_relaxed);
    return seen != 0 && seen != kZero && seen != kOne;
  }

 private:
  static constexpr unsigned kZero = 1;
  static constexpr unsigned kOne = 2;
  static constexpr unsigned kOther = 4;
  std::atomic<unsigned> seen_{0};
};

/// Reads one file from top to bottom.
template <class Encoding, std::size_t corners>
class MeditReader {
 public:
  static constexpr std::string_view kFirst = Encoding::kFirst;

  template <class File>
  requires std::is_constructible_v<Encoding, const File&, const std::string&, Stage&> MeditReader(
      const File& file, const std::string& fileName, Stage& stage,
      const std::shared_ptr<CellCounts>& counts)
      : encoding_(file, fileName, stage), fileName_(fileName), counts_(*counts) {}

  CellMesh<corners> read() {
    encoding_.readHead();
    while (const auto section = encoding_.nextSection()) readSection(*section);
    if constexpr (corners == 8) {
      mesh_.features.vertices = vertexTags(std::move(corners_), references_, mesh_.cells);
    }
    if (hasCells_) return std::move(mesh_);
    throw Error(ErrorCode::FileUnsupported, fileName_ + ": the file holds no " +
                                                std::string(kKind.plural) + ": it has no section " +
                                                std::string(kKind.meditKeyword) +
                                                counts_.instead() + ".");
  }

 private:
  static constexpr CellKind kKind = kCellKind<corners>;

  void readSection(MeditSection section) {
    if (section == MeditSection::Dimension) readDimension();
    if (section == MeditSection::Vertices) readVertices();
    if (section == static_cast<MeditSection>(kKind.meshbKeyword)) return readCells();
    for (const VolumeCells& type : kVolumeCells) {
      if (type.meditVertices > 0 && section == static_cast<MeditSection>(type.meditCode)) {
        return countCells(type);
      }
    }
    // What stands before the vertices cannot be checked, and no known program writes it there.
    if (corners != 8 || !hasVertices_) return;
    if (section == MeditSection::Edges) {
      static_cast<void>(readFeatures(mesh_.features.edges, kMeditEdges));
    } else if (section == MeditSection::Quadrilaterals) {
      // Those of a boundary without tags are no features.
      if (!readFeatures(mesh_.features.quads, kMeditQuads)) mesh_.features.quads.clear();
    } else if (section == MeditSection::Corners || section == MeditSection::RequiredVertices) {
      readCorners();
    }
  }

  void readDimension() {
    const std::int64_t dimension = encoding_.source().integer("the dimension");
    if (dimension == 3) return;
    encoding_.source().fail(ErrorCode::FileUnsupported,
                            "the dimension must be 3, found " + std::to_string(dimension) + ".");
  }

  void readVertices() {
    failIfRepeated(hasVertices_, "Vertices");
    encoding_.requireDimension();
    hasVertices_ = true;
    mesh_.points.resize(encoding_.readCount("vertices", encoding_.shape(1, 3)));
    const auto read = [&](auto& record, std::size_t i) {
      encoding_.beginElement(record, i, mesh_.points.size(), "vertices");
      for (double& coordinate : mesh_.points[i]) coordinate = encoding_.coordinate(record, i);
    };
    references_ = readReferenced(mesh_.points.size(), 0, 3, "the reference of a vertex", read);
  }

  void readCorners() {
    const std::size_t known = corners_.size();
    const RecordShape shape = encoding_.shape(1);
    corners_.resize(known + encoding_.readCount(kMeditCorners.plural, shape));
    encoding_.source().records(corners_.size() - known, shape, [&](auto& record, std::size_t i) {
      const std::size_t begin = record.position();
      encoding_.beginElement(record, i, corners_.size() - known, kMeditCorners.plural);
      corners_[known + i] = readVertex(record, kMeditCorners, i, begin);
    });
  }

  /// Counts those of a section, and leaves them where they are.
  void countCells(const VolumeCells& type) {
    counts_.add(type, encoding_.readCount(type.plural, encoding_.shape(type.meditVertices + 1)));
  }

  void readCells() {
    failIfRepeated(hasCells_, kKind.meditKeyword);
    if (!hasVertices_) {
      encoding_.source().fail(ErrorCode::FileUnsupported,
                              "the section " + std::string(kKind.meditKeyword) +
                                  " stands before the section Vertices; exchange them.");
    }
    hasCells_ = true;
    mesh_.cells.resize(encoding_.readCount(kKind.plural, encoding_.shape(corners + 1)));
    counts_.add(kKind, mesh_.cells.size());
    const auto read = [&](auto& record, std::size_t i) {
      encoding_.beginElement(record, i, mesh_.cells.size(), kKind.plural);
      for (Index& corner : mesh_.cells[i]) corner = readVertex(record, kKind, i, 0);
    };
    mesh_.regions = readReferenced(mesh_.cells.size(), corners, 0, "the reference of a cell", read);
  }

  /// Edges or quads, with their references as tags; without those of reference 0.
  /// @return whether references say anything
  template <class Feature>
  [[nodiscard]] bool readFeatures(std::vector<Feature>& features, const CellKind& elements) {
    const RecordShape shape = encoding_.shape(elements.corners + 1);
    features.assign(encoding_.readCount(elements.plural, shape), {});
    SeenReferences seen;
    encoding_.source().records(features.size(), shape, [&](auto& record, std::size_t i) {
      const std::size_t begin = record.position();
      encoding_.beginElement(record, i, features.size(), elements.singular);
      for (Index& vertex : features[i].vertices) vertex = readVertex(record, elements, i, begin);
      const std::int64_t reference = encoding_.reference(record, "a reference");
      if (!std::in_range<std::int32_t>(reference)) failFeature(record, elements, i, begin);
      features[i].tag = static_cast<std::int32_t>(reference);
      seen.add(reference);
    });
    std::erase_if(features, [](const Feature& feature) { return feature.tag == 0; });
    return seen.saySomething();
  }

  /// Reads elements: what stands in front of the reference of each, and the references.
  /// @param integers, reals  how many numbers stand in front
  /// @return the references; nothing if they say nothing
  template <class F>
  [[nodiscard]] Array<std::int32_t> readReferenced(std::size_t count, std::size_t integers,
                                                   std::size_t reals, const char* what,
                                                   const F& read) {
    auto& source = encoding_.source();
    const RecordShape shape = encoding_.shape(integers + 1, reals);
    const std::size_t begin = source.position();
    Array<std::int32_t> references(Encoding::kIsText ? count : 0);
    SeenReferences seen;
    source.records(count, shape, [&](auto& record, std::size_t i) {
      read(record, i);
      const std::int64_t reference = encoding_.reference(record, what);
      seen.add(reference);
      if (Encoding::kIsText) references[i] = static_cast<std::int32_t>(reference);
    });
    if (corners != 8 || !seen.saySomething()) return {};
    if constexpr (!Encoding::kIsText) {
      // Only now, so that the usual file takes no memory for references.
      references.resize(count);
      source.moveTo(begin);
      source.records(count, shape, [&](auto& record, std::size_t i) {
        const std::size_t place = record.position();
        record.skip(1, encoding_.shape(integers, reals));
        const std::int64_t reference = encoding_.reference(record, what);
        references[i] = static_cast<std::int32_t>(reference);
        if (std::in_range<std::int32_t>(reference)) return;
        record.moveTo(place);
        record.fail(ErrorCode::FileUnsupported, "the reference of number " + std::to_string(i + 1) +
                                                    " of this section does not fit into 32 bits.");
      });
    }
    return references;
  }

  /// One vertex of an element.
  /// @param begin  where the element stands
  template <class Record>
  [[nodiscard]] Index readVertex(Record& record, const CellKind& elements, std::size_t i,
                                 std::size_t begin) const {
    const std::uint64_t vertex =
        encoding_.vertex(record, {"a vertex of ", elements.singular, i + 1});
    // 0, which is too small, becomes a large number.
    if (vertex - 1 < mesh_.points.size()) return static_cast<Index>(vertex - 1);
    failVertex(record, vertex, elements, i, begin);
  }

  // Apart, with records by value, so that what is read stays in registers.
  template <class Record>
  [[noreturn]] void failVertex(Record record, std::uint64_t vertex, const CellKind& elements,
                               std::size_t i, std::size_t begin) const {
    const bool isCell = elements.place != PlaceKind::None;
    if (!Encoding::kIsText && !isCell) failFeature(record, elements, i, begin);
    record.fail(ErrorCode::IndexOutOfRange,
                NumberName("", elements.singular, i + 1).text() + " names vertex " +
                    record.spelling(vertex) + ", but the " + std::to_string(mesh_.points.size()) +
                    " vertices are numbered from 1.",
                isCell ? Place{elements.place, i} : Place{});
  }

  template <class Record>
  [[noreturn]] void failFeature(Record record, const CellKind& elements, std::size_t i,
                                std::size_t begin) const {
    record.moveTo(begin);
    record.fail(ErrorCode::IndexOutOfRange,
                "number " + std::to_string(i + 1) + " of the " + std::string(elements.plural) +
                    " names a vertex that does not exist, or a reference that does not fit into 32 "
                    "bits; the " +
                    std::to_string(mesh_.points.size()) + " vertices are numbered from 1.");
  }

  void failIfRepeated(bool present, std::string_view section) {
    if (!present) return;
    encoding_.source().fail(ErrorCode::FileSyntax,
                            "the section " + std::string(section) + " occurs a second time.");
  }

  Encoding encoding_;
  const std::string& fileName_;
  CellCounts& counts_;
  bool hasVertices_ = false;
  bool hasCells_ = false;
  std::vector<Index> corners_;           ///< of the sections Corners and RequiredVertices
  Array<std::int32_t> references_ = {};  ///< of vertices, if they say something
  CellMesh<corners> mesh_;
};

}  // namespace

HexMesh readMedit(const Input& input, Context& context) {
  return readWith<MeditReader<MeditText, 8>>(input, "read mesh", context, input.counts());
}

HexMesh readMeshb(const Input& input, Context& context) {
  return readWith<MeditReader<MeditBytes, 8>>(input, "read mesh", context, input.counts());
}

TetCells readMeditTets(const Input& input, Context& context) {
  return readWith<MeditReader<MeditText, 4>>(input, "read tets", context, input.counts());
}

TetCells readMeshbTets(const Input& input, Context& context) {
  return readWith<MeditReader<MeditBytes, 4>>(input, "read tets", context, input.counts());
}

}  // namespace hexhex::io
