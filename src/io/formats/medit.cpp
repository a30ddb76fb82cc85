// `.mesh` and `.meshb` files (see formats.hpp): one reader and one writer of sections over two
// encodings of numbers, for whole files, for streaming, and for cells of order 2.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <adjacency/cell_faces.hpp>

#include <hexhex/error.hpp>
#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/sorted.hpp>
#include <base/stage.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/hdf_reader.hpp>
#include <io/core/mesh_groups.hpp>
#include <io/core/number_source.hpp>
#include <io/core/output_file.hpp>
#include <io/core/plain_mesh.hpp>
#include <io/formats/element_lists.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/lagrange_nodes.hpp>

namespace hexhex::io {
namespace {

/// Sections, by their codes in binary files.
enum class MeditSection : std::uint32_t {
  Dimension = 3,
  Vertices = 4,
  Edges = 5,
  Triangles = 6,
  Quadrilaterals = 7,
  Tetrahedra = 8,
  Prisms = 9,
  Hexahedra = 10,
  Corners = 13,
  RequiredVertices = 15,
  EdgesP2 = 25,
  QuadrilateralsQ2 = 27,
  HexahedraQ2 = 33,
  Pyramids = 49,
  End = 54,
  HexahedraQ2Ordering = 139
};

/// Keywords of sections in text files.
constexpr std::array<std::pair<MeditSection, std::string_view>, 16> kMeditKeywords = {
    {{MeditSection::Dimension, "Dimension"},
     {MeditSection::Vertices, "Vertices"},
     {MeditSection::Edges, "Edges"},
     {MeditSection::Triangles, "Triangles"},
     {MeditSection::Quadrilaterals, "Quadrilaterals"},
     {MeditSection::Tetrahedra, "Tetrahedra"},
     {MeditSection::Prisms, "Prisms"},
     {MeditSection::Pyramids, "Pyramids"},
     {MeditSection::Hexahedra, "Hexahedra"},
     {MeditSection::Corners, "Corners"},
     {MeditSection::RequiredVertices, "RequiredVertices"},
     {MeditSection::EdgesP2, "EdgesP2"},
     {MeditSection::QuadrilateralsQ2, "QuadrilateralsQ2"},
     {MeditSection::HexahedraQ2, "HexahedraQ2"},
     {MeditSection::HexahedraQ2Ordering, "HexahedraQ2Ordering"},
     {MeditSection::End, "End"}}};

/// Hexahedra of order 2.
using Hex27 = std::array<Index, 27>;
struct MeditQuadratic {
  Array<Vec3> points;
  Array<Hex27> cells;
  HexFeatures features = {};
  Array<std::int32_t> regions = {};
};
template <std::size_t corners>
using MeditMesh = std::conditional_t<corners == 27, MeditQuadratic, CellMesh<corners>>;

/// Entry k: the position of VTK's node k where a file does not tell the order. libMeshb orders
/// nodes so; only the faces differ.
constexpr std::array<std::uint8_t, 27> kMeditPlaces = {0,  1,  2,  3,  4,  5,  6,  7,  8,
                                                       9,  10, 11, 12, 13, 14, 15, 16, 17,
                                                       18, 19, 25, 23, 22, 24, 20, 21, 26};

constexpr const auto& edgesOf(const Tet& /*cell*/) { return adjacency::kTetEdges; }
template <class Cell>
constexpr const auto& edgesOf(const Cell& /*cell*/) {
  return adjacency::kHexEdges;
}

/// References of some vertex and two of its neighbours along cell edges, ascending: these mark
/// curves or surfaces, not single vertices.
template <class Cell>
std::vector<std::int32_t> crowdedReferences(const Array<std::int32_t>& references,
                                            const Array<Cell>& cells) {
  Array<Index> neighbours(references.size(), kNone);  // with equal reference; self: several
  const auto note = [&](Index vertex, Index other) {
    Index& known = neighbours[vertex];
    known = known == kNone || known == other ? other : vertex;
  };
  for (const Cell& cell : cells) {
    for (const auto& edge : edgesOf(cell)) {
      const Index a = cell[edge[0]];
      const Index b = cell[edge[1]];
      if (references[a] == 0 || references[a] != references[b]) continue;
      note(a, b);
      note(b, a);
    }
  }
  std::vector<std::int32_t> crowded;
  for (std::size_t v = 0; v < neighbours.size(); ++v) {
    if (neighbours[v] == v) crowded.push_back(references[v]);
  }
  sortUnique(crowded);
  return crowded;
}

bool allShareOne(const Array<std::int32_t>& references) {
  return std::all_of(references.begin(), references.end(),
                     [&](std::int32_t reference) { return reference == references[0]; });
}

template <class Cell>
std::vector<FeatureVertex> vertexTags(std::vector<Index> corners,
                                      const Array<std::int32_t>& references,
                                      const Array<Cell>& cells) {
  std::vector<FeatureVertex> tags;
  if (!corners.empty()) {
    sortUnique(corners);
    for (const Index v : corners) {
      const bool hasReference = !references.empty() && references[v] != 0;
      tags.push_back({v, hasReference ? references[v] : 1});
    }
    return tags;
  }
  if (allShareOne(references)) return tags;
  const std::vector<std::int32_t> crowded = crowdedReferences(references, cells);
  for (std::size_t v = 0; v < references.size(); ++v) {
    const std::int32_t reference = references[v];
    if (reference == 0 || std::binary_search(crowded.begin(), crowded.end(), reference)) continue;
    tags.push_back({static_cast<Index>(v), reference});
  }
  return tags;
}

// Reading.

constexpr CellKind kMeditEdges = {.corners = 2, .singular = "edge", .plural = "edges"};
constexpr CellKind kMeditQuads = {
    .corners = 4, .singular = "quadrilateral", .plural = "quadrilaterals"};
constexpr CellKind kMeditEdges3 = {.corners = 3, .singular = "edge", .plural = "edges"};
constexpr CellKind kMeditQuads9 = {
    .corners = 9, .singular = "quadrilateral", .plural = "quadrilaterals"};
/// Cells, with their edges and faces; elements begin with their corners.
template <std::size_t corners>
struct MeditKinds {
  static constexpr MeditSection kEdges =
      corners == 27 ? MeditSection::EdgesP2 : MeditSection::Edges;
  static constexpr MeditSection kFaces =
      corners == 4
          ? MeditSection::Triangles
          : (corners == 27 ? MeditSection::QuadrilateralsQ2 : MeditSection::Quadrilaterals);
  static constexpr CellKind kEdge = corners == 27 ? kMeditEdges3 : kMeditEdges;
  static constexpr CellKind kFace =
      corners == 4 ? kTriangleKind : (corners == 27 ? kMeditQuads9 : kMeditQuads);
};
constexpr CellKind kMeditCorners = {.corners = 1, .singular = "corner", .plural = "corners"};

/// `.mesh`: keywords and numbers separated by white space.
class MeditText {
 public:
  static constexpr bool kIsText = true;
  static constexpr std::string_view kFirst = "M#";

