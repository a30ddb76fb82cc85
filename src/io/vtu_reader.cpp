// The reading half of vtu.hpp: first the tags, which say where the arrays are, then the arrays.
// Every size and offset is checked against the file before memory is allocated for it.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include <base/stage.hpp>
#include <io/input_file.hpp>
#include <io/text_scanner.hpp>
#include <io/vtu.hpp>
#include <io/xml_tags.hpp>

namespace hexhex {
namespace {

constexpr std::int64_t kVtkHexahedron = 12;
constexpr std::string_view kSaveDifferently =
    " Save it uncompressed, with raw appended or ascii data.";

// Elements between two reports of progress: a fraction of a millisecond's work.
constexpr std::size_t kProgressGrain = 4096;

/// The number types of VTK that are supported.
enum class Scalar { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float32, Float64 };

struct ScalarName {
  std::string_view name;
  Scalar scalar;
  std::size_t bytes;
};
constexpr std::array<ScalarName, 10> kScalars = {{{"Int8", Scalar::Int8, 1},
                                                  {"UInt8", Scalar::UInt8, 1},
                                                  {"Int16", Scalar::Int16, 2},
                                                  {"UInt16", Scalar::UInt16, 2},
                                                  {"Int32", Scalar::Int32, 4},
                                                  {"UInt32", Scalar::UInt32, 4},
                                                  {"Int64", Scalar::Int64, 8},
                                                  {"UInt64", Scalar::UInt64, 8},
                                                  {"Float32", Scalar::Float32, 4},
                                                  {"Float64", Scalar::Float64, 8}}};

template <class T, class Stored>
T convert(const char* place) {
  Stored stored;
  std::memcpy(&stored, place, sizeof(Stored));
  return static_cast<T>(stored);
}

/// The numbers of one array, where and how they are stored.
struct Values {
  const char* data = nullptr;
  Scalar scalar = Scalar::Float64;
  std::size_t bytesEach = 1;
  std::size_t count = 0;
  Array<char> parsed;  ///< the memory behind `data` if the file holds text

  template <class T>
  [[nodiscard]] T at(std::size_t i) const {
    const char* const place = data + i * bytesEach;
    switch (scalar) {
      case Scalar::Int8:
        return convert<T, std::int8_t>(place);
      case Scalar::UInt8:
        return convert<T, std::uint8_t>(place);
      case Scalar::Int16:
        return convert<T, std::int16_t>(place);
      case Scalar::UInt16:
        return convert<T, std::uint16_t>(place);
      case Scalar::Int32:
        return convert<T, std::int32_t>(place);
      case Scalar::UInt32:
        return convert<T, std::uint32_t>(place);
      case Scalar::Int64:
        return convert<T, std::int64_t>(place);
      case Scalar::UInt64:
        return convert<T, std::uint64_t>(place);
      case Scalar::Float32:
        return convert<T, float>(place);
      case Scalar::Float64:
        return convert<T, double>(place);
    }
    return T{};
  }
};

/// A DataArray element of the head: its tag, and the text up to the next tag (ascii data).
struct ArrayTag {
  XmlTag tag;
  std::string_view content;
};

/// What the tags say.
struct Head {
  std::uint64_t points = 0;
  std::uint64_t cells = 0;
  std::optional<ArrayTag> coordinates;
  std::optional<ArrayTag> connectivity;
  std::optional<ArrayTag> offsets;
  std::optional<ArrayTag> types;
  std::size_t headerBytes = 4;  ///< size of the byte count in front of each appended array
  std::string_view appended;    ///< everything after the '_' of AppendedData
};

class VtuReader {
 public:
  VtuReader(std::string_view text, const std::string& fileName, Stage& stage)
      : text_(text), fileName_(fileName), tags_(text, fileName), stage_(stage) {}

  HexMesh read() {
    readHead();
    readPoints();
    readCells();
    return std::move(mesh_);
  }

 private:
  void readHead();
  void readFileTag(const XmlTag& tag);
  void readPieceTag(const XmlTag& tag);
  void readArrayTag(const XmlTag& tag, std::string_view section);
  void readAppendedTag(const XmlTag& tag);
  std::uint64_t readCount(const XmlTag& tag, std::string_view attribute);
  void readPoints();
  void readCells();
  void copyHexahedra(const Values& connectivity, const Values& offsets, const Values& types);
  void copyHexahedron(const Values& connectivity, std::size_t begin, std::size_t cell, Hex& hex);

