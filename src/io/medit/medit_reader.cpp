// The reading half of medit.hpp.
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/cell_mesh.hpp>
#include <io/core/input_file.hpp>
#include <io/core/references.hpp>
#include <io/core/text_scanner.hpp>
#include <io/medit/medit.hpp>

namespace hexhex {
namespace {

// The shortest line of a vertex: three coordinates and a reference.
constexpr std::size_t kMinimumVertexBytes = 8;

// Coordinates and a reference.
constexpr std::size_t kTokensOfVertex = 4;

void failIfAtEnd(TextScanner& scanner, std::size_t done, std::size_t count, std::string_view what) {
  if (scanner.skipSpace()) return;
  scanner.fail(ErrorCode::FileSyntax, "the file ends after " + std::to_string(done) + " of " +
                                          std::to_string(count) + " " + std::string(what) +
                                          ": it is incomplete.");
}

std::int32_t readReference(TextScanner& scanner, const char* what) {
  std::int64_t reference = 0;
  if (!scanner.readInteger(reference)) scanner.failInteger(what);
  if (std::in_range<std::int32_t>(reference)) return static_cast<std::int32_t>(reference);
  scanner.fail(ErrorCode::FileUnsupported, std::string(what) + " is " + std::to_string(reference) +
                                               ", which does not fit into 32 bits.");
}

/// Reads one file from top to bottom.
template <std::size_t corners>
class MeditReader {
 public:
  MeditReader(std::string_view text, const std::string& fileName, Stage& stage)
      : scanner_(text, fileName, TextScanner::Comments::Hash), stage_(stage) {
    if (text.find('#') == std::string_view::npos) index_.emplace(text, stage);
  }

  CellMesh<corners> read();

 private:
  static constexpr CellKind kKind = kCellKind<corners>;
  static constexpr std::size_t kTokensOfCell = corners + 1;  // and a reference

  void readHeader();
  void readDimension();
  void readVertices();
  void readCells();
  void readVertex(TextScanner& scanner, std::size_t index);
  void readCell(TextScanner& scanner, std::size_t index);
  template <class Feature>
  void readFeatures(std::vector<Feature>& features, const char* what);
  [[nodiscard]] Index readCorner(TextScanner& scanner, std::string_view what, std::size_t index,
                                 Place place) const;
  void skipSection();
  [[nodiscard]] const TokenIndex* index() const { return index_ ? &*index_ : nullptr; }