  MeditText(std::string_view text, const std::string& fileName, Stage& stage)
      : scanner_(text, fileName, stage, TextScanner::Comments::Hash) {
    scanner_.makeIndex();
  }

  [[nodiscard]] TextSource& source() { return scanner_; }

  void readHead() {
    if (scanner_.readToken() != "MeshVersionFormatted") {
      if (scanner_.currentToken() == "MFEM") {
        scanner_.fail(ErrorCode::FileUnsupported,
                      "this is a mesh of MFEM, which is read from files only, not from pipes.");
      }
      scanner_.fail(ErrorCode::FileSyntax,
                    "a MEDIT file begins with \"MeshVersionFormatted\", found ",
                    quoted(scanner_.currentToken()), ".");
    }
    static_cast<void>(scanner_.integer("the version of the format"));
  }

  /// Skips everything between known keywords.
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
  /// Refuses sections whose elements have more numbers, such as Gmsh's of order 2.
  void endSection(std::string_view what) {
    const std::string_view next = scanner_.peekToken();
    if (next.find_first_of("0123456789+-.") != 0) return;
    static_cast<void>(scanner_.readToken());
    scanner_.fail(ErrorCode::FileSyntax, "the section goes on with ", quoted(next), " after the ",
                  what,
                  " that it announces. If these have more nodes, save them in another format.");
  }
  [[nodiscard]] static double coordinate(TextSource& record, std::size_t i) {
    return record.real({"a coordinate of ", "vertex", i + 1});
  }
  /// Negative numbers wrap to large ones.
  [[nodiscard]] static std::uint64_t vertex(TextSource& record, const NumberName& name) {
    return static_cast<std::uint64_t>(record.integer(name));
  }
  [[nodiscard]] static std::int64_t reference(TextSource& record, std::string_view what) {
    const std::int64_t reference = record.integer(what);
    if (std::in_range<std::int32_t>(reference)) return reference;
    record.fail(ErrorCode::FileUnsupported, what, " is ", reference,
                ", which does not fit into 32 bits.");
  }

 private:
  TextSource scanner_;
};

/// `.meshb`: each section stores the position of the next one.
class MeditBytes {
 public:
  static constexpr bool kIsText = false;
  static constexpr std::string_view kFirst = {};  // its header is checked instead

  /// @param file  the bytes of the file, or an open regular file
  template <class File>
  MeditBytes(const File& file, const std::string& fileName, Stage& stage)
      : MeditBytes(ByteFile(file, fileName), stage) {}
  MeditBytes(const ByteFile& file, Stage& stage) : bytes_(file), source_(bytes_, 0, stage) {}

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
      source_.fail(ErrorCode::FileSyntax, "a .meshb file begins with the number 1, found ", one,
                   ".");
    }
    version_ = source_.integer("the version of the format");
    if (version_ < 1 || version_ > 4) {
      source_.fail(ErrorCode::FileUnsupported, "version ", version_,
                   " of the format is not known, only 1 to 4.");
    }
    next_ = source_.position();
  }

  std::optional<MeditSection> nextSection() {
    if (next_ == 0) return {};  // marks the last section in files of some programs
    const std::uint64_t begin = next_;
    source_.moveTo(static_cast<std::size_t>(begin));
    const auto section = static_cast<MeditSection>(source_.integer("the keyword of a section"));
    if (section == MeditSection::End) return {};
    const char* const what = "the position of the next section";
    next_ = version_ >= 3 ? source_.size(what) : static_cast<std::uint64_t>(source_.integer(what));
    // Only forward jumps, so that reading terminates.
    if (next_ != 0 && (next_ <= begin || next_ > bytes_.size())) {
      source_.fail(ErrorCode::FileSyntax, "the section that begins at byte ", begin,
                   " says that the next one begins at byte ", next_, " of ", bytes_.size(),
                   ": either the number is wrong or the file is incomplete.");
    }
    if (section == MeditSection::Dimension) hasDimension_ = true;
    return section;
  }

  /// Empty for version 1, whose coordinates have single precision.
  [[nodiscard]] std::optional<std::size_t> integerBytes() const {
    if (version_ == 1) return {};
    return version_ >= 4 ? 8 : 4;
  }

  void requireDimension() const {
    if (hasDimension_) return;
    source_.fail(ErrorCode::FileSyntax,
                 "the section Dimension has to stand before the other sections.");
  }

