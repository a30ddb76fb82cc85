#include <cstdint>
#include <optional>
#include <span>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/input_file.hpp>
#include <io/line_writer.hpp>
#include <io/medit.hpp>
#include <io/medit_text.hpp>
#include <io/mesh_groups.hpp>
#include <io/output_file.hpp>
#include <io/text_elements.hpp>
#include <io/text_scanner.hpp>
#include <io/token_index.hpp>

namespace hexhex {
namespace {

// The shortest lines: three coordinates and a reference, eight vertices and a reference.
constexpr std::size_t kMinimumVertexBytes = 8;
constexpr std::size_t kMinimumHexBytes = 18;

// Coordinates or corners, and a reference.
constexpr std::size_t kTokensOfVertex = 4;
constexpr std::size_t kTokensOfHexahedron = 9;

void failIfAtEnd(TextScanner& scanner, std::size_t done, std::size_t count, const char* what) {
  if (scanner.skipSpace()) return;
  scanner.fail(ErrorCode::FileSyntax, "the file ends after " + std::to_string(done) + " of " +
                                          std::to_string(count) + " " + what +
                                          ": it is incomplete.");
}

void readReference(TextScanner& scanner, const char* what) {
  std::int64_t reference = 0;
  if (!scanner.readInteger(reference)) scanner.failInteger(what);
}

/// Reads one file from top to bottom.
class MeditReader {
 public:
  MeditReader(std::string_view text, const std::string& fileName, Stage& stage)
      : scanner_(text, fileName, TextScanner::Comments::Hash), stage_(stage) {
    if (text.find('#') == std::string_view::npos) index_.emplace(text, stage);
  }

  HexMesh read();

 private:
  void readHeader();
  void readDimension();
  void readVertices();
  void readHexahedra();
  void readVertex(TextScanner& scanner, std::size_t index);
  void readHexahedron(TextScanner& scanner, std::size_t index);
  void skipSection();
  void failIfRepeated(bool present, const char* keyword);
  [[nodiscard]] const TokenIndex* index() const { return index_ ? &*index_ : nullptr; }

