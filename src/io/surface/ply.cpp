// Reads PLY, text and binary of both byte orders. Elements and properties other than vertices and
// faces are skipped.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/error.hpp>

#include <base/vector3.hpp>
#include <io/core/bytes.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>

namespace hexhex::io {
namespace {

template <class T>
double readPlyNumber(ByteCursor& cursor, bool bigEndian, const char* what) {
  const char* const place = cursor.take(sizeof(T), what).data();
  if constexpr (sizeof(T) > 1) {
    if (bigEndian) return static_cast<double>(loadBig<T>(place));
  }
  return static_cast<double>(loadLittle<T>(place));
}

/// A type of numbers, and how one is read from a binary file.
struct PlyType {
  std::string_view name;
  double (*read)(ByteCursor& cursor, bool bigEndian, const char* what);
};
constexpr std::array<PlyType, 16> kPlyTypes = {{{"char", readPlyNumber<std::int8_t>},
                                                {"int8", readPlyNumber<std::int8_t>},
                                                {"uchar", readPlyNumber<std::uint8_t>},
                                                {"uint8", readPlyNumber<std::uint8_t>},
                                                {"short", readPlyNumber<std::int16_t>},
                                                {"int16", readPlyNumber<std::int16_t>},
                                                {"ushort", readPlyNumber<std::uint16_t>},
                                                {"uint16", readPlyNumber<std::uint16_t>},
                                                {"int", readPlyNumber<std::int32_t>},
                                                {"int32", readPlyNumber<std::int32_t>},
                                                {"uint", readPlyNumber<std::uint32_t>},
                                                {"uint32", readPlyNumber<std::uint32_t>},
                                                {"float", readPlyNumber<float>},
                                                {"float32", readPlyNumber<float>},
                                                {"double", readPlyNumber<double>},
                                                {"float64", readPlyNumber<double>}}};

struct PlyProperty {
  std::string name;
  const PlyType* type = nullptr;
  bool isList = false;
  const PlyType* countType = nullptr;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

/// The numbers of a binary file.
class PlyBytes {
 public:
  PlyBytes(const TextScanner& head, bool bigEndian)
      : cursor_(head.text().substr(head.position()), head.text(), head.fileName()),
        bigEndian_(bigEndian) {}

  double number(const PlyType* type, const char* what) {
    return type->read(cursor_, bigEndian_, what);
  }

  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Parts... sentence) const {
    cursor_.fail(code, sentence...);
  }

 private:
  ByteCursor cursor_;
  bool bigEndian_;
};

/// The numbers of a text file.
class PlyText {
 public:
  explicit PlyText(TextScanner& scanner) : scanner_(scanner) {}
  double number(const PlyType* /*type*/, const char* what) { return scanner_.number(what); }
  template <class... Parts>
  [[noreturn]] void fail(ErrorCode code, Parts... sentence) const {
    scanner_.fail(code, sentence...);
  }

 private:
  TextScanner& scanner_;
};

/// The header.
class PlyHead {
 public:
  explicit PlyHead(TextScanner& scanner) : scanner_(scanner) {
    if (scanner_.readToken() != "ply") {
      scanner_.fail(ErrorCode::FileSyntax, "a .ply file begins with \"ply\", found ",
                    quoted(scanner_.currentToken()), ".");
    }
    while (true) {
      const std::string_view word = scanner_.readToken();
      if (word == "end_header") break;
      readLine(word);
    }
    if (encoding.empty()) scanner_.fail(ErrorCode::FileSyntax, "the head names no format.");
    if (encoding != "ascii") scanner_.skipLineBreak();
  }

  std::string encoding;
  std::vector<PlyElement> elements;