  /// Integers have 64 bits from version 4 on; coordinates of version 1 have single precision.
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
  void endSection(std::string_view /*what*/) const {}
  [[nodiscard]] double coordinate(BinaryRecord& record, std::size_t /*i*/) const {
    const char* const what = "a coordinate of a vertex";
    return version_ == 1 ? record.shortReal(what) : record.real(what);
  }
  template <class Source>
  [[nodiscard]] std::uint64_t vertex(Source& record, const NumberName& name) const {
    return version_ >= 4 ? record.size(name) : static_cast<std::uint32_t>(record.integer(name));
  }
  [[nodiscard]] std::int64_t reference(BinaryRecord& record, std::string_view what) const {
    return version_ >= 4 ? static_cast<std::int64_t>(record.size(what)) : record.integer(what);
  }

 private:
  ByteFile bytes_;
  BinarySource source_;
  std::int64_t version_ = 0;
  std::uint64_t next_ = 0;  ///< position of the next section; 0: none
  bool hasDimension_ = false;
};

/// Whether references carry information: not if all are 0 or all are 1. Thread-safe.
class SeenReferences {
 public:
  void add(std::int64_t reference) noexcept {
    const unsigned kind = reference == 0 ? kZero : (reference == 1 ? kOne : kOther);
    // Threads share one variable, but change it at most three times.
    if ((seen_.load(std::memory_order_relaxed) & kind) == 0) {
      seen_.fetch_or(kind, std::memory_order_relaxed);
    }
  }
  [[nodiscard]] bool saySomething() const noexcept {
    const unsigned seen = seen_.load(std::memory_order_relaxed);
    return seen != 0 && seen != kZero && seen != kOne;
  }
  [[nodiscard]] bool areOnes() const noexcept {
    return seen_.load(std::memory_order_relaxed) == kOne;
  }

 private:
  static constexpr unsigned kZero = 1;
  static constexpr unsigned kOne = 2;
  static constexpr unsigned kOther = 4;
  std::atomic<unsigned> seen_{0};
};

/// Reads a file from top to bottom.
template <class Encoding, std::size_t corners>
class MeditReader {
 public:
  static constexpr std::string_view kFirst = Encoding::kFirst;

  template <class File>
  requires std::is_constructible_v<Encoding, const File&, const std::string&, Stage&> MeditReader(
      const File& file, const std::string& fileName, Stage& stage, const Input& input)
      : encoding_(file, fileName, stage),
        fileName_(fileName),
        counts_(*input.counts()),
        others_(corners == 8 ? input.others() : nullptr) {}

  MeditMesh<corners> read() {
    encoding_.readHead();
    while (const auto section = encoding_.nextSection()) readSection(*section);
    if (others_ != nullptr) completeRegions();
    // Faces of an untagged boundary are not features.
    if (!faceReferences_.saySomething()) facesIn(mesh_.features).clear();
    if (others_ != nullptr && !faceReferences_.saySomething()) others_->triangles.clear();
    mesh_.features.vertices = vertexTags(std::move(corners_), references_, mesh_.cells);
    if (hasCells_) return std::move(mesh_);
    throw Error(ErrorCode::FileUnsupported,
                concat(fileName_, ": the file holds no ", kKind.plural, ": it has no section ",
                       kType.meditKeyword, counts_.instead(), ".",
                       (corners == 8 ? counts_.adviceOnCurved() : std::string())));
  }
  void requireOnlyCells() const {
    counts_.requireOnly(kKind, fileName_, "Give the others a file of their own.");
  }
  /// Entry k: the index in LagrangeMesh of node k of cells of order 2.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const noexcept { return order_; }

 private:
  static constexpr CellKind kKind = kCellKind<corners>;
  static constexpr const VolumeCells& kType = typeWith(corners);
  static constexpr std::string_view kCellReference = "the reference of a cell";

  void readSection(MeditSection section) {
    if (section == MeditSection::Dimension) readDimension();
    if (section == MeditSection::Vertices) readVertices();
    if (section == static_cast<MeditSection>(kType.meditCode)) return readCells();
    for (const VolumeCells& type : kVolumeCells) {
      if (type.meditVertices > 0 && section == static_cast<MeditSection>(type.meditCode)) {
        return countCells(type);
      }
    }
    if (section == MeditSection::HexahedraQ2Ordering && corners == 27) return readOrder();
    // Elements before the vertices cannot be validated, and no known program writes them there.
    if (!hasVertices_) return;
    if (section == MeditKinds<corners>::kEdges) {
      SeenReferences ignored;
      readFeatures(mesh_.features.edges, MeditKinds<corners>::kEdge, ignored);
    } else if (section == MeditKinds<corners>::kFaces) {
      readFeatures(facesIn(mesh_.features), MeditKinds<corners>::kFace, faceReferences_);
    } else if (section == MeditSection::Triangles && others_ != nullptr) {
      readFeatures(others_->triangles, kTriangleKind, faceReferences_);
    } else if (section == MeditSection::Corners || section == MeditSection::RequiredVertices) {
      readCorners();
    }
  }

