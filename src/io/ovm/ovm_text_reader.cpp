// Reads `.ovm` files (see ovm_mesh.hpp).
#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include <hexhex/error.hpp>

#include <io/core/number_parsing.hpp>
#include <io/core/text_scanner.hpp>
#include <io/ovm/ovm_mesh.hpp>
#include <io/ovm/ovmb_reader.hpp>

namespace hexhex {
namespace {

/// What a section holds.
struct SectionName {
  const char* keyword;
  const char* one;
  const char* many;
  const char* parts;         ///< what an element names
  std::size_t minimumBytes;  ///< of the shortest lines, e.g. "0 0 0", "0 1", "3 0 2 4", with ends
  std::uint32_t leastValence = 0;  ///< if it is said
};
constexpr SectionName kVertexSection = {"Vertices", "vertex", "vertices", "", 6};
constexpr SectionName kEdgeSection = {"Edges", "edge", "edges", "vertex", 4};
constexpr SectionName kFaceSection = {"Faces", "face", "faces", "half-edge", 8, 3};
constexpr SectionName kCellSection = {"Polyhedra", "cell", "cells", "half-face", 10, 4};

constexpr std::array<std::string_view, 6> kIntegerTypes = {"int",  "uint",  "short",
                                                           "long", "ulong", "bool"};
constexpr std::array<std::string_view, 2> kPointTypes = {"vec3d", "vec3f"};

bool equalsIgnoringCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lowerCase(x) == lowerCase(y); });
}

template <std::size_t n>
bool isOneOf(std::string_view word, const std::array<std::string_view, n>& words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view known) { return equalsIgnoringCase(word, known); });
}

/// The line that begins a property.
struct PropertyHeader {
  OvmEntity entity = OvmEntity::Mesh;
  std::string_view type;
  std::string_view name;
};

/// Removes and returns the first word of a line.
std::string_view takeWord(std::string_view& line) {
  line.remove_prefix(
      static_cast<std::size_t>(std::find_if_not(line.begin(), line.end(), isSpace) - line.begin()));
  const auto length =
      static_cast<std::size_t>(std::find_if(line.begin(), line.end(), isSpace) - line.begin());
  const std::string_view word = line.substr(0, length);
  line.remove_prefix(length);
  return word;
}

std::optional<PropertyHeader> parseHeader(std::string_view line) {
  const std::string_view keyword = takeWord(line);
  const auto* const word =
      std::find_if(kOvmPropertyWords.begin(), kOvmPropertyWords.end(),
                   [&](std::string_view known) { return equalsIgnoringCase(known, keyword); });
  if (word == kOvmPropertyWords.end()) return std::nullopt;
  PropertyHeader header{
      static_cast<OvmEntity>(word - kOvmPropertyWords.begin()), takeWord(line), {}};
  const std::size_t quote = line.find('"');
  if (quote == std::string_view::npos) return header;
  header.name = line.substr(quote + 1);
  while (!header.name.empty() && (isSpace(header.name.back()) || header.name.back() == '"')) {
    header.name.remove_suffix(1);
  }
  return header;
}

class OvmTextReader {
 public:
  OvmTextReader(std::string_view text, const std::string& fileName, Stage& stage)
      : text_(text),
        scanner_(text, fileName, TextScanner::Comments::Hash),
        stage_(stage),
        index_(text, stage),
        hasComments_(text.find('#') != std::string_view::npos) {}

  OvmMesh read();

 private:
  void readHeader();
  std::size_t readSection(const SectionName& section);
  void readVertices();
  void readEdges();
  void readLists(OvmLists& lists, const SectionName& section, std::size_t limit);
  bool readUniformLists(OvmLists& lists, std::size_t count, const SectionName& section,
                        std::size_t limit);
  /// For reading in parallel, which comments prevent.
  [[nodiscard]] const TokenIndex* index() const { return hasComments_ ? nullptr : &index_; }

  void readProperties();
  [[nodiscard]] bool readWanted(const PropertyHeader& header);
  void readParametrization();
  void readIntegers(Array<std::int32_t>& values, std::size_t count, std::string_view name);
  void skipStrings(std::size_t count);

  std::string_view text_;
  TextScanner scanner_;
  Stage& stage_;
  TokenIndex index_;
  bool hasComments_;
  OvmMesh mesh_;
};

Index readHandle(TextScanner& scanner, const SectionName& section, std::size_t number,
                 std::size_t limit) {
  std::int64_t handle = 0;
  if (!scanner.readInteger(handle)) {
    scanner.failInteger("a " + std::string(section.parts) + " of " + section.one + " " +
                        std::to_string(number));
  }
  if (handle < 0 || static_cast<std::uint64_t>(handle) >= limit) {
    scanner.fail(ErrorCode::IndexOutOfRange,
                 std::string(section.one) + " " + std::to_string(number) + " names " +
                     section.parts + " " + quoted(scanner.currentToken()) + ", but there are " +
                     std::to_string(limit) + ", numbered from 0.");
  }
  return static_cast<Index>(handle);
}