  enum class Kind { Integers, Reals };
  const ArrayTag& required(const std::optional<ArrayTag>& array, const char* what) const;
  Values valuesOf(const ArrayTag& array, Kind kind, std::optional<std::uint64_t> count);
  Values appendedValues(const ArrayTag& array, const ScalarName& scalar);
  Values parsedValues(const ArrayTag& array, Kind kind, std::optional<std::uint64_t> count);
  [[noreturn]] void fail(ErrorCode code, const std::string& sentence, Place place = {}) const {
    throw Error(code, fileName_ + ": " + sentence, place);
  }

  std::string_view text_;
  std::string fileName_;
  XmlTags tags_;
  Stage& stage_;
  Head head_;
  bool hasFileTag_ = false;
  bool hasPiece_ = false;
  HexMesh mesh_;
};

void VtuReader::readHead() {
  XmlTag tag;
  std::string_view section;
  while (tags_.next(tag)) {
    if (!hasFileTag_ && tag.name != "VTKFile") break;
    if (tag.name == "VTKFile" && !tag.closing) readFileTag(tag);
    if (tag.name == "Piece" && !tag.closing) readPieceTag(tag);
    if (tag.name == "PointData" || tag.name == "CellData" || tag.name == "Points" ||
        tag.name == "Cells") {
      section = tag.closing ? std::string_view() : tag.name;
    }
    if (tag.name == "DataArray" && !tag.closing) readArrayTag(tag, section);
    if (tag.name == "AppendedData" && !tag.closing) {
      readAppendedTag(tag);
      break;  // binary data, no more tags
    }
  }
  if (!hasFileTag_) fail(ErrorCode::FileSyntax, "this is no VTK XML file: no tag VTKFile.");
  if (!hasPiece_) fail(ErrorCode::FileSyntax, "the file has no tag Piece: it is incomplete.");
}

void VtuReader::readFileTag(const XmlTag& tag) {
  hasFileTag_ = true;
  if (tag.attribute("type") != "UnstructuredGrid") {
    tags_.fail(ErrorCode::FileUnsupported,
               "the file's type is " + quoted(tag.attribute("type")) +
                   ", only UnstructuredGrid is supported.",
               tag.begin);
  }
  if (!tag.attribute("compressor").empty()) {
    tags_.fail(ErrorCode::FileUnsupported,
               "the file is compressed." + std::string(kSaveDifferently), tag.begin);
  }
  const bool little = std::endian::native == std::endian::little;
  const std::string_view order = tag.attribute("byte_order");
  if (!order.empty() && order != (little ? "LittleEndian" : "BigEndian")) {
    tags_.fail(ErrorCode::FileUnsupported,
               "the byte order " + quoted(order) + " is not that of this machine.", tag.begin);
  }
  const std::string_view header = tag.attribute("header_type");
  head_.headerBytes = header == "UInt64" ? sizeof(std::uint64_t) : sizeof(std::uint32_t);
}

void VtuReader::readPieceTag(const XmlTag& tag) {
  if (hasPiece_) {
    tags_.fail(ErrorCode::FileUnsupported,
               "the file has several pieces; merge them into one and save it again.", tag.begin);
  }
  hasPiece_ = true;
  head_.points = readCount(tag, "NumberOfPoints");
  head_.cells = readCount(tag, "NumberOfCells");
}

std::uint64_t VtuReader::readCount(const XmlTag& tag, std::string_view attribute) {
  const std::string_view value = tag.attribute(attribute);
  std::uint64_t count = 0;
  const auto result = std::from_chars(value.data(), value.data() + value.size(), count);
  if (result.ec != std::errc{} || result.ptr != value.data() + value.size()) {
    tags_.fail(
        ErrorCode::FileSyntax,
        "expected a whole number as " + std::string(attribute) + ", found " + quoted(value) + ".",
        tag.begin);
  }
  // Each point or cell takes some bytes. Besides, products of this count cannot overflow then.
  if (count > text_.size()) {
    tags_.fail(ErrorCode::FileSyntax,
               std::string(attribute) + " is " + std::to_string(count) +
                   ", more than the file has room for: it is wrong or the file is incomplete.",
               tag.begin);
  }
  if (count > kNone) {
    tags_.fail(ErrorCode::TooLarge,
               std::string(attribute) + " is " + std::to_string(count) + "; at most " +
                   std::to_string(kNone) + " are supported.",
               tag.begin);
  }
  return count;
}

void VtuReader::readArrayTag(const XmlTag& tag, std::string_view section) {
  const std::size_t next = std::min(text_.find('<', tag.end), text_.size());
  const ArrayTag array{tag, text_.substr(tag.end, next - tag.end)};
  const std::string_view name = tag.attribute("Name");
  if (section == "Points") head_.coordinates = array;
  if (section == "Cells" && name == "connectivity") head_.connectivity = array;
  if (section == "Cells" && name == "offsets") head_.offsets = array;
  if (section == "Cells" && name == "types") head_.types = array;
}

void VtuReader::readAppendedTag(const XmlTag& tag) {
  if (tag.attribute("encoding") != "raw") {
    tags_.fail(ErrorCode::FileUnsupported,
               "the appended data are encoded as " + quoted(tag.attribute("encoding")) + "." +
                   std::string(kSaveDifferently),
               tag.begin);
  }
  const std::size_t mark = text_.find('_', tag.end);
  if (mark == std::string_view::npos) {
    tags_.fail(ErrorCode::FileSyntax, "the appended data are missing: the file is incomplete.",
               tag.begin);
  }
  head_.appended = text_.substr(mark + 1);
}

const ArrayTag& VtuReader::required(const std::optional<ArrayTag>& array, const char* what) const {
  if (array) return *array;
  fail(ErrorCode::FileSyntax, "the file has no array of " + std::string(what) + ".");
}

/// The numbers of an array, exactly `count` of them if that is known.
Values VtuReader::valuesOf(const ArrayTag& array, Kind kind, std::optional<std::uint64_t> count) {
  const std::string_view format = array.tag.attribute("format");
  if (format == "ascii") return parsedValues(array, kind, count);
  if (format != "appended") {
    tags_.fail(
        ErrorCode::FileUnsupported,
        "the data format " + quoted(format) + " is not supported." + std::string(kSaveDifferently),
        array.tag.begin);
  }
  const std::string_view type = array.tag.attribute("type");
  const auto scalar = std::find_if(kScalars.begin(), kScalars.end(),
                                   [type](const ScalarName& entry) { return entry.name == type; });
  const bool isReal = type.starts_with("Float");
  if (scalar == kScalars.end() || isReal != (kind == Kind::Reals)) {
    tags_.fail(ErrorCode::FileUnsupported,
               "the number type " + quoted(type) + " is not supported for this array.",
               array.tag.begin);
  }
  Values values = appendedValues(array, *scalar);
  if (count && values.count != *count) {
    tags_.fail(ErrorCode::FileSyntax,
               "this array should hold " + std::to_string(*count) + " numbers, but it holds " +
                   std::to_string(values.count) + ".",
               array.tag.begin);
  }
  return values;
}

Values VtuReader::appendedValues(const ArrayTag& array, const ScalarName& scalar) {
  const std::uint64_t offset = readCount(array.tag, "offset");
  const std::string_view data = head_.appended;
  const auto incomplete = [this, &array]() {
    tags_.fail(ErrorCode::FileSyntax,
               "the data of this array lie beyond the end of the file: it is incomplete.",
               array.tag.begin);
  };
  if (offset > data.size() || data.size() - offset < head_.headerBytes) incomplete();
  const char* const header = data.data() + offset;
  const std::uint64_t bytes = head_.headerBytes == sizeof(std::uint64_t)
                                  ? convert<std::uint64_t, std::uint64_t>(header)
                                  : convert<std::uint64_t, std::uint32_t>(header);
  if (bytes > data.size() - offset - head_.headerBytes) incomplete();
  Values values;
  values.data = header + head_.headerBytes;
  values.scalar = scalar.scalar;
  values.bytesEach = scalar.bytes;
  values.count = bytes / scalar.bytes;
  return values;
}

/// The numbers of a text, as Int64 or Float64. Without a count: as many as there are.
Values VtuReader::parsedValues(const ArrayTag& array, Kind kind,
                               std::optional<std::uint64_t> count) {
  // A view from the beginning of the file makes line numbers right; the scanner ends at the next
  // tag. Two bytes are the least that a number takes with its separator.
  TextScanner scanner(text_.substr(0, array.tag.end + array.content.size()), fileName_);
  scanner.moveTo(array.tag.end);
  const std::size_t room = array.content.size() / 2 + 1;
  if (count && *count > room) {
    tags_.fail(ErrorCode::FileSyntax,
               "this array should hold " + std::to_string(*count) +
                   " numbers, but there is only room for " + std::to_string(room) + ".",
               array.tag.begin);
  }
  Values values;
  values.scalar = kind == Kind::Reals ? Scalar::Float64 : Scalar::Int64;
  values.bytesEach = 8;
  values.parsed.resize((count ? *count : room) * values.bytesEach);
  values.data = values.parsed.data();
  for (char* place = values.parsed.data(); count ? values.count < *count : scanner.skipSpace();
       ++values.count, place += values.bytesEach) {
    double real = 0;
    std::int64_t integer = 0;
    if (kind == Kind::Reals) {
      if (!scanner.readNumber(real)) scanner.failNumber("a number");
      std::memcpy(place, &real, sizeof(real));
    } else {
      if (!scanner.readInteger(integer)) scanner.failInteger("a whole number");
      std::memcpy(place, &integer, sizeof(integer));
    }
  }
  if (scanner.skipSpace()) {
    scanner.fail(ErrorCode::FileSyntax,
                 "expected the end of the array, found " + quoted(scanner.currentToken()) + ".");
  }
  return values;
}

void VtuReader::readPoints() {
  if (head_.points == 0) return;
  const ArrayTag& array = required(head_.coordinates, "points");
  const Values values = valuesOf(array, Kind::Reals, 3 * head_.points);
  mesh_.points.resize(head_.points);
  LoopProgress progress(stage_, head_.points);
  for (std::size_t i = 0; i < head_.points; ++i) {
    if (i % kProgressGrain == 0) progress.advance(std::min(kProgressGrain, head_.points - i));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto coordinate = values.at<double>(3 * i + axis);
      if (!std::isfinite(coordinate)) {
        fail(ErrorCode::NotFinite, "a coordinate of point " + std::to_string(i) + " is not finite.",
             Place{PlaceKind::Vertex, i});
      }
      mesh_.points[i][axis] = coordinate;
    }
  }
}

void VtuReader::readCells() {
  if (head_.cells == 0) return;
  const Values types = valuesOf(required(head_.types, "cell types"), Kind::Integers, head_.cells);
  const Values offsets =
      valuesOf(required(head_.offsets, "cell offsets"), Kind::Integers, head_.cells);
  const Values connectivity =
      valuesOf(required(head_.connectivity, "cell corners"), Kind::Integers, std::nullopt);
  copyHexahedra(connectivity, offsets, types);
}

void VtuReader::copyHexahedra(const Values& connectivity, const Values& offsets,
                              const Values& types) {
  std::size_t hexahedra = 0;
  for (std::size_t i = 0; i < types.count; ++i) {
    if (types.at<std::int64_t>(i) == kVtkHexahedron) ++hexahedra;
  }
  if (hexahedra == 0) {
    fail(ErrorCode::FileUnsupported, "the file holds no hexahedra: none of its " +
                                         std::to_string(types.count) + " cells has the type 12.");
  }
  mesh_.cells.resize(hexahedra);
  LoopProgress progress(stage_, types.count);
  std::size_t next = 0;
  std::uint64_t begin = 0;
  for (std::size_t i = 0; i < types.count; ++i) {
    if (i % kProgressGrain == 0) progress.advance(std::min(kProgressGrain, types.count - i));
    const auto end = offsets.at<std::uint64_t>(i);
    if (end < begin || end > connectivity.count) {
      fail(ErrorCode::FileSyntax,
           "the corners of cell " + std::to_string(i) + " end at " + std::to_string(end) +
               ", which is before they begin or beyond the " + std::to_string(connectivity.count) +
               " corners in the file.",
           Place{PlaceKind::Cell, i});
    }
    if (types.at<std::int64_t>(i) == kVtkHexahedron) {
      if (end - begin != std::tuple_size_v<Hex>) {
        fail(ErrorCode::FileSyntax,
             "cell " + std::to_string(i) + " is a hexahedron with " + std::to_string(end - begin) +
                 " instead of 8 corners.",
             Place{PlaceKind::Cell, i});
      }
      copyHexahedron(connectivity, begin, i, mesh_.cells[next++]);
    }
    begin = end;
  }
}

void VtuReader::copyHexahedron(const Values& connectivity, std::size_t begin, std::size_t cell,
                               Hex& hex) {
  for (std::size_t corner = 0; corner < hex.size(); ++corner) {
    const auto vertex = connectivity.at<std::int64_t>(begin + corner);
    if (vertex < 0 || vertex >= static_cast<std::int64_t>(head_.points)) {
      fail(ErrorCode::IndexOutOfRange,
           "cell " + std::to_string(cell) + " names point " + std::to_string(vertex) +
               ", but the " + std::to_string(head_.points) + " points are numbered from 0.",
           Place{PlaceKind::Cell, cell});
    }
    hex[corner] = static_cast<Index>(vertex);
  }
}

}  // namespace

HexMesh parseVtu(std::string_view text, const std::string& fileName, Context& context) {
  Stage stage(context, "read mesh");
  return VtuReader(text, fileName, stage).read();
}

HexMesh readVtu(const std::filesystem::path& file, Context& context) {
  Stage stage(context, "read mesh");
  const Array<char> bytes = readWholeFile(file);
  return VtuReader(asText(bytes), file.string(), stage).read();
}

}  // namespace hexhex