  void readDimension() {
    const std::int64_t dimension = encoding_.source().integer("the dimension");
    if (dimension == 3) return;
    encoding_.source().fail(ErrorCode::FileUnsupported, "the dimension must be 3, found ",
                            dimension, ".");
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
    encoding_.endSection("vertices");
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

  /// Reads where the nodes of a cell of order 2 are: 0, 1 or 2 along each axis.
  void readOrder() {
    auto& source = encoding_.source();
    const RecordShape shape = encoding_.shape(3);
    std::vector<std::uint32_t> order(encoding_.readCount("places of nodes", shape));
    source.records(order.size(), shape, [&](auto& record, std::size_t i) {
      encoding_.beginElement(record, i, order.size(), "places of nodes");
      for (const std::uint32_t step : {1U, 3U, 9U}) {
        const std::uint64_t place = encoding_.vertex(record, "the place of a node");
        order[i] += place > 2 ? 27 : step * static_cast<std::uint32_t>(place);
      }
    });
    std::vector<std::uint32_t> all = order;
    std::sort(all.begin(), all.end());
    if (all.size() != order_.size() || all.back() != 26 ||
        std::adjacent_find(all.begin(), all.end()) != all.end()) {
      source.fail(ErrorCode::FileSyntax, "the section HexahedraQ2Ordering does not have the 27 ",
                  "places of nodes, each with 0, 1 or 2 along three axes.");
    }
    order_ = std::move(order);
  }

  /// Counts the cells of a section, and reads them if they are wanted.
  void countCells(const VolumeCells& type) {
    const std::size_t each = type.meditVertices;
    const std::size_t count = encoding_.readCount(type.plural, encoding_.shape(each + 1));
    counts_.add(type, count);
    if (others_ == nullptr || each > 6 || !hasVertices_) return;
    OtherCellList& cells = others_->kinds[each - 4];
    failIfRepeated(cells.count() > 0, type.meditKeyword);
    cells.vertices.resize(each * count);
    const std::string one = singular(type.plural);
    const CellKind kind = {each, one, type.plural, type.vtkType, PlaceKind::Cell};
    cells.regions =
        readReferenced(count, each, 0, kCellReference, [&](auto& record, std::size_t i) {
          encoding_.beginElement(record, i, count, type.plural);
          for (std::size_t k = 0; k < each; ++k) {
            cells.vertices[each * i + k] = readVertex(record, kind, i, 0);
          }
        });
    encoding_.endSection(type.plural);
  }

  /// References that are equal for all cells of a kind may tell these from other kinds.
  void completeRegions() {
    const auto forEach = [this](const auto& f) {
      f(mesh_.regions, mesh_.cells.size(), allOne_[corners]);
      for (OtherCellList& kind : others_->kinds) {
        f(kind.regions, kind.count(), allOne_[kind.corners]);
      }
    };
    std::set<int> said;  // 2: references that differ
    forEach([&said](const auto& regions, std::size_t count, bool allOne) {
      if (count > 0) said.insert(regions.empty() ? int{allOne} : 2);
    });
    forEach([&said](auto& regions, std::size_t count, bool allOne) {
      if (regions.empty() && said.size() > 1) regions.assign(count, int{allOne});
    });
  }

  void readCells() {
    failIfRepeated(hasCells_, kType.meditKeyword);
    if (!hasVertices_) {
      encoding_.source().fail(ErrorCode::FileUnsupported, "the section ", kType.meditKeyword,
                              " stands before the section Vertices; exchange them.");
    }
    hasCells_ = true;
    mesh_.cells.resize(encoding_.readCount(kKind.plural, encoding_.shape(corners + 1)));
    counts_.add(kKind, mesh_.cells.size());
    const auto read = [&](auto& record, std::size_t i) {
      encoding_.beginElement(record, i, mesh_.cells.size(), kKind.plural);
      for (Index& corner : mesh_.cells[i]) corner = readVertex(record, kKind, i, 0);
    };
    mesh_.regions = readReferenced(mesh_.cells.size(), corners, 0, kCellReference, read);
    encoding_.endSection(kKind.plural);
  }

  /// Reads edges or quads with their references as tags; drops those with reference 0.
  template <class Feature>
  void readFeatures(std::vector<Feature>& features, const CellKind& elements,
                    SeenReferences& seen) {
    const RecordShape shape = encoding_.shape(elements.corners + 1);
    features.assign(encoding_.readCount(elements.plural, shape), {});
    encoding_.source().records(features.size(), shape, [&](auto& record, std::size_t i) {
      const std::size_t begin = record.position();
      encoding_.beginElement(record, i, features.size(), elements.singular);
      for (std::size_t k = 0; k < elements.corners; ++k) {
        const Index vertex = readVertex(record, elements, i, begin);
        if (k < features[i].vertices.size()) features[i].vertices[k] = vertex;
      }
      const std::int64_t reference = encoding_.reference(record, "a reference");
      if (!std::in_range<std::int32_t>(reference)) failFeature(record, elements, i, begin);
      features[i].tag = static_cast<std::int32_t>(reference);
      seen.add(reference);
    });
    encoding_.endSection(elements.plural);
    std::erase_if(features, [](const Feature& feature) { return feature.tag == 0; });
  }

  /// Reads elements, each followed by its reference.
  /// @param integers, reals  how many numbers precede the reference
  /// @return the references; empty if they carry no information
  template <class F>
  [[nodiscard]] Array<std::int32_t> readReferenced(std::size_t count, std::size_t integers,
                                                   std::size_t reals, std::string_view what,
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
    allOne_[integers] = seen.areOnes();
    if (!seen.saySomething()) return {};
    if constexpr (!Encoding::kIsText) {
      // Second pass, so that the usual file takes no memory for references.
      references.resize(count);
      source.moveTo(begin);
      source.records(count, shape, [&](auto& record, std::size_t i) {
        const std::size_t place = record.position();
        record.skip(1, encoding_.shape(integers, reals));
        const std::int64_t reference = encoding_.reference(record, what);
        references[i] = static_cast<std::int32_t>(reference);
        if (std::in_range<std::int32_t>(reference)) return;
        record.moveTo(place);
        record.fail(ErrorCode::FileUnsupported, "the reference of number ", i + 1,
                    " of this section does not fit into 32 bits.");
      });
    }
    return references;
  }

  /// Reads one vertex of an element.
  /// @param begin  position of the element
  template <class Record>
  [[nodiscard]] Index readVertex(Record& record, const CellKind& elements, std::size_t i,
                                 std::size_t begin) const {
    const std::uint64_t vertex =
        encoding_.vertex(record, {"a vertex of ", elements.singular, i + 1});
    // 0 wraps to a large number.
    if (vertex - 1 < mesh_.points.size()) return static_cast<Index>(vertex - 1);
    failVertex(record, vertex, elements, i, begin);
  }

  // A separate function that takes records by value, so that the loop keeps them in registers.
  template <class Record>
  [[noreturn]] void failVertex(Record record, std::uint64_t vertex, const CellKind& elements,
                               std::size_t i, std::size_t begin) const {
    const bool isCell = elements.place != PlaceKind::None;
    if (!Encoding::kIsText && !isCell) failFeature(record, elements, i, begin);
    record.fail(ErrorCode::IndexOutOfRange, isCell ? Place{elements.place, i} : Place{},
                NumberName("", elements.singular, i + 1).text(), " names vertex ",
                record.spelling(vertex), ", but the ", mesh_.points.size(),
                " vertices are numbered from 1.");
  }

  template <class Record>
  [[noreturn]] void failFeature(Record record, const CellKind& elements, std::size_t i,
                                std::size_t begin) const {
    record.moveTo(begin);
    record.fail(ErrorCode::IndexOutOfRange, "number ", i + 1, " of the ", elements.plural,
                " names a vertex that does not exist, or a reference that does not fit into 32 "
                "bits; the ",
                mesh_.points.size(), " vertices are numbered from 1.");
  }

  void failIfRepeated(bool present, std::string_view section) {
    if (!present) return;
    encoding_.source().fail(ErrorCode::FileSyntax, "the section ", section,
                            " occurs a second time.");
  }

  Encoding encoding_;
  const std::string& fileName_;
  CellCounts& counts_;
  OtherCells* others_;                ///< null: unwanted
  std::array<bool, 28> allOne_ = {};  ///< by corners of cells: whether all references are 1
  SeenReferences faceReferences_;
  bool hasVertices_ = false;
  bool hasCells_ = false;
  std::vector<Index> corners_;           ///< from the sections Corners and RequiredVertices
  Array<std::int32_t> references_ = {};  ///< of vertices, if they carry information
  std::vector<std::uint32_t> order_ = quadraticOrder(kMeditPlaces);
  MeditMesh<corners> mesh_;
};

/// Reads cells of order 2.
template <class Encoding>
class QuadraticMeditReader : MeditReader<Encoding, 27> {
 public:
  using MeditReader<Encoding, 27>::MeditReader;
  using MeditReader<Encoding, 27>::kFirst;

