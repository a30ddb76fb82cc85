#include <algorithm>
#include <cstdint>

#include <hexhex/error.hpp>

#include <base/stage.hpp>
#include <io/input_file.hpp>
#include <io/medit.hpp>
#include <io/output_file.hpp>
#include <io/text_scanner.hpp>
#include <mesh/hex_topology.hpp>

namespace hexhex {
namespace {

// The shortest lines: three coordinates and a reference, eight vertices and a reference.
constexpr std::size_t kMinimumVertexBytes = 8;
constexpr std::size_t kMinimumHexBytes = 18;

// Elements between two reports of progress: a fraction of a millisecond's work.
constexpr std::size_t kProgressGrain = 4096;

/// Reads one file from top to bottom.
class MeditReader {
 public:
  MeditReader(std::string_view text, const std::string& fileName, Stage& stage)
      : scanner_(text, fileName, TextScanner::Comments::Hash), stage_(stage) {}

  HexMesh read();

 private:
  void readHeader();
  void readDimension();
  void readVertices();
  void readHexahedra();
  void readHexahedron(std::size_t index);
  void readReference(const char* what);
  void skipSection();
  void failIfRepeated(bool present, const char* keyword);
  void failIfAtEnd(std::size_t done, std::size_t count, const char* what);

  TextScanner scanner_;
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

void MeditReader::failIfAtEnd(std::size_t done, std::size_t count, const char* what) {
  if (scanner_.skipSpace()) return;
  scanner_.fail(ErrorCode::FileSyntax, "the file ends after " + std::to_string(done) + " of " +
                                           std::to_string(count) + " " + what +
                                           ": it is incomplete.");
}

void MeditReader::readReference(const char* what) {
  std::int64_t reference = 0;
  if (!scanner_.readInteger(reference)) scanner_.failInteger(what);
}

void MeditReader::readVertices() {
  failIfRepeated(hasVertices_, "Vertices");
  hasVertices_ = true;
  const std::size_t count = scanner_.readCount("vertices", kMinimumVertexBytes);
  mesh_.points.resize(count);
  LoopProgress progress(stage_, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kProgressGrain == 0) progress.advance(std::min(kProgressGrain, count - i));
    failIfAtEnd(i, count, "vertices");
    for (double& coordinate : mesh_.points[i]) {
      if (!scanner_.readNumber(coordinate)) {
        scanner_.failNumber("a coordinate of vertex " + std::to_string(i + 1));
      }
    }
    readReference("the reference of a vertex");
  }
}

void MeditReader::readHexahedra() {
  failIfRepeated(hasHexahedra_, "Hexahedra");
  hasHexahedra_ = true;
  if (!hasVertices_) {
    scanner_.fail(ErrorCode::FileUnsupported,
                  "the section Hexahedra stands before the section Vertices; exchange them.");
  }
  const std::size_t count = scanner_.readCount("hexahedra", kMinimumHexBytes);
  mesh_.cells.resize(count);
  LoopProgress progress(stage_, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kProgressGrain == 0) progress.advance(std::min(kProgressGrain, count - i));
    failIfAtEnd(i, count, "hexahedra");
    readHexahedron(i);
  }
}

void MeditReader::readHexahedron(std::size_t index) {
  const auto vertices = static_cast<std::int64_t>(mesh_.points.size());
  for (Index& corner : mesh_.cells[index]) {
    std::int64_t vertex = 0;
    if (!scanner_.readInteger(vertex)) {
      scanner_.failInteger("a vertex of hexahedron " + std::to_string(index + 1));
    }
    if (vertex < 1 || vertex > vertices) {
      scanner_.fail(ErrorCode::IndexOutOfRange,
                    "hexahedron " + std::to_string(index + 1) + " names vertex " +
                        std::string(scanner_.currentToken()) + ", but the " +
                        std::to_string(vertices) + " vertices are numbered from 1.",
                    Place{PlaceKind::Cell, index});
    }
    corner = static_cast<Index>(vertex - 1);
  }
  readReference("the reference of a hexahedron");
}

/// Skips everything up to the next keyword, which is the next token that begins with a letter.
void MeditReader::skipSection() {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  while (scanner_.skipSpace() && !isLetter(scanner_.peekToken().front())) scanner_.readToken();
}

/// Writes one element: 1-based vertices, then the reference.
template <std::size_t corners>
void writeElement(OutputFile& output, const std::array<Index, corners>& vertices) {
  // 64 bits: 32 would wrap for the last vertex of the largest mesh.
  for (const Index vertex : vertices) output.write(std::uint64_t{vertex} + 1).write(' ');
  output.write("1\n");
}

}  // namespace

HexMesh parseMedit(std::string_view text, const std::string& fileName, Context& context) {
  Stage stage(context, "read mesh");
  return MeditReader(text, fileName, stage).read();
}

HexMesh readMedit(const std::filesystem::path& file, Context& context) {
  Stage stage(context, "read mesh");
  const Array<char> bytes = readWholeFile(file);
  return MeditReader(asText(bytes), file.string(), stage).read();
}

void writeMedit(const HexMesh& mesh, const std::filesystem::path& file, Context& context) {
  Stage stage(context, "write mesh");
  OutputFile output(file);  // first, so that a folder that is not writable shows at once
  const Array<Quad> quads = boundaryQuads(mesh, stage);
  LoopProgress progress(stage, mesh.points.size() + quads.size() + mesh.cells.size());
  const auto forEach = [&progress](const auto& elements, const auto& write) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (i % kProgressGrain == 0) progress.advance(std::min(kProgressGrain, elements.size() - i));
      write(elements[i]);
    }
  };

  output.write("MeshVersionFormatted 2\nDimension 3\n");
  output.write("Vertices\n").write(mesh.points.size()).write('\n');
  forEach(mesh.points, [&output](const Vec3& point) {
    for (const double coordinate : point) output.write(coordinate).write(' ');
    output.write("0\n");
  });
  output.write("Quadrilaterals\n").write(quads.size()).write('\n');
  forEach(quads, [&output](const Quad& quad) { writeElement(output, quad); });
  output.write("Hexahedra\n").write(mesh.cells.size()).write('\n');
  forEach(mesh.cells, [&output](const Hex& cell) { writeElement(output, cell); });
  output.write("End\n");
  output.commit();
}

}  // namespace hexhex
