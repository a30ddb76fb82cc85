#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include <hexhex/error.hpp>

#include <io/core/letter_case.hpp>
#include <io/core/number_parsing.hpp>
#include <io/core/text_scanner.hpp>
#include <io/ovm/ovm_text_properties.hpp>

namespace hexhex {
namespace {

struct EntityKeyword {
  std::string_view word;
  OvmEntity entity;
};
constexpr std::array<EntityKeyword, 7> kEntities = {{{"VProp", OvmEntity::Vertex},
                                                     {"EProp", OvmEntity::Edge},
                                                     {"HEProp", OvmEntity::HalfEdge},
                                                     {"FProp", OvmEntity::Face},
                                                     {"HFProp", OvmEntity::HalfFace},
                                                     {"CProp", OvmEntity::Cell},
                                                     {"MProp", OvmEntity::Mesh}}};

constexpr std::array<std::string_view, 6> kIntegerTypes = {"int",  "uint",  "short",
                                                           "long", "ulong", "bool"};
constexpr std::array<std::string_view, 2> kPointTypes = {"vec3d", "vec3f"};

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
  while (!line.empty() && isSpace(line.front())) line.remove_prefix(1);
  std::size_t length = 0;
  while (length < line.size() && !isSpace(line[length])) ++length;
  const std::string_view word = line.substr(0, length);
  line.remove_prefix(length);
  return word;
}

std::optional<PropertyHeader> parseHeader(std::string_view line) {
  const std::string_view keyword = takeWord(line);
  const auto* const entity = std::find_if(
      kEntities.begin(), kEntities.end(),
      [&](const EntityKeyword& known) { return equalsIgnoringCase(known.word, keyword); });
  if (entity == kEntities.end()) return std::nullopt;
  PropertyHeader header{entity->entity, takeWord(line), {}};
  const std::size_t quote = line.find('"');
  if (quote == std::string_view::npos) return header;
  header.name = line.substr(quote + 1);
  while (!header.name.empty() && (isSpace(header.name.back()) || header.name.back() == '"')) {
    header.name.remove_suffix(1);
  }
  return header;
}

class PropertiesReader {
 public:
  PropertiesReader(const TextScanner& scanner, const TokenIndex& index, OvmMesh& mesh, Stage& stage)
      // Here, '#' may be part of a text.
      : text_(scanner.text()),
        scanner_(text_, scanner.fileName()),
        index_(index),
        mesh_(mesh),
        stage_(stage) {
    scanner_.moveTo(scanner.position());
  }

  void read();

 private:
  [[nodiscard]] bool readWanted(const PropertyHeader& header);
  void readPoints();
  void readIntegers(Array<std::int32_t>& values, std::size_t count, std::string_view name);
  void skipStrings(std::size_t count);

  std::string_view text_;
  TextScanner scanner_;
  const TokenIndex& index_;
  OvmMesh& mesh_;
  Stage& stage_;
};

void PropertiesReader::read() {
  // Behind values that were skipped without knowing them, everything up to the next header belongs
  // to them. Behind others, nothing does.
  bool anythingGoes = false;
  while (scanner_.skipSpace()) {
    const std::string_view first = scanner_.currentToken();
    const bool comment = !anythingGoes && first.front() == '#';
    const std::optional<PropertyHeader> header = parseHeader(
        text_.substr(scanner_.position()).substr(0, text_.substr(scanner_.position()).find('\n')));
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
bool PropertiesReader::readWanted(const PropertyHeader& header) {
  if (header.name == kParametrizationName) {
    const bool isMap = header.entity == OvmEntity::HalfFace && isOneOf(header.type, kPointTypes);
    if (isMap && mesh_.properties.parametrization.empty()) {
      readPoints();
      return true;
    }
    mesh_.hasForeignParametrization = true;
  }
  if (!isOneOf(header.type, kIntegerTypes)) return false;
  for (std::size_t i = 0; i < kOvmIntegers.size(); ++i) {
    Array<std::int32_t>& values = mesh_.properties.integers[i];
    if (kOvmIntegers[i].entity != header.entity || kOvmIntegers[i].name != header.name) continue;
    if (!values.empty()) continue;
    readIntegers(values, mesh_.topology.count(header.entity), header.name);
    return true;
  }
  return false;
}

/// Parameters of half-faces without a cell mean nothing, so not even finite numbers are demanded
/// here.
void PropertiesReader::readPoints() {
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

void PropertiesReader::readIntegers(Array<std::int32_t>& values, std::size_t count,
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
void PropertiesReader::skipStrings(std::size_t count) {
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

bool equalsIgnoringCase(std::string_view a, std::string_view b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lowerCase(x) == lowerCase(y); });
}

void readOvmTextProperties(const TextScanner& scanner, const TokenIndex& index, OvmMesh& mesh,
                           Stage& stage) {
  PropertiesReader(scanner, index, mesh, stage).read();
}

}  // namespace hexhex