  LagrangeMesh read() {
    MeditQuadratic cells = MeditReader<Encoding, 27>::read();
    this->requireOnlyCells();
    LagrangeMesh mesh;
    mesh.order = 2;
    mesh.points = std::move(cells.points);
    mesh.features = std::move(cells.features);
    mesh.regions = std::move(cells.regions);
    mesh.nodes.resize(27 * cells.cells.size());
    for (std::size_t c = 0; c < cells.cells.size(); ++c) {
      for (std::size_t k = 0; k < 27; ++k)
        mesh.nodes[27 * c + this->order()[k]] = cells.cells[c][k];
    }
    putCornersFirst(mesh);
    return mesh;
  }
};

/// Whether the first hexahedra of a file are of order 2.
template <class Encoding>
class FirstHexahedra {
 public:
  static constexpr std::string_view kFirst = {};

  template <class File>
  FirstHexahedra(const File& file, const std::string& name, Stage& stage)
      : file_(file, name), stage_(stage) {}

  bool read() {
    if constexpr (Encoding::kIsText) return areQuadratic();
    MeditBytes bytes(file_, stage_);
    bytes.readHead();
    while (const auto section = bytes.nextSection()) {
      if (section == MeditSection::Hexahedra) return false;
      if (section == MeditSection::HexahedraQ2) return true;
    }
    return false;
  }

 private:
  /// Searches a text for the keyword, which is much faster than reading all tokens before it.
  bool areQuadratic() {
    constexpr std::string_view kWord = "Hexahedra";
    constexpr std::size_t kShared = 64;  // by pieces, so that none cuts the keyword off
    constexpr std::size_t kAtOnce = std::size_t{1} << 22;
    Array<char> room(std::min(kAtOnce, file_.size()));
    for (std::size_t begin = 0; begin < file_.size(); begin += kAtOnce - kShared) {
      stage_.context().throwIfCancelled();
      const std::size_t size = std::min(kAtOnce, file_.size() - begin);
      const std::string_view text(file_.view(begin, size, room.data()), size);
      const std::size_t last = begin + size < file_.size() ? size - kShared / 2 : size;
      for (std::size_t at = text.find(kWord); at < last; at = text.find(kWord, at + 1)) {
        const std::size_t line = text.rfind('\n', at) + 1;  // 0 in the first line
        const std::string_view before = text.substr(line, at - line);
        const std::string_view rest = text.substr(at + kWord.size());
        const bool isWord = before.empty() || isSpace(before.back());
        if (!isWord || before.find('#') != std::string_view::npos) continue;
        if (!rest.starts_with("Q2Ordering")) return rest.starts_with("Q2");
      }
    }
    return false;
  }

  ByteFile file_;
  Stage& stage_;
};

}  // namespace

bool isMfem(const Input& input) {
  return withoutByteOrderMark(firstBytes(input)).starts_with("MFEM ");
}

