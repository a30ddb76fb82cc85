// Reads and writes `.ovm` files (see ovm_mesh.hpp); entry points for both OpenVolumeMesh formats.
#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/number_source.hpp>
#include <io/core/output_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/ovm_mesh.hpp>

namespace hexhex::io {

namespace {

constexpr std::array<std::string_view, 6> kIntegerTypes = {"int",  "uint",  "short",
                                                           "long", "ulong", "bool"};
constexpr std::array<std::string_view, 2> kPointTypes = {"vec3d", "vec3f"};

bool equalsIgnoringCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lowerCase(x) == lowerCase(y); });
}

OvmNumbers ovmNumbersOf(std::string_view type) {
  const auto isType = [type](std::string_view known) { return equalsIgnoringCase(type, known); };
  if (std::any_of(kPointTypes.begin(), kPointTypes.end(), isType)) return OvmNumbers::Points;
  const bool integers = std::any_of(kIntegerTypes.begin(), kIntegerTypes.end(), isType);
  return integers ? OvmNumbers::Integers : OvmNumbers::Others;
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

Index readHandle(TextScanner& scanner, const OvmElements& elements, std::size_t number,
                 std::size_t limit) {
  std::int64_t handle = 0;
  if (!scanner.readInteger(handle)) {
    scanner.failInteger(concat("a ", elements.parts, " of ", elements.one, " ", number));
  }
  if (handle < 0 || static_cast<std::uint64_t>(handle) >= limit) {
    scanner.fail(ErrorCode::IndexOutOfRange, elements.one, " ", number, " names ", elements.parts,
                 " ", quoted(scanner.currentToken()), ", but there are ", limit,
                 ", numbered from 0.");
  }
  return static_cast<Index>(handle);
}

std::uint32_t readValence(TextScanner& scanner, const OvmElements& elements, std::size_t number) {
  const std::int64_t valence = scanner.integer({"the valence of ", elements.one, number});
  if (valence < elements.leastValence || valence > kNone) {
    scanner.fail(ErrorCode::FileSyntax, elements.one, " ", number, " has the valence ", valence,
                 "; at least ", elements.leastValence, " is needed.");
  }
  return static_cast<std::uint32_t>(valence);
}

class OvmTextReader {
 public:
  OvmTextReader(std::string_view text, const std::string& fileName, const CellKind& kind,
                Stage& stage)
      : text_(text), scanner_(text, fileName, stage, TextScanner::Comments::Hash), mesh_(kind) {
    scanner_.makeIndex();
  }

  OvmMesh read() {
    OvmTopology& topology = mesh_.topology;
    readHeader();
    readArrays(mesh_.points, kOvmElements[0], [](TextScanner& scanner, std::size_t i) {
      return scanner.number({"a coordinate of ", "vertex", i});
    });
    topology.vertexCount = mesh_.points.size();
    const OvmElements& edges = kOvmElements[1];
    readArrays(topology.edges, edges, [&](TextScanner& scanner, std::size_t i) {
      return readHandle(scanner, edges, i, topology.vertexCount);
    });
    readLists(topology.faces, kOvmElements[2], topology.count(OvmEntity::HalfEdge));
    readLists(topology.cells, kOvmElements[3], topology.count(OvmEntity::HalfFace));
    readProperties();
    return std::move(mesh_);
  }

 private:
  /// Reads "OVM ASCII", which is optional.
  void readHeader() {
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
                  "expected \"OVM ASCII\", found \"OVM\" and ", quoted(kind),
                  (binary ? ". Save the file as text, or as .ovmb." : "."));
  }

  /// @return the number of elements
  std::size_t readSection(const OvmElements& elements) {
    if (!equalsIgnoringCase(scanner_.readToken(), elements.section)) {
      const std::string_view found = scanner_.currentToken();
      scanner_.fail(ErrorCode::FileSyntax, "expected the section ", elements.section, ", found ",
                    (found.empty() ? "the end of the file: it is incomplete" : quoted(found)), ".");
    }
    const std::size_t count = scanner_.readCount(elements.many, elements.fewestBytes);
    if (count > kMaxOvmEntities) {
      scanner_.fail(ErrorCode::TooLarge, exceedsLimit(count, elements.many, kMaxOvmEntities));
    }
    return count;
  }

  /// Reads a section of elements that have n values each.
  /// @param readValue  called with (scanner, index of the element)
  template <class Value, std::size_t n, class Read>
  void readArrays(Array<std::array<Value, n>>& arrays, const OvmElements& elements,
                  const Read& readValue) {
    const std::size_t count = readSection(elements);
    arrays.resize(count);
    scanner_.elements(count, n, [&](TextScanner& scanner, std::size_t i) {
      scanner.failIfAtEnd(i, count, elements.many);
      for (Value& value : arrays[i]) value = readValue(scanner, i);
    });
  }

  /// Reads lists in parallel if they have the wanted length and there are no comments.
  void readLists(OvmLists& lists, const OvmElements& elements, std::size_t limit) {
    const std::size_t count = readSection(elements);
    const std::size_t begin = scanner_.position();
    lists.handles.resize(count * lists.length);
    const auto readList = [&](TextScanner& scanner, std::size_t i, bool inParallel) {
      scanner.failIfAtEnd(i, count, elements.many);
      const std::uint32_t valence = readValence(scanner, elements, i);
      const auto list = std::span(lists.handles).subspan(i * lists.length, lists.length);
      if (valence == lists.length) {
        for (Index& handle : list) handle = readHandle(scanner, elements, i, limit);
        return;
      }
      if (inParallel) scanner.fail(ErrorCode::FileUnsupported, "lengths differ.");
      for (std::uint32_t k = 0; k < valence; ++k) {
        static_cast<void>(readHandle(scanner, elements, i, limit));
      }
      std::fill(list.begin(), list.end(), kNone);
      mesh_.noteOther(lists, i, valence);
    };
    if (scanner_.hasIndex()) {
      try {
        return scanner_.elements(count, 1 + lists.length, [&](TextScanner& scanner, std::size_t i) {
          readList(scanner, i, true);
        });
      } catch (const Error& error) {
        if (error.code() == ErrorCode::Cancelled) throw;
        scanner_.moveTo(begin);
      }
    }
    scanner_.inSequence(count,
                        [&](TextScanner& scanner, std::size_t i) { readList(scanner, i, false); });
  }

  /// Reads the supported properties and skips all others.
  void readProperties() {
    scanner_.endComments();  // here, '#' may be part of a string
    if (!scanner_.hasIndex()) scanner_.makeIndex();
    // Values of unknown types extend to the next property line. After other values, only property
    // lines and comments may follow.
    bool anythingGoes = false;
    while (scanner_.skipSpace()) {
      const std::string_view first = scanner_.currentToken();
      const bool comment = !anythingGoes && first.front() == '#';
      const std::string_view rest = text_.substr(scanner_.position());
      const std::optional<PropertyHeader> header = parseHeader(rest.substr(0, rest.find('\n')));
      if (!header && !comment && !anythingGoes) {
        scanner_.fail(ErrorCode::FileSyntax,
                      "expected a property (e.g. VProp) or the end of the file, found ",
                      quoted(first), ".");
      }
      scanner_.takeLine();
      if (!header) continue;
      const OvmMesh::Destination values =
          mesh_.destinationOf(header->entity, header->name, ovmNumbersOf(header->type));
      if (values.points != nullptr) readParametrization(*values.points);
      if (values.integers != nullptr) readIntegers(*values.integers, *header);
      anythingGoes = values.points == nullptr && values.integers == nullptr;
      if (anythingGoes && equalsIgnoringCase(header->type, "string")) {
        // Strings may look like a property line, but their lengths are known.
        skipStrings(mesh_.topology.count(header->entity));
        anythingGoes = false;
      }
    }
  }

  /// Reads the map. Parameters of half-faces without a cell have no meaning, so even NaN is
  /// accepted here.
  void readParametrization(Array<Vec3>& values) {
    // Every number takes at least two bytes, so memory stays proportional to the file.
    const std::size_t count = mesh_.topology.count(OvmEntity::HalfFace);
    if (count > text_.size() - scanner_.position()) {
      scanner_.fail(ErrorCode::FileSyntax,
                    "the values of the map are incomplete: the file ends before them.");
    }
    values.resize(count);
    scanner_.elements(count, 3, [&values](TextScanner& scanner, std::size_t i) {
      for (double& parameter : values[i]) {
        if (scanner.readNumber(parameter)) continue;
        const NumberProblem problem = parseNumber(scanner.currentToken(), parameter);
        if (problem != NumberProblem::NotFinite && problem != NumberProblem::Overflow) {
          scanner.failNumber(concat("a parameter of half-face ", i));
        }
        parameter = std::numeric_limits<double>::quiet_NaN();
        scanner.readToken();
      }
    });
  }

  void readIntegers(Array<std::int32_t>& values, const PropertyHeader& header) {
    const std::size_t count = mesh_.topology.count(header.entity);
    const std::string name = quoted(header.name);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t value = scanner_.integer({"a value of the property ", name});
      if (!std::in_range<std::int32_t>(value)) {
        scanner_.fail(ErrorCode::FileUnsupported, "the property ", name, " has the value ",
                      scanner_.currentToken(), ", which does not fit into 32 bits with a sign.");
      }
      values.push_back(static_cast<std::int32_t>(value));
    }
  }

  /// Skips strings of the form "3:a b".
  void skipStrings(std::size_t count) {
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

  std::string_view text_;
  TextSource scanner_;
  OvmMesh mesh_;
};

}  // namespace