  TextScanner scanner_;
  std::optional<TokenIndex> index_;  ///< only for a text without comments
  Stage& stage_;
  HexMesh mesh_;
  bool hasVertices_ = false;
  bool hasHexahedra_ = false;
};

HexMesh MeditReader::read() {
  readHeader();
  while (scanner_.skipSpace()) {
    const std::string_view keyword = scanner_.readToken();
    if (keyword == "End") break;
    if (keyword == "Dimension") {
      readDimension();
    } else if (keyword == "Vertices") {
      readVertices();
    } else if (keyword == "Hexahedra") {
      readHexahedra();
    } else {
      skipSection();
    }
  }
  if (hasHexahedra_) return std::move(mesh_);
  throw Error(ErrorCode::FileUnsupported,
              scanner_.fileName() + ": the file holds no hexahedra: it has no section Hexahedra.");
}

void MeditReader::readHeader() {
  if (scanner_.readToken() != "MeshVersionFormatted") {
    scanner_.fail(ErrorCode::FileSyntax,
                  "a MEDIT file begins with \"MeshVersionFormatted\", found " +
                      quoted(scanner_.currentToken()) + ".");
  }
  std::int64_t version = 0;
  if (!scanner_.readInteger(version)) scanner_.failInteger("the version of the format");
}

void MeditReader::readDimension() {
  std::int64_t dimension = 0;
  if (!scanner_.readInteger(dimension)) scanner_.failInteger("the dimension");
  if (dimension == 3) return;
  scanner_.fail(ErrorCode::FileUnsupported,
                "the dimension must be 3, found " + std::to_string(dimension) + ".");
}

void MeditReader::failIfRepeated(bool present, const char* keyword) {
  if (!present) return;
  scanner_.fail(ErrorCode::FileSyntax,
                "the section " + std::string(keyword) + " occurs a second time.");
}

void MeditReader::readVertices() {
  failIfRepeated(hasVertices_, "Vertices");
  hasVertices_ = true;
  mesh_.points.resize(scanner_.readCount("vertices", kMinimumVertexBytes));
  readElements(scanner_, index(), stage_, mesh_.points.size(), kTokensOfVertex,
               [this](TextScanner& scanner, std::size_t i) { readVertex(scanner, i); });
}

void MeditReader::readVertex(TextScanner& scanner, std::size_t index) {
  failIfAtEnd(scanner, index, mesh_.points.size(), "vertices");
  for (double& coordinate : mesh_.points[index]) {
    if (!scanner.readNumber(coordinate)) {
      scanner.failNumber("a coordinate of vertex " + std::to_string(index + 1));
    }
  }
  readReference(scanner, "the reference of a vertex");
}

void MeditReader::readHexahedra() {
  failIfRepeated(hasHexahedra_, "Hexahedra");
  hasHexahedra_ = true;
  if (!hasVertices_) {
    scanner_.fail(ErrorCode::FileUnsupported,
                  "the section Hexahedra stands before the section Vertices; exchange them.");
  }
  mesh_.cells.resize(scanner_.readCount("hexahedra", kMinimumHexBytes));
  readElements(scanner_, index(), stage_, mesh_.cells.size(), kTokensOfHexahedron,
               [this](TextScanner& scanner, std::size_t i) { readHexahedron(scanner, i); });
}

void MeditReader::readHexahedron(TextScanner& scanner, std::size_t index) {
  failIfAtEnd(scanner, index, mesh_.cells.size(), "hexahedra");
  const auto vertices = static_cast<std::int64_t>(mesh_.points.size());
  for (Index& corner : mesh_.cells[index]) {
    std::int64_t vertex = 0;
    if (!scanner.readInteger(vertex)) {
      scanner.failInteger("a vertex of hexahedron " + std::to_string(index + 1));
    }
    if (vertex < 1 || vertex > vertices) {
      scanner.fail(ErrorCode::IndexOutOfRange,
                   "hexahedron " + std::to_string(index + 1) + " names vertex " +
                       std::string(scanner.currentToken()) + ", but the " +
                       std::to_string(vertices) + " vertices are numbered from 1.",
                   Place{PlaceKind::Cell, index});
    }
    corner = static_cast<Index>(vertex - 1);
  }
  readReference(scanner, "the reference of a hexahedron");
}

/// Skips everything up to the next keyword, which is the next token that begins with a letter.
void MeditReader::skipSection() {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  while (scanner_.skipSpace() && !isLetter(scanner_.peekToken().front())) scanner_.readToken();
}

}  // namespace

HexMesh parseMedit(std::string_view text, const std::string& fileName, Context& context) {
  Stage stage(context, "read mesh");
  HexMesh mesh;
  withThreads(context.threads(), [&] { mesh = MeditReader(text, fileName, stage).read(); });
  return mesh;
}

HexMesh readMedit(const std::filesystem::path& file, Context& context) {
  Stage stage(context, "read mesh");
  HexMesh mesh;
  withThreads(context.threads(), [&] {
    const Array<char> bytes = readWholeFile(file, stage);
    mesh = MeditReader(asText(bytes), file.string(), stage).read();
  });
  return mesh;
}

// Tagged edges stay out: viewers that read no more than what they show stumble over the section.
void writeMedit(const HexMesh& mesh, const std::filesystem::path& file, const WriteOptions& options,
                Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  const Array<std::uint32_t> vertices = vertexReferences(mesh, groupVertices(mesh));
  const Array<std::uint32_t> regions = cellReferences(mesh);
  QuadGroups quads;
  withThreads(context.threads(), [&] { quads = groupQuads(mesh, options.patchAngle, stage); });
  const Array<std::uint32_t> references = groupNumbers(quads.groups);
  LineWriter lines(output, context.threads());
  LoopProgress progress(stage, mesh.points.size() + quads.elements.size() + mesh.cells.size());
  output.write(kMeditHead).write(mesh.points.size()).write('\n');
  writeMeditVertices(lines, mesh.points, &progress, vertices);
  output.write("Quadrilaterals\n").write(quads.elements.size()).write('\n');
  writeMeditElements(lines, std::span<const Quad>(quads.elements), &progress, references);
  output.write("Hexahedra\n").write(mesh.cells.size()).write('\n');
  writeMeditElements(lines, std::span<const Hex>(mesh.cells), &progress, regions);
  output.write("End\n");
  output.commit();
}

}  // namespace hexhex