namespace {

// Streaming.

/// Whether a section holds cells other than hexahedra.
template <class Fits>
bool isOtherCells(const Fits& fits) {
  return std::any_of(kVolumeCells.begin(), kVolumeCells.end(), [&](const VolumeCells& type) {
    return type.meditVertices > 0 && type.meditKeyword != "Hexahedra" && fits(type);
  });
}

/// The layout of a text file with a section of vertices followed by one of hexahedra.
std::optional<PlainLayout> lookAtText(const ByteFile& file, Context& context) {
  TextWindow text(file, context);
  PlainLayout layout{.isText = true, .behindPoint = 1, .behindCell = 1};
  if (text.token() != "MeshVersionFormatted" || !text.count()) return {};
  const auto skip = [&text](PlainRun& run, std::uint64_t tokensEach) {
    const std::optional<std::uint64_t> count = text.count();
    if (!count || run.position != 0) return false;
    run = {text.position(), *count};
    return text.skip(tokensEach * *count);
  };
  for (std::string word = text.token(); !word.empty() && word != "End"; word = text.token()) {
    if (word == "Vertices" && !skip(layout.points, 4)) return {};
    if (word == "Hexahedra" && !skip(layout.cells, 9)) return {};
    if (isOtherCells([&](const VolumeCells& type) { return word == type.meditKeyword; })) return {};
    if (word == "Dimension" && text.count() != 3) return {};
  }
  if (!layout.isComplete() || text.sawComments()) return {};
  return layout;
}

/// The same for binary files, version 2 or later.
std::optional<PlainLayout> lookAtBytes(const ByteFile& file, Context& context) {
  Context quiet(context.threads());
  Stage stage(quiet, "read");
  MeditBytes bytes(file, stage);
  PlainLayout layout{.behindPoint = 1, .behindCell = 1};
  bytes.readHead();
  const std::optional<std::size_t> integerBytes = bytes.integerBytes();
  if (!integerBytes) return {};
  layout.integerBytes = *integerBytes;
  const auto look = [&bytes](PlainRun& run, RecordShape shape) {
    if (run.position != 0) return false;
    run.count = bytes.vertex(bytes.source(), "the number of elements");
    run.position = bytes.source().position();
    return run.count <= bytes.source().room(shape);
  };
  while (const auto section = bytes.nextSection()) {
    if (section == MeditSection::Dimension && bytes.source().integer("the dimension") != 3) {
      return {};
    }
    if (section == MeditSection::Vertices) {
      bytes.requireDimension();
      if (!look(layout.points, bytes.shape(1, 3))) return {};
    }
    if (isOtherCells([&](const VolumeCells& type) {
          return *section == static_cast<MeditSection>(type.meditCode);
        })) {
      return {};
    }
    if (section == MeditSection::Hexahedra && !look(layout.cells, bytes.shape(9))) return {};
  }
  if (!layout.isComplete()) return {};
  return layout;
}

// Writing. A mesh in memory is written as a stream of one piece, with groups.

struct MeditCounts {
  std::uint64_t vertices = 0;
  std::uint64_t edges = 0;
  std::uint64_t quads = 0;
  std::uint64_t hexahedra = 0;
  std::uint64_t nodes = 8;   ///< of each hexahedron
  std::uint64_t others = 0;  ///< cells and triangles beside them, at most
};

/// Everything except vertices and cells.
struct MeditGroups {
  Array<std::uint32_t> vertexReferences;  ///< empty: all 0
  EdgeGroups edges;
  Array<std::uint32_t> edgeReferences;
  QuadGroups quads;
  Array<std::uint32_t> quadReferences;
  Array<std::array<Index, 3>> triangles;
  Array<std::uint32_t> triangleReferences;
  Array<std::uint32_t> cellReferences;  ///< as in AllCells; empty: all 1

  MeditGroups(const HexMesh& mesh, bool withEdges, const WriteOptions& options, Stage& stage)
      : vertexReferences(io::vertexReferences(mesh, groupVertices(mesh))),
        cellReferences(io::cellReferences(mesh, Untagged::Zero, othersOf(options))) {
    if (withEdges) edges = groupEdges(mesh);
    edgeReferences = groupNumbers(edges.groups);
    quads = groupQuads(mesh, options.patchAngle, stage, nullptr, othersOf(options));
    quadReferences = groupNumbers(quads.groups, Untagged::Zero);
    if (othersOf(options).count() == 0) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < quads.elements.size(); ++i) {
      const Quad v = quads.elements[i];
      if (cornersOf(v) == 4) {
        quadReferences[kept] = quadReferences[i];
        quads.elements[kept++] = v;
      } else {
        triangles.push_back({v[0], v[1], v[2]});
        triangleReferences.push_back(quadReferences[i]);
      }
    }
    quads.elements.resize(kept);
    quadReferences.resize(kept);
  }
};

/// `.mesh`: a line per element. Tagged edges are left out: viewers that read only what they display
/// fail on the section.
class MeditLines {
 public:
  static constexpr bool kHoldsEdges = false;
  static constexpr std::size_t kRoom = kNumberRoom + 1;  // per number

  explicit MeditLines(OutputFile& output) : output_(output) {}

  void begin(const MeditCounts& /*counts*/, std::uint32_t /*version*/) {
    output_.write("MeshVersionFormatted 2\nDimension 3\n");
  }
  void beginSection(MeditSection section, std::uint64_t count, std::uint64_t /*integers*/,
                    std::uint64_t /*reals*/ = 0) {
    const auto isIt = [section](const auto& keyword) { return keyword.first == section; };
    const auto keyword = std::find_if(kMeditKeywords.begin(), kMeditKeywords.end(), isIt);
    output_.write(keyword->second).write('\n').write(count).write('\n');
  }
  void end() { output_.write("End\n"); }

  static char* point(char* place, const Vec3& point) { return put(putNumbers(place, point), ' '); }
  static char* vertex(char* place, std::uint64_t number) { return put(put(place, number), ' '); }
  static char* reference(char* place, std::uint32_t number) {
    // Nearly all are 0 or 1; to_chars() for these would take 10 % of the writing time.
    place = number < 10 ? put(place, static_cast<char>('0' + number)) : put(place, number);
    return put(place, '\n');
  }

 private:
  OutputFile& output_;
};

/// `.meshb`: each section stores the position of the next one.
class MeditRecords {
 public:
  static constexpr bool kHoldsEdges = true;
  static constexpr std::size_t kRoom = 8;

  explicit MeditRecords(OutputFile& output) : output_(output) {}

  /// @param version  0: the lowest that can hold the mesh
  void begin(const MeditCounts& counts, std::uint32_t version) {
    setVersion(version == 0 ? versionFor(counts) : version);
    writeBytesOf(output_, std::uint32_t{1});  // marks the byte order
    writeBytesOf(output_, version_);
    position_ = 8;
    beginSection(MeditSection::Dimension, 4 + positionBytes() + 4);
    writeBytesOf(output_, std::uint32_t{3});
  }
  void beginSection(MeditSection section, std::uint64_t count, std::uint64_t integers,
                    std::uint64_t reals = 0) {
    beginSection(section, bytesOf(count, integers, reals));
    writeInteger(count, integerBytes());
  }
  void end() {
    writeBytesOf(output_, MeditSection::End);
    writeInteger(0, positionBytes());
  }