 private:
  void readLine(std::string_view word) {
    if (word == "format") {
      encoding = scanner_.readToken();
      if (encoding != "ascii" && encoding != "binary_little_endian" &&
          encoding != "binary_big_endian") {
        scanner_.fail(ErrorCode::FileUnsupported, "the format ", hexhex::io::quoted(encoding),
                      " is none of ascii, binary_little_endian "
                      "and binary_big_endian.");
      }
    } else if (word == "element") {
      PlyElement& element = elements.emplace_back();
      element.name = scanner_.readToken();
      const std::int64_t count = scanner_.integer("a number of elements");
      if (count < 0) scanner_.fail(ErrorCode::FileSyntax, "a number of elements is negative.");
      element.count = static_cast<std::uint64_t>(count);
      return;
    } else if (word == "property") {
      return readProperty();
    } else if (word != "comment" && word != "obj_info") {
      scanner_.fail(ErrorCode::FileSyntax, "expected a line of the head or \"end_header\", found ",
                    quoted(word), ".");
    }
    static_cast<void>(scanner_.takeLine());
  }

  void readProperty() {
    if (elements.empty()) {
      scanner_.fail(ErrorCode::FileSyntax, "a property stands before all elements.");
    }
    PlyProperty& property = elements.back().properties.emplace_back();
    property.isList = scanner_.peekToken() == "list";
    if (property.isList) {
      scanner_.readToken();
      property.countType = readType();
    }
    property.type = readType();
    property.name = scanner_.readToken();
  }

  const PlyType* readType() {
    const std::string_view word = scanner_.readToken();
    for (const PlyType& type : kPlyTypes) {
      if (word == type.name) return &type;
    }
    scanner_.fail(ErrorCode::FileSyntax, "expected the type of a property, found ", quoted(word),
                  ".");
  }

  TextScanner& scanner_;
};

template <class Numbers>
class PlyBody {
 public:
  explicit PlyBody(Numbers numbers) : numbers_(numbers) {}

  TriangleMesh read(const std::vector<PlyElement>& elements) {
    for (const PlyElement& element : elements) {
      if (element.properties.empty()) continue;  // takes no space in the file
      for (std::uint64_t i = 0; i < element.count; ++i) readRecord(element);
    }
    return std::move(mesh_);
  }

 private:
  void readRecord(const PlyElement& element) {
    const bool isVertex = element.name == "vertex";
    const bool isFace = element.name == "face";
    Vec3 point{};
    for (const PlyProperty& property : element.properties) {
      const bool isCorners = isFace && property.isList && property.name.starts_with("vertex_ind");
      if (property.isList) {
        readList(property, isCorners);
        continue;
      }
      const double x = numbers_.number(property.type, "a property");
      if (!isVertex || property.name.size() != 1) continue;
      const std::size_t axis = std::string_view("xyz").find(property.name);
      if (axis < 3) point[axis] = x;
    }
    if (!isVertex) return;
    if (!isFinite(point)) numbers_.fail(ErrorCode::NotFinite, "a vertex before is not finite.");
    mesh_.points.push_back(point);
  }

  void readList(const PlyProperty& property, bool isCorners) {
    const double count = numbers_.number(property.countType, "the length of a list");
    corners_.clear();
    for (double i = 0; i < count; ++i) {
      const double number = numbers_.number(property.type, "a number of a list");
      if (!isCorners) continue;
      if (!(number >= 0 && number < static_cast<double>(mesh_.points.size()) &&
            number == std::floor(number))) {
        numbers_.fail(ErrorCode::IndexOutOfRange,
                      "a corner of a face before is no vertex: there are ", mesh_.points.size(),
                      ", counted from 0.");
      }
      corners_.push_back(static_cast<Index>(number));
    }
    addPolygon(mesh_, corners_);
  }

  Numbers numbers_;
  TriangleMesh mesh_;
  std::vector<Index> corners_;
};

class PlyReader {
 public:
  static constexpr std::string_view kFirst = "p";

  PlyReader(std::string_view text, const std::string& name, Stage& /*stage*/)
      : scanner_(text, name) {}

  TriangleMesh read() {
    const PlyHead head(scanner_);
    if (head.encoding == "ascii") return PlyBody(PlyText(scanner_)).read(head.elements);
    return PlyBody(PlyBytes(scanner_, head.encoding == "binary_big_endian")).read(head.elements);
  }

 private:
  TextScanner scanner_;
};

}  // namespace

TriangleMesh readPly(const Input& input, Stage& stage) { return readWith<PlyReader>(input, stage); }

}  // namespace hexhex::io