OvmMesh parseOvmText(std::string_view text, const std::string& fileName, const CellKind& kind,
                     Stage& stage) {
  return OvmTextReader(text, fileName, kind, stage).read();
}

namespace {

// Writes `.ovm` files.

/// A number and its separator.
constexpr std::size_t kRoomPerNumber = kNumberRoom + 1;

class OvmTextWriter {
 public:
  OvmTextWriter(const OvmOutput& mesh, OutputFile& output, Stage& stage)
      : mesh_(mesh),
        output_(output),
        lines_(output_, stage.context().threads()),
        progress_(stage, totalOf(mesh)) {}

  void write() {
    output_.write("OVM ASCII\n");
    writeSection("Vertices", mesh_.points);
    writeSection("Edges", std::span(mesh_.topology.edges));
    writeSection("Faces", mesh_.topology.faces);
    writeSection("Polyhedra", mesh_.topology.cells);
    for (const OvmProperty& property : mesh_.properties) writeProperty(property);
  }

 private:
  static std::size_t totalOf(const OvmOutput& mesh) {
    std::size_t total = mesh.points.size() + mesh.topology.edges.size() +
                        mesh.topology.faces.size() + mesh.topology.cells.size();
    for (const OvmProperty& property : mesh.properties) {
      total += mesh.topology.count(property.entity);
    }
    return total;
  }
  template <class Number, std::size_t n>
  void writeLines(std::span<const std::array<Number, n>> arrays) {
    lines_.write(
        arrays.size(), n * kRoomPerNumber,
        [arrays](char* place, std::size_t i) { return put(putNumbers(place, arrays[i]), '\n'); },
        &progress_);
  }
  void writeLines(std::span<const std::int32_t> numbers) {
    lines_.write(
        numbers.size(), kRoomPerNumber,
        [numbers](char* place, std::size_t i) { return put(put(place, numbers[i]), '\n'); },
        &progress_);
  }
  void writeLines(const OvmLists& lists) {
    lines_.write(
        lists.size(), (lists.length + 1) * kRoomPerNumber,
        [&lists](char* place, std::size_t i) {
          place = put(place, lists.length);
          for (const Index handle : lists[i]) place = put(put(place, ' '), handle);
          return put(place, '\n');
        },
        &progress_);
  }
  template <class Values>
  void writeSection(const char* keyword, const Values& values) {
    output_.write(keyword).write('\n').write(values.size()).write('\n');
    writeLines(values);
  }
  void writeProperty(const OvmProperty& property) {
    constexpr std::array<const char*, 3> kTypes = {"int", "vec3d", "vec2d"};  // as the variant
    output_.write(kOvmPropertyWords[static_cast<std::size_t>(property.entity)]).write(' ');
    output_.write(kTypes[property.values.index()]).write(" \"").write(property.name).write("\"\n");
    std::visit([this](const auto& values) { writeLines(std::span(values)); }, property.values);
  }