  static char* point(char* place, const Vec3& point) { return putBytes(place, point); }
  char* vertex(char* place, std::uint64_t number) const {
    return version_ >= 4 ? putBytes(place, number)
                         : putBytes(place, static_cast<std::uint32_t>(number));
  }
  char* reference(char* place, std::uint32_t number) const { return vertex(place, number); }

 private:
  [[nodiscard]] std::uint64_t positionBytes() const { return version_ >= 3 ? 8 : 4; }
  [[nodiscard]] std::uint64_t integerBytes() const { return version_ >= 4 ? 8 : 4; }
  /// Bytes of a section with its header.
  [[nodiscard]] std::uint64_t bytesOf(std::uint64_t count, std::uint64_t integers,
                                      std::uint64_t reals) const {
    return 4 + positionBytes() + integerBytes() + count * (integers * integerBytes() + 8 * reals);
  }

  void setVersion(std::uint32_t version) { version_ = version; }
  std::uint32_t versionFor(const MeditCounts& counts) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
    if (std::max({counts.vertices, counts.quads, counts.hexahedra, counts.others}) > kMost)
      return 4;
    setVersion(2);
    const bool quadratic = counts.nodes == 27;
    const std::uint64_t bytes = 64 + bytesOf(counts.vertices, 1, 3) +
                                bytesOf(counts.edges, quadratic ? 4 : 3, 0) +
                                bytesOf(counts.quads, quadratic ? 10 : 5, 0) +
                                bytesOf(counts.hexahedra, counts.nodes + 1, 0) +
                                (counts.others > 0 ? bytesOf(counts.others + 8, 7, 0) : 0) +
                                (quadratic ? bytesOf(counts.nodes, 3, 0) : 0);
    return bytes > kMost ? 3 : 2;
  }

  void beginSection(MeditSection section, std::uint64_t bytes) {
    position_ += bytes;
    writeBytesOf(output_, section);
    writeInteger(position_, positionBytes());
  }
  void writeInteger(std::uint64_t number, std::uint64_t bytes) {
    writeBytesOf(output_, static_cast<std::uint32_t>(number));
    if (bytes == 8) writeBytesOf(output_, static_cast<std::uint32_t>(number >> 32U));
  }

  OutputFile& output_;
  std::uint32_t version_ = 0;
  std::uint64_t position_ = 0;
};

/// Writes a file front to back.
template <class Encoding>
class MeditWriter {
 public:
  MeditWriter(OutputFile& output, int threads) : lines_(output, threads), encoding_(output) {}

  /// Writes a whole mesh. Elements list all their nodes.
  template <std::size_t ofEdge, std::size_t ofQuad, std::size_t ofCell>
  void write(std::span<const Vec3> points, std::span<const std::array<Index, ofEdge>> edges,
             std::span<const std::array<Index, ofQuad>> quads,
             std::span<const std::array<Index, ofCell>> cells, const OtherCells& others,
             const MeditGroups& groups, std::uint32_t version, Stage& stage) {
    using Kinds = MeditKinds<ofCell>;
    const MeditCounts counts = {points.size(), edges.size(),
                                quads.size(),  cells.size(),
                                ofCell,        groups.triangles.size() + others.count()};
    LoopProgress progress(
        stage, counts.vertices + counts.edges + counts.quads + counts.hexahedra + counts.others);
    encoding_.begin(counts, version);
    encoding_.beginSection(MeditSection::Vertices, counts.vertices, 1, 3);
    writeVertices(points, groups.vertexReferences, &progress);
    if (counts.edges > 0) {
      encoding_.beginSection(Kinds::kEdges, counts.edges, ofEdge + 1);
      writeElements(edges, groups.edgeReferences, &progress);
    }
    encoding_.beginSection(Kinds::kFaces, counts.quads, ofQuad + 1);
    writeElements(quads, groups.quadReferences, &progress);
    if (!groups.triangles.empty()) {
      encoding_.beginSection(MeditSection::Triangles, groups.triangles.size(), 4);
      writeElements(std::span<const std::array<Index, 3>>(groups.triangles),
                    groups.triangleReferences, &progress);
    }
    if constexpr (ofCell == 27) writeOrder();
    encoding_.beginSection(static_cast<MeditSection>(typeWith(ofCell).meditCode), counts.hexahedra,
                           ofCell + 1);
    std::span<const std::uint32_t> references = groups.cellReferences;
    writeElements(cells, references, &progress);
    std::size_t before = cells.size();
    forEachOtherKind(others, [&](auto ofKind) {
      if (!references.empty()) references = references.subspan(before);
      before = ofKind.size();
      const std::size_t corners = ofKind[0].size();
      encoding_.beginSection(static_cast<MeditSection>(typeWith(corners).meditCode), ofKind.size(),
                             corners + 1);
      this->writeElements(ofKind, references, &progress);
    });
    end();
  }

  // Meshes in pieces.
  void begin(std::uint64_t vertices, std::uint64_t cells) {
    cells_ = cells;
    encoding_.begin({.vertices = vertices, .hexahedra = cells}, 0);
    encoding_.beginSection(MeditSection::Vertices, vertices, 1, 3);
  }
  void points(const PointPiece& piece) { writeVertices(piece.points, {}, nullptr); }
  void beginCells() { encoding_.beginSection(MeditSection::Hexahedra, cells_, 9); }
  template <class Cell>
  void cells(std::uint64_t /*first*/, std::span<const Cell> cells) {
    writeElements(cells, {}, nullptr);
  }
  void end() { encoding_.end(); }