std::uint32_t readValence(TextScanner& scanner, const SectionName& section, std::size_t number) {
  std::int64_t valence = 0;
  if (!scanner.readInteger(valence)) {
    scanner.failInteger("the valence of " + std::string(section.one) + " " +
                        std::to_string(number));
  }
  if (valence < section.leastValence || valence > kNone) {
    scanner.fail(ErrorCode::FileSyntax, std::string(section.one) + " " + std::to_string(number) +
                                            " has the valence " + std::to_string(valence) +
                                            "; at least " + std::to_string(section.leastValence) +
                                            " is needed.");
  }
  return static_cast<std::uint32_t>(valence);
}

OvmMesh OvmTextReader::read() {
  readHeader();
  readVertices();
  readEdges();
  readLists(mesh_.topology.faces, kFaceSection, 2 * mesh_.topology.edges.size());
  readLists(mesh_.topology.cells, kCellSection, 2 * mesh_.topology.faces.size());
  readProperties();
  return std::move(mesh_);
}

/// "OVM ASCII", which may be missing.
void OvmTextReader::readHeader() {
  if (isOvmb(text_)) {
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

/// @return the number of its elements
std::size_t OvmTextReader::readSection(const SectionName& section) {
  if (!equalsIgnoringCase(scanner_.readToken(), section.keyword)) {
    const std::string_view found = scanner_.currentToken();
    scanner_.fail(ErrorCode::FileSyntax,
                  "expected the section " + std::string(section.keyword) + ", found " +
                      (found.empty() ? "the end of the file: it is incomplete" : quoted(found)) +
                      ".");
  }
  const std::size_t count = scanner_.readCount(section.many, section.minimumBytes);
  if (count > kMaxOvmEntities) {
    scanner_.fail(ErrorCode::TooLarge, exceedsLimit(count, section.many, kMaxOvmEntities));
  }
  return count;
}

void OvmTextReader::readVertices() {
  const std::size_t count = readSection(kVertexSection);
  mesh_.points.resize(count);
  mesh_.topology.vertexCount = count;
  readElements(scanner_, index(), stage_, count, 3, [&](TextScanner& scanner, std::size_t i) {
    scanner.failIfAtEnd(i, count, kVertexSection.many);
    for (double& coordinate : mesh_.points[i]) {
      if (!scanner.readNumber(coordinate)) {
        scanner.failNumber("a coordinate of vertex " + std::to_string(i));
      }
    }
  });
}

void OvmTextReader::readEdges() {
  const std::size_t count = readSection(kEdgeSection);
  mesh_.topology.edges.resize(count);
  readElements(scanner_, index(), stage_, count, 2, [&](TextScanner& scanner, std::size_t i) {
    scanner.failIfAtEnd(i, count, kEdgeSection.many);
    for (Index& vertex : mesh_.topology.edges[i]) {
      vertex = readHandle(scanner, kEdgeSection, i, mesh_.points.size());
    }
  });
}

/// Reads lists that are all as long as the first; false, and nothing read, if they are not, or
/// wrong.
bool OvmTextReader::readUniformLists(OvmLists& lists, std::size_t count, const SectionName& section,
                                     std::size_t limit) {
  if (hasComments_ || count == 0 || !scanner_.skipSpace()) return false;
  const std::size_t begin = scanner_.position();
  const std::uint32_t length = readValence(scanner_, section, 0);
  scanner_.moveTo(begin);
  const std::size_t tokensEach = length + std::size_t{1};
  // Also keeps memory in proportion to the file.
  if ((index_.count() - index_.countBefore(begin)) / tokensEach < count) return false;
  lists.length = length;
  lists.handles.resize(count * length);
  try {
    readElements(scanner_, &index_, stage_, count, tokensEach,
                 [&](TextScanner& scanner, std::size_t i) {
                   if (readValence(scanner, section, i) != length) {
                     scanner.fail(ErrorCode::FileUnsupported, "valences vary.");
                   }
                   for (std::size_t k = i * length; k < (i + 1) * length; ++k) {
                     lists.handles[k] = readHandle(scanner, section, i, limit);
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

void OvmTextReader::readLists(OvmLists& lists, const SectionName& section, std::size_t limit) {
  const std::size_t count = readSection(section);
  if (readUniformLists(lists, count, section, limit)) return;
  lists.offsets.push_back(0);
  readElements(scanner_, nullptr, stage_, count, 1, [&](TextScanner& scanner, std::size_t i) {
    scanner.failIfAtEnd(i, count, section.many);
    const std::uint32_t length = readValence(scanner, section, i);
    for (std::uint32_t k = 0; k < length; ++k) {
      lists.handles.push_back(readHandle(scanner, section, i, limit));
    }
    lists.offsets.push_back(lists.handles.size());
  });
  // One length for all, if possible: with comments, they were not read as such.
  const std::uint64_t length = count > 0 ? lists.offsets[1] : 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (lists.offsets[i + 1] - lists.offsets[i] != length) return;
  }
  lists.offsets = {};
  lists.length = static_cast<std::size_t>(length);
}

/// Reads the properties that this library knows and skips all others.
void OvmTextReader::readProperties() {
  const std::size_t begin = scanner_.position();
  scanner_ = TextScanner(text_, scanner_.fileName());  // here, '#' may be part of a text
  scanner_.moveTo(begin);
  // Behind values that were skipped without knowing them, everything up to the next header belongs
  // to them. Behind others, nothing does.
  bool anythingGoes = false;
  while (scanner_.skipSpace()) {
    const std::string_view first = scanner_.currentToken();
    const bool comment = !anythingGoes && first.front() == '#';
    const std::string_view rest = text_.substr(scanner_.position());
    const std::optional<PropertyHeader> header = parseHeader(rest.substr(0, rest.find('\n')));
    if (!header && !comment && !anythingGoes) {
      scanner_.fail(
          ErrorCode::FileSyntax,
          "expected a property (e.g. VProp) or the end of the file, found " + quoted(first) + ".");
    }
    scanner_.takeLine();
    if (!header) continue;
    anythingGoes = !readWanted(*header);
    if (anythingGoes && equalsIgnoringCase(header->type, "string")) {
      // Strings may contain whatever looks like the next header, but their lengths are known.
      skipStrings(mesh_.topology.count(header->entity));
      anythingGoes = false;
    }
  }
}

/// Reads the values if the property is known; else returns false.
bool OvmTextReader::readWanted(const PropertyHeader& header) {
  if (header.name == kParametrizationName) {
    const bool isMap = header.entity == OvmEntity::HalfFace && isOneOf(header.type, kPointTypes);
    if (isMap && mesh_.properties.parametrization.empty()) {
      readParametrization();
      return true;
    }
    mesh_.hasForeignParametrization = true;
  }
  Array<std::int32_t>* const values = mesh_.properties.find(header.entity, header.name);
  if (values == nullptr || !values->empty() || !isOneOf(header.type, kIntegerTypes)) return false;
  readIntegers(*values, mesh_.topology.count(header.entity), header.name);
  return true;
}

/// Parameters of half-faces without a cell mean nothing, so not even finite numbers are demanded
/// here.
void OvmTextReader::readParametrization() {
  Array<Vec3>& values = mesh_.properties.parametrization;
  // Every number takes two bytes, so that no count can ask for more memory than the file justifies.
  const std::size_t count = mesh_.topology.count(OvmEntity::HalfFace);
  if (count > text_.size() - scanner_.position()) {
    scanner_.fail(ErrorCode::FileSyntax,
                  "the values of the map are incomplete: the file ends before them.");
  }
  values.resize(count);
  readElements(scanner_, &index_, stage_, count, 3, [&values](TextScanner& scanner, std::size_t i) {
    for (double& parameter : values[i]) {
      if (scanner.readNumber(parameter)) continue;
      const NumberProblem problem = parseNumber(scanner.currentToken(), parameter);
      if (problem != NumberProblem::NotFinite && problem != NumberProblem::Overflow) {
        scanner.failNumber("a parameter of half-face " + std::to_string(i));
      }
      parameter = std::numeric_limits<double>::quiet_NaN();
      scanner.readToken();
    }
  });
}

void OvmTextReader::readIntegers(Array<std::int32_t>& values, std::size_t count,
                                 std::string_view name) {
  for (std::size_t i = 0; i < count; ++i) {
    std::int64_t value = 0;
    if (!scanner_.readInteger(value)) {
      scanner_.failInteger("a value of the property " + quoted(name));
    }
    if (!std::in_range<std::int32_t>(value)) {
      scanner_.fail(ErrorCode::FileUnsupported,
                    "the property " + quoted(name) + " has the value " +
                        std::string(scanner_.currentToken()) +
                        ", which does not fit into 32 bits with a sign.");
    }
    values.push_back(static_cast<std::int32_t>(value));
  }
}

/// Skips strings of the form "3:a b".
void OvmTextReader::skipStrings(std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const bool atEnd = !scanner_.skipSpace();
    const std::string_view rest = text_.substr(scanner_.position());
    std::size_t length = 0;
    const auto result = std::from_chars(rest.data(), rest.data() + rest.size(), length);
    const auto digits = static_cast<std::size_t>(result.ptr - rest.data());
    if (atEnd || result.ec != std::errc{} || digits == rest.size() || rest[digits] != ':' ||
        length > rest.size() - digits - 1) {
      scanner_.fail(ErrorCode::FileSyntax,
                    "expected a text with its length in front, like \"3:abc\".");
    }
    scanner_.moveTo(scanner_.position() + digits + 1 + length);
  }
}

}  // namespace

OvmMesh parseOvmText(std::string_view text, const std::string& fileName, Stage& stage) {
  return OvmTextReader(text, fileName, stage).read();
}

}  // namespace hexhex
