// The geometry and topology of an `.ovm` file.
#include <algorithm>

#include <hexhex/error.hpp>

#include <io/core/text_scanner.hpp>
#include <io/ovm/ovm_text.hpp>
#include <io/ovm/ovm_text_properties.hpp>
#include <io/ovm/ovmb_chunks.hpp>

namespace hexhex {
namespace {

// The shortest lines, e.g. "0 0 0", "0 1", "3 0 2 4", "4 0 2 4 6", with their ends.
constexpr std::size_t kMinimumVertexBytes = 6;
constexpr std::size_t kMinimumEdgeBytes = 4;
constexpr std::size_t kMinimumFaceBytes = 8;
constexpr std::size_t kMinimumCellBytes = 10;

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
      : scanner_(text, fileName, TextScanner::Comments::Hash),
        stage_(stage),
        index_(text, stage),
        hasComments_(text.find('#') != std::string_view::npos) {}

  OvmMesh read();

 private:
  void readHeader();
  std::size_t readSection(std::string_view keyword, std::string_view what, std::size_t bytesEach);
  void readVertices();
  void readEdges();
  void readLists(OvmLists& lists, std::size_t count, const ListNames& names, std::size_t limit);
  bool readUniformLists(OvmLists& lists, std::size_t count, const ListNames& names,
                        std::size_t limit);
  void readVaryingLists(OvmLists& lists, std::size_t count, const ListNames& names,
                        std::size_t limit);
  /// For reading in parallel, which comments prevent.
  [[nodiscard]] const TokenIndex* index() const { return hasComments_ ? nullptr : &index_; }

  TextScanner scanner_;
  Stage& stage_;
  TokenIndex index_;
  bool hasComments_;
  OvmMesh mesh_;
};

void failIfAtEnd(TextScanner& scanner, std::size_t done, std::size_t count, const char* what) {
  if (scanner.skipSpace()) return;
  scanner.fail(ErrorCode::FileSyntax, "the file ends after " + std::to_string(done) + " of " +
                                          std::to_string(count) + " " + what +
                                          ": it is incomplete.");
}

/// @param owner, number  e.g. "face", 12, for messages
Index readHandle(TextScanner& scanner, const char* owner, std::size_t number, const char* what,
                 std::size_t limit) {
  std::int64_t handle = 0;
  if (!scanner.readInteger(handle)) {
    scanner.failInteger("a " + std::string(what) + " of " + owner + " " + std::to_string(number));
  }
  if (handle < 0 || static_cast<std::uint64_t>(handle) >= limit) {
    scanner.fail(ErrorCode::IndexOutOfRange,
                 std::string(owner) + " " + std::to_string(number) + " names " + what + " " +
                     quoted(scanner.currentToken()) + ", but there are " + std::to_string(limit) +
                     ", numbered from 0.");
  }
  return static_cast<Index>(handle);
}

std::uint32_t readValence(TextScanner& scanner, std::size_t number, const ListNames& names) {
  std::int64_t valence = 0;
  if (!scanner.readInteger(valence)) {
    scanner.failInteger("the valence of " + std::string(names.one) + " " + std::to_string(number));
  }
  if (valence < names.leastLength || valence > kNone) {
    scanner.fail(ErrorCode::FileSyntax, std::string(names.one) + " " + std::to_string(number) +
                                            " has the valence " + std::to_string(valence) +
                                            "; at least " + std::to_string(names.leastLength) +
                                            " is needed.");
  }
  return static_cast<std::uint32_t>(valence);
}

OvmMesh OvmTextReader::read() {
  readHeader();
  readVertices();
  readEdges();
  OvmTopology& topology = mesh_.topology;
  const std::size_t faces = readSection("Faces", "faces", kMinimumFaceBytes);
  readLists(topology.faces, faces, kFaces, 2 * topology.edges.size());
  const std::size_t cells = readSection("Polyhedra", "cells", kMinimumCellBytes);
  readLists(topology.cells, cells, kCells, 2 * faces);
  readOvmTextProperties(scanner_, index_, mesh_, stage_);
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

void OvmTextReader::readVertices() {
  const std::size_t count = readSection("Vertices", "vertices", kMinimumVertexBytes);
  mesh_.points.resize(count);
  mesh_.topology.vertexCount = count;
  readElements(scanner_, index(), stage_, count, 3, [&](TextScanner& scanner, std::size_t i) {
    failIfAtEnd(scanner, i, count, "vertices");
    for (double& coordinate : mesh_.points[i]) {
      if (!scanner.readNumber(coordinate)) {
        scanner.failNumber("a coordinate of vertex " + std::to_string(i));
      }
    }
  });
}

void OvmTextReader::readEdges() {
  const std::size_t count = readSection("Edges", "edges", kMinimumEdgeBytes);
  mesh_.topology.edges.resize(count);
  readElements(scanner_, index(), stage_, count, 2, [&](TextScanner& scanner, std::size_t i) {
    failIfAtEnd(scanner, i, count, "edges");
    for (Index& vertex : mesh_.topology.edges[i]) {
      vertex = readHandle(scanner, "edge", i, "vertex", mesh_.points.size());
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

/// Reads lists that are all as long as the first; false, and nothing read, if they are not, or
/// wrong.
bool OvmTextReader::readUniformLists(OvmLists& lists, std::size_t count, const ListNames& names,
                                     std::size_t limit) {
  if (hasComments_ || count == 0 || !scanner_.skipSpace()) return false;
  const std::size_t begin = scanner_.position();
  const std::uint32_t length = readValence(scanner_, 0, names);
  scanner_.moveTo(begin);
  // Also keeps memory in proportion to the file.
  const std::size_t tokens = index_.count() - index_.countBefore(begin);
  if (tokens / (length + std::size_t{1}) < count) return false;
  lists.length = length;
  lists.handles.resize(count * length);
  try {
    readElements(scanner_, &index_, stage_, count, length + std::size_t{1},
                 [&](TextScanner& scanner, std::size_t i) {
                   if (readValence(scanner, i, names) != length) {
                     scanner.fail(ErrorCode::FileUnsupported, "valences vary.");
                   }
                   for (std::size_t k = 0; k < length; ++k) {
                     lists.handles[i * length + k] =
                         readHandle(scanner, names.one, i, names.parts, limit);
                   }
                 });
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    scanner_.moveTo(begin);
    lists = {};
    return false;
  }
  return true;
}

void OvmTextReader::readVaryingLists(OvmLists& lists, std::size_t count, const ListNames& names,
                                     std::size_t limit) {
  Array<std::uint32_t> lengths(count);
  readElements(scanner_, nullptr, stage_, count, 1, [&](TextScanner& scanner, std::size_t i) {
    failIfAtEnd(scanner, i, count, names.many);
    lengths[i] = readValence(scanner, i, names);
    for (std::uint32_t k = 0; k < lengths[i]; ++k) {
      lists.handles.push_back(readHandle(scanner, names.one, i, names.parts, limit));
    }
  });
  setLengths(lists, lengths);
}

void OvmTextReader::readLists(OvmLists& lists, std::size_t count, const ListNames& names,
                              std::size_t limit) {
  if (readUniformLists(lists, count, names, limit)) return;
  readVaryingLists(lists, count, names, limit);
}

}  // namespace

OvmMesh parseOvmText(std::string_view text, const std::string& fileName, Stage& stage) {
  return OvmTextReader(text, fileName, stage).read();
}

}  // namespace hexhex