  TextScanner scanner_;
  std::optional<TokenIndex> index_;  ///< only for a text without comments
  Stage& stage_;
  CellMesh<corners> mesh_;
  Array<std::int32_t> references_;  ///< of vertices, while they are read
  bool hasVertices_ = false;
  bool hasCells_ = false;
};

template <std::size_t corners>
CellMesh<corners> MeditReader<corners>::read() {
  readHeader();
  while (scanner_.skipSpace()) {
    const std::string_view keyword = scanner_.readToken();
    if (keyword == "End") break;
    if (keyword == "Dimension") {
      readDimension();
    } else if (keyword == "Vertices") {
      readVertices();
    } else if (keyword == kKind.meditKeyword) {
      readCells();
    } else if (corners == 8 && hasVertices_ && keyword == "Edges") {
      readFeatures(mesh_.features.edges, "edge");
      keepTagged(mesh_.features.edges);
    } else if (corners == 8 && hasVertices_ && keyword == "Quadrilaterals") {
      readFeatures(mesh_.features.quads, "quadrilateral");
      keepGroups(mesh_.features.quads);
    } else {
      skipSection();
    }
  }
  if (hasCells_) return std::move(mesh_);
  throw Error(ErrorCode::FileUnsupported, scanner_.fileName() + ": the file holds no " +
                                              std::string(kKind.plural) + ": it has no section " +
                                              std::string(kKind.meditKeyword) + ".");
}

template <std::size_t corners>
void MeditReader<corners>::readHeader() {
  if (scanner_.readToken() != "MeshVersionFormatted") {
    scanner_.fail(ErrorCode::FileSyntax,
                  "a MEDIT file begins with \"MeshVersionFormatted\", found " +
                      quoted(scanner_.currentToken()) + ".");
  }
  std::int64_t version = 0;
  if (!scanner_.readInteger(version)) scanner_.failInteger("the version of the format");
}

template <std::size_t corners>
void MeditReader<corners>::readDimension() {
  std::int64_t dimension = 0;
  if (!scanner_.readInteger(dimension)) scanner_.failInteger("the dimension");
  if (dimension == 3) return;
  scanner_.fail(ErrorCode::FileUnsupported,
                "the dimension must be 3, found " + std::to_string(dimension) + ".");
}

template <std::size_t corners>
void MeditReader<corners>::readVertices() {
  scanner_.failIfRepeated(hasVertices_, "Vertices");
  hasVertices_ = true;
  mesh_.points.resize(scanner_.readCount("vertices", kMinimumVertexBytes));
  references_.resize(mesh_.points.size());
  readElements(scanner_, index(), stage_, mesh_.points.size(), kTokensOfVertex,
               [this](TextScanner& scanner, std::size_t i) { readVertex(scanner, i); });
  if (corners == 8) mesh_.features.vertices = taggedVertices(references_);
  references_ = {};
}

template <std::size_t corners>
void MeditReader<corners>::readVertex(TextScanner& scanner, std::size_t index) {
  failIfAtEnd(scanner, index, mesh_.points.size(), "vertices");
  for (double& coordinate : mesh_.points[index]) {
    if (!scanner.readNumber(coordinate)) {
      scanner.failNumber("a coordinate of vertex " + std::to_string(index + 1));
    }
  }
  references_[index] = readReference(scanner, "the reference of a vertex");
}

template <std::size_t corners>
void MeditReader<corners>::readCells() {
  scanner_.failIfRepeated(hasCells_, kKind.meditKeyword);
  hasCells_ = true;
  if (!hasVertices_) {
    scanner_.fail(ErrorCode::FileUnsupported,
                  "the section " + std::string(kKind.meditKeyword) +
                      " stands before the section Vertices; exchange them.");
  }
  mesh_.cells.resize(scanner_.readCount(kKind.plural, 2 * kTokensOfCell));
  mesh_.regions.resize(mesh_.cells.size());
  readElements(scanner_, index(), stage_, mesh_.cells.size(), kTokensOfCell,
               [this](TextScanner& scanner, std::size_t i) { readCell(scanner, i); });
  keepRegions(mesh_.regions);
}

/// Edges or quads, with their references as tags.
template <std::size_t corners>
template <class Feature>
void MeditReader<corners>::readFeatures(std::vector<Feature>& features, const char* what) {
  constexpr std::size_t kVertices = decltype(Feature::vertices){}.size();
  features.assign(scanner_.readCount(std::string(what) + "s", 2 * (kVertices + 1)), {});
  readElements(scanner_, index(), stage_, features.size(), kVertices + 1,
               [&](TextScanner& scanner, std::size_t i) {
                 failIfAtEnd(scanner, i, features.size(), what);
                 for (Index& vertex : features[i].vertices) {
                   vertex = readCorner(scanner, what, i, {});
                 }
                 features[i].tag = readReference(scanner, "a reference");
               });
}

/// One vertex of an element.
/// @param what, index  which element, counted from 0
template <std::size_t corners>
Index MeditReader<corners>::readCorner(TextScanner& scanner, std::string_view what,
                                       std::size_t index, Place place) const {
  const auto vertices = static_cast<std::int64_t>(mesh_.points.size());
  std::int64_t vertex = 0;
  if (!scanner.readInteger(vertex)) {
    scanner.failInteger("a vertex of " + std::string(what) + " " + std::to_string(index + 1));
  }
  if (vertex >= 1 && vertex <= vertices) return static_cast<Index>(vertex - 1);
  scanner.fail(ErrorCode::IndexOutOfRange,
               std::string(what) + " " + std::to_string(index + 1) + " names vertex " +
                   std::string(scanner.currentToken()) + ", but the " + std::to_string(vertices) +
                   " vertices are numbered from 1.",
               place);
}

template <std::size_t corners>
void MeditReader<corners>::readCell(TextScanner& scanner, std::size_t index) {
  failIfAtEnd(scanner, index, mesh_.cells.size(), kKind.plural);
  for (Index& corner : mesh_.cells[index]) {
    corner = readCorner(scanner, kKind.singular, index, Place{kKind.place, index});
  }
  mesh_.regions[index] = readReference(scanner, "the reference of a cell");
}

/// Skips everything up to the next keyword, which is the next token that begins with a letter.
template <std::size_t corners>
void MeditReader<corners>::skipSection() {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  while (scanner_.skipSpace() && !isLetter(scanner_.peekToken().front())) scanner_.readToken();
}

}  // namespace

HexMesh parseMedit(std::string_view text, const std::string& fileName, Context& context) {
  return toHexMesh(parseWith<MeditReader<8>>(text, fileName, "read mesh", context));
}

HexMesh readMedit(const std::filesystem::path& file, Context& context) {
  return toHexMesh(readWith<MeditReader<8>>(file, "read mesh", context));
}

TetCells parseMeditTets(std::string_view text, const std::string& fileName, Context& context) {
  return parseWith<MeditReader<4>>(text, fileName, "read tets", context);
}

TetCells readMeditTets(const std::filesystem::path& file, Context& context) {
  return readWith<MeditReader<4>>(file, "read tets", context);
}

}  // namespace hexhex