 private:
  /// @param references  empty: all are 0
  void writeVertices(std::span<const Vec3> points, std::span<const std::uint32_t> references,
                     LoopProgress* progress) {
    const auto vertex = [&](char* place, std::size_t i) {
      place = encoding_.point(place, points[i]);
      return encoding_.reference(place, references.empty() ? 0 : references[i]);
    };
    lines_.write(points.size(), 4 * Encoding::kRoom, vertex, progress);
  }

  /// Writes where the nodes of cells of order 2 are.
  void writeOrder() {
    const std::vector<std::uint32_t> order = quadraticOrder(kMeditPlaces);
    encoding_.beginSection(MeditSection::HexahedraQ2Ordering, order.size(), 3);
    const auto place = [&](char* to, std::size_t i) {
      to = encoding_.vertex(encoding_.vertex(to, order[i] % 3), order[i] / 3 % 3);
      return encoding_.reference(to, order[i] / 9);
    };
    lines_.write(order.size(), 3 * Encoding::kRoom, place, nullptr);
  }

  /// @param references  empty: all are 1
  template <class Vertex, std::size_t n>
  void writeElements(std::span<const std::array<Vertex, n>> elements,
                     std::span<const std::uint32_t> references, LoopProgress* progress) {
    const auto element = [&](char* place, std::size_t i) {
      // In 64 bits: 32 would overflow for the last vertex of the largest mesh.
      for (const Vertex vertex : elements[i]) {
        place = encoding_.vertex(place, std::uint64_t{vertex} + 1);
      }
      return encoding_.reference(place, references.empty() ? 1 : references[i]);
    };
    lines_.write(elements.size(), (n + 1) * Encoding::kRoom, element, progress);
  }

  LineWriter lines_;
  Encoding encoding_;
  std::uint64_t cells_ = 0;
};

template <class Encoding>
void writeWhole(const HexMesh& mesh, OutputFile& output, std::uint32_t version,
                const WriteOptions& options, Stage& stage) {
  const MeditGroups groups(mesh, Encoding::kHoldsEdges, options, stage);
  MeditWriter<Encoding>(output, stage.context().threads())
      .write(std::span<const Vec3>(mesh.points),
             std::span<const std::array<Index, 2>>(groups.edges.elements),
             std::span<const Quad>(groups.quads.elements), std::span<const Hex>(mesh.cells),
             othersOf(options), groups, version, stage);
}

template <bool binary>
using Reading = std::conditional_t<binary, MeditBytes, MeditText>;
template <bool binary>
using Writing = std::conditional_t<binary, MeditRecords, MeditLines>;

}  // namespace

template <bool binary>
HexMesh MeditFormat<binary>::readMesh(const Input& input, Stage& stage) {
  if (!binary && isMfem(input)) return MfemFormat::readMesh(input, stage);
  return readWith<MeditReader<Reading<binary>, 8>>(input, stage, input);
}

template <bool binary>
TetCells MeditFormat<binary>::readTets(const Input& input, Stage& stage) {
  if (!binary && isMfem(input)) return MfemFormat::readTets(input, stage);
  return readWith<MeditReader<Reading<binary>, 4>>(input, stage, input);
}

template <bool binary>
bool MeditFormat<binary>::holdsCurved(const Input& input, Stage& stage) {
  if (!binary && isMfem(input)) return MfemFormat::holdsCurved(input, stage);
  return readWith<FirstHexahedra<Reading<binary>>>(input, stage);
}

template <bool binary>
LagrangeMesh MeditFormat<binary>::readCurved(const Input& input, Stage& stage) {
  if (!binary && isMfem(input)) return MfemFormat::readCurved(input, stage);
  return readWith<QuadraticMeditReader<Reading<binary>>>(input, stage, input);
}

template <bool binary>
void MeditFormat<binary>::readTo(MeshSink& sink, const Input& input, Context& context) {
  readPlainMesh({binary ? lookAtBytes : lookAtText, readMesh}, sink, input, context);
}

template <bool binary>
void MeditFormat<binary>::write(const HexMesh& mesh, OutputFile& output,
                                const WriteOptions& options, Stage& stage) {
  writeWhole<Writing<binary>>(mesh, output, 0, options, stage);
}

template <bool binary>
void MeditFormat<binary>::writeCurved(const LagrangeMesh& mesh, OutputFile& output,
                                      const WriteOptions& options, Stage& stage) {
  using Encoding = Writing<binary>;
  const HexMesh straight = straightMesh(mesh);
  MeditGroups groups(straight, Encoding::kHoldsEdges, options, stage);
  if (!groups.vertexReferences.empty()) groups.vertexReferences.resize(mesh.points.size(), 0);
  const GroupNodes nodes = nodesOfGroups(mesh, straight, groups.edges, groups.quads, stage);
  const std::vector<std::uint32_t> order = quadraticOrder(kMeditPlaces);
  Array<Hex27> cells(mesh.cellCount());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (std::size_t k = 0; k < 27; ++k) cells[c][k] = mesh.nodes[27 * c + order[k]];
  }
  MeditWriter<Encoding>(output, stage.context().threads())
      .write(std::span<const Vec3>(mesh.points), inRows<3>(nodes.edges), inRows<9>(nodes.quads),
             std::span<const Hex27>(cells), noOthers(), groups, 0, stage);
}

template <bool binary>
std::unique_ptr<MeshSink> MeditFormat<binary>::openSink(const std::filesystem::path& file,
                                                        Context& context) {
  return openWriterSink<MeditWriter<Writing<binary>>>(file, context);
}

template struct MeditFormat<false>;
template struct MeditFormat<true>;

void writeMeshbVersion(const HexMesh& mesh, OutputFile& output, std::uint32_t version,
                       Stage& stage) {
  writeWhole<MeditRecords>(mesh, output, version, {}, stage);
}

}  // namespace hexhex::io
