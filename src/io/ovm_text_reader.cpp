// The geometry and topology of an `.ovm` file.
#include <algorithm>

#include <hexhex/error.hpp>

#include <io/ovm_text.hpp>
#include <io/ovm_text_properties.hpp>
#include <io/ovmb_chunks.hpp>
#include <io/text_scanner.hpp>

namespace hexhex {
namespace {

// The shortest lines, e.g. "0 0 0", "0 1", "3 0 2 4", "4 0 2 4 6", with their ends.
constexpr std::size_t kMinimumVertexBytes = 6;
constexpr std::size_t kMinimumEdgeBytes = 4;
constexpr std::size_t kMinimumFaceBytes = 8;
constexpr std::size_t kMinimumCellBytes = 10;

// Elements between two reports of progress: a fraction of a millisecond's work.
constexpr std::size_t kProgressGrain = 4096;

/// What lists are made of, for messages.
struct ListNames {
  const char* one;
  const char* many;
  const char* parts;
  std::uint32_t leastLength;
};
constexpr ListNames kFaces = {"face", "faces", "half-edge", 3};
constexpr ListNames kCells = {"cell", "cells", "half-face", 4};

class OvmTextReader {
 public:
  OvmTextReader(std::string_view text, const std::string& fileName, Stage& stage)
      : scanner_(text, fileName, TextScanner::Comments::Hash), stage_(stage) {}

  OvmMesh read();

 private:
  void readHeader();
  std::size_t readSection(std::string_view keyword, std::string_view what, std::size_t bytesEach);
  template <class Read>
  void readEach(std::size_t count, const char* what, const Read& read);
  void readVertices();
  void readEdges();
  void readLists(OvmLists& lists, std::size_t count, const ListNames& names, std::size_t limit);
  Index readHandle(const char* owner, std::size_t number, const char* what, std::size_t limit);