  const OvmOutput& mesh_;
  OutputFile& output_;
  LineWriter lines_;
  LoopProgress progress_;
};

}  // namespace

void writeOvmText(const OvmOutput& mesh, OutputFile& output, Stage& stage) {
  OvmTextWriter(mesh, output, stage).write();
}

namespace {

/// Reads a file, whose bytes are freed before cells are built.
template <bool binary, std::size_t corners>
OvmMesh readOvm(const Input& input, Stage& stage) {
  Array<char> room;
  // "OVM ASCII" or "Vertices" in any case, a comment, or "OVMB".
  const std::string_view bytes = input.text(room, stage, "OoVv#");
  return (binary ? parseOvmb : parseOvmText)(bytes, input.name(), kCellKind<corners>, stage);
}

/// @param mesh  a map or a hex mesh
template <bool binary, class Mesh>
void writeOvm(const Mesh& mesh, OutputFile& output, Stage& stage) {
  withThreads(stage.context().threads(),
              [&] { (binary ? writeOvmb : writeOvmText)(toOvm(mesh, stage), output, stage); });
}

}  // namespace

template <bool binary>
TetMap OvmFormat<binary>::readMap(const Input& input, const ReadOptions& /*options*/,
                                  Stage& stage) {
  return toTetMap(readOvm<binary, 4>(input, stage), input.name(), stage);
}

template <bool binary>
TetCells OvmFormat<binary>::readTets(const Input& input, Stage& stage) {
  return toTetCells(readOvm<binary, 4>(input, stage), input.name(), stage);
}

template <bool binary>
HexMesh OvmFormat<binary>::readMesh(const Input& input, Stage& stage) {
  return toHexMesh(readOvm<binary, 8>(input, stage), input.name(), stage);
}

template <bool binary>
void OvmFormat<binary>::writeMap(const TetMap& map, OutputFile& output,
                                 const WriteOptions& /*options*/, Stage& stage) {
  writeOvm<binary>(map, output, stage);
}

template <bool binary>
void OvmFormat<binary>::writeMesh(const HexMesh& mesh, OutputFile& output,
                                  const WriteOptions& /*options*/, Stage& stage) {
  writeOvm<binary>(mesh, output, stage);
}

template struct OvmFormat<false>;
template struct OvmFormat<true>;

}  // namespace hexhex::io