  TextScanner scanner_;
  Stage& stage_;
  OvmMesh mesh_;
};

OvmMesh OvmTextReader::read() {
  readHeader();
  readVertices();
  readEdges();
  OvmTopology& topology = mesh_.topology;
  const std::size_t faces = readSection("Faces", "faces", kMinimumFaceBytes);
  readLists(topology.faces, faces, kFaces, 2 * topology.edges.size());
  const std::size_t cells = readSection("Polyhedra", "cells", kMinimumCellBytes);
  readLists(topology.cells, cells, kCells, 2 * faces);
  readOvmTextProperties(scanner_.text(), scanner_.position(), scanner_.fileName(), mesh_, stage_);
  return std::move(mesh_);
}

/// "OVM ASCII", which may be missing.
void OvmTextReader::readHeader() {
  if (isOvmb(scanner_.text())) {
    throw Error(ErrorCode::FileUnsupported,
                scanner_.fileName() +
                    ": this is a binary file of OpenVolumeMesh. Give it the extension .ovmb.");
  }
  if (!equalsIgnoringCase(scanner_.peekToken(), "OVM")) return;
  scanner_.readToken();
  const std::string_view kind = scanner_.readToken();
  if (equalsIgnoringCase(kind, "ASCII")) return;
  const bool binary = equalsIgnoringCase(kind, "BINARY");
  scanner_.fail(binary ? ErrorCode::FileUnsupported : ErrorCode::FileSyntax,
                "expected \"OVM ASCII\", found \"OVM\" and " + quoted(kind) +
                    (binary ? ". Save the file as text, or as .ovmb." : "."));
}

std::size_t OvmTextReader::readSection(std::string_view keyword, std::string_view what,
                                       std::size_t bytesEach) {
  if (!equalsIgnoringCase(scanner_.readToken(), keyword)) {
    const std::string_view found = scanner_.currentToken();
    scanner_.fail(ErrorCode::FileSyntax,
                  "expected the section " + std::string(keyword) + ", found " +
                      (found.empty() ? "the end of the file: it is incomplete" : quoted(found)) +
                      ".");
  }
  const std::size_t count = scanner_.readCount(what, bytesEach);
  if (count > kMaxOvmEntities) {
    scanner_.fail(ErrorCode::TooLarge, "announces " + std::to_string(count) + " " +
                                           std::string(what) + "; at most " +
                                           std::to_string(kMaxOvmEntities) + " are supported.");
  }
  return count;
}

/// Calls read(i) for each of `count` elements.
template <class Read>
void OvmTextReader::readEach(std::size_t count, const char* what, const Read& read) {
  LoopProgress progress(stage_, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kProgressGrain == 0) progress.advance(std::min(kProgressGrain, count - i));
    if (!scanner_.skipSpace()) {
      scanner_.fail(ErrorCode::FileSyntax, "the file ends after " + std::to_string(i) + " of " +
                                               std::to_string(count) + " " + what +
                                               ": it is incomplete.");
    }
    read(i);
  }
}

void OvmTextReader::readVertices() {
  const std::size_t count = readSection("Vertices", "vertices", kMinimumVertexBytes);
  mesh_.points.resize(count);
  mesh_.topology.vertexCount = count;
  readEach(count, "vertices", [this](std::size_t i) {
    for (double& coordinate : mesh_.points[i]) {
      if (!scanner_.readNumber(coordinate)) {
        scanner_.failNumber("a coordinate of vertex " + std::to_string(i));
      }
    }
  });
}

/// @param owner, number  e.g. "face", 12, for messages
Index OvmTextReader::readHandle(const char* owner, std::size_t number, const char* what,
                                std::size_t limit) {
  std::int64_t handle = 0;
  if (!scanner_.readInteger(handle)) {
    scanner_.failInteger("a " + std::string(what) + " of " + owner + " " + std::to_string(number));
  }
  if (handle < 0 || static_cast<std::uint64_t>(handle) >= limit) {
    scanner_.fail(ErrorCode::IndexOutOfRange,
                  std::string(owner) + " " + std::to_string(number) + " names " + what + " " +
                      quoted(scanner_.currentToken()) +
                      ", but there are " + std::to_string(limit) + ", numbered from 0.");
  }
  return static_cast<Index>(handle);
}

void OvmTextReader::readEdges() {
  const std::size_t count = readSection("Edges", "edges", kMinimumEdgeBytes);
  mesh_.topology.edges.resize(count);
  readEach(count, "edges", [this](std::size_t i) {
    for (Index& vertex : mesh_.topology.edges[i]) {
      vertex = readHandle("edge", i, "vertex", mesh_.points.size());
    }
  });
}

/// Gives lists their lengths: one for all, if possible.
void setLengths(OvmLists& lists, const Array<std::uint32_t>& lengths) {
  if (lengths.empty()) return;
  if (std::all_of(lengths.begin(), lengths.end(),
                  [&](std::uint32_t length) { return length == lengths[0]; })) {
    lists.length = lengths[0];
    return;
  }
  lists.offsets.resize(lengths.size() + 1);
  lists.offsets[0] = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    lists.offsets[i + 1] = lists.offsets[i] + lengths[i];
  }
}

void OvmTextReader::readLists(OvmLists& lists, std::size_t count, const ListNames& names,
                              std::size_t limit) {
  Array<std::uint32_t> lengths(count);
  readEach(count, names.many, [&](std::size_t i) {
    std::int64_t length = 0;
    if (!scanner_.readInteger(length)) {
      scanner_.failInteger("the valence of " + std::string(names.one) + " " + std::to_string(i));
    }
    if (length < names.leastLength || length > kNone) {
      scanner_.fail(ErrorCode::FileSyntax, std::string(names.one) + " " + std::to_string(i) +
                                               " has the valence " + std::to_string(length) +
                                               "; at least " + std::to_string(names.leastLength) +
                                               " is needed.");
    }
    lengths[i] = static_cast<std::uint32_t>(length);
    for (std::int64_t k = 0; k < length; ++k) {
      lists.handles.push_back(readHandle(names.one, i, names.parts, limit));
    }
  });
  setLengths(lists, lengths);
}

}  // namespace

OvmMesh parseOvmText(std::string_view text, const std::string& fileName, Stage& stage) {
  return OvmTextReader(text, fileName, stage).read();
}

}  // namespace hexhex
