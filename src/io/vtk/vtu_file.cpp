// Tags first, which say where the arrays are, then the arrays' lengths, which must agree with them.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <type_traits>

#include <io/core/grid_map.hpp>
#include <io/core/text_scanner.hpp>
#include <io/core/zlib_blocks.hpp>
#include <io/vtk/vtu_decoding.hpp>
#include <io/vtk/vtu_file.hpp>

namespace hexhex {
namespace {

constexpr std::string_view kZlibCompressor = "vtkZLibDataCompressor";

// How much of a file is searched for the end of its head: first this, then more, at most that. A
// head takes some kilobytes; one with more holds arrays as text.
constexpr std::size_t kFirstHeadBytes = std::size_t{1} << 16;
constexpr std::size_t kMostHeadBytes = std::size_t{1} << 24;

struct ScalarName {
  std::string_view name;
  VtuScalar scalar;
  std::size_t bytes;
};
constexpr std::array<ScalarName, 10> kScalars = {{{"Int8", VtuScalar::Int8, 1},
                                                  {"UInt8", VtuScalar::UInt8, 1},
                                                  {"Int16", VtuScalar::Int16, 2},
                                                  {"UInt16", VtuScalar::UInt16, 2},
                                                  {"Int32", VtuScalar::Int32, 4},
                                                  {"UInt32", VtuScalar::UInt32, 4},
                                                  {"Int64", VtuScalar::Int64, 8},
                                                  {"UInt64", VtuScalar::UInt64, 8},
                                                  {"Float32", VtuScalar::Float32, 4},
                                                  {"Float64", VtuScalar::Float64, 8}}};

/// Numbers one after the other, as they are stored, into an array of T.
template <class Stored, class T>
void convert(const char* from, std::size_t count, T* to) {
  for (std::size_t i = 0; i < count; ++i) {
    Stored stored;
    std::memcpy(&stored, from + i * sizeof(Stored), sizeof(Stored));
    // NOLINTNEXTLINE(bugprone-signed-char-misuse): numbers of 8 bits keep their sign, too.
    to[i] = static_cast<T>(stored);
  }
}

template <class T>
void convert(VtuScalar scalar, const char* from, std::size_t count, T* to) {
  switch (scalar) {
    case VtuScalar::Int8:
      return convert<std::int8_t>(from, count, to);
    case VtuScalar::UInt8:
      return convert<std::uint8_t>(from, count, to);
    case VtuScalar::Int16:
      return convert<std::int16_t>(from, count, to);
    case VtuScalar::UInt16:
      return convert<std::uint16_t>(from, count, to);
    case VtuScalar::Int32:
      return convert<std::int32_t>(from, count, to);
    case VtuScalar::UInt32:
      return convert<std::uint32_t>(from, count, to);
    case VtuScalar::Int64:
      return convert<std::int64_t>(from, count, to);
    case VtuScalar::UInt64:
      return convert<std::uint64_t>(from, count, to);
    case VtuScalar::Float32:
      return convert<float>(from, count, to);
    case VtuScalar::Float64:
      return convert<double>(from, count, to);
  }
}

/// Whether numbers in memory have the bytes of the stored ones, so that they need not be converted.
template <class T>
bool isStoredAs(VtuScalar scalar) {
  if constexpr (std::is_same_v<T, double>) return scalar == VtuScalar::Float64;
  if constexpr (std::is_same_v<T, std::int64_t>) return scalar == VtuScalar::Int64;
  if constexpr (std::is_same_v<T, Index>) {
    return scalar == VtuScalar::Int32 || scalar == VtuScalar::UInt32;
  }
  return false;
}

/// The beginning of a file up to its binary data; everything up to a limit if it has none.
struct HeadBytes {
  Array<char> bytes;
  bool complete = false;  ///< the binary data begin within these bytes
};

HeadBytes readHeadBytes(const InputFile& input) {
  HeadBytes head;
  for (std::size_t most = kFirstHeadBytes; most <= kMostHeadBytes; most *= 4) {
    const std::size_t size = std::min<std::uint64_t>(most, input.size());
    head.bytes.resize(size);
    input.readAt(0, head.bytes.data(), size);
    const std::string_view text = asText(head.bytes);
    const std::size_t tag = text.find("<AppendedData");
    head.complete = tag != std::string_view::npos && text.find('_', tag) != std::string_view::npos;
    if (head.complete || size == input.size()) break;
  }
  return head;
}

}  // namespace

VtuFile::VtuFile(std::string_view text, const std::string& fileName, Stage& stage)
    : stage_(&stage),
      text_(text),
      fileSize_(text.size()),
      fileName_(fileName),
      tags_(text, fileName) {
  readHead();
  findColumns();
}

VtuFile::VtuFile(const InputFile& input, const std::string& fileName)
    : input_(&input),
      headBytes_(readHeadBytes(input).bytes),
      text_(asText(headBytes_)),
      fileSize_(input.size()),
      fileName_(fileName),
      tags_(text_, fileName) {
  readHead();
  findColumns();
}

bool VtuFile::hasPlainAppendedData(const InputFile& input) {
  const HeadBytes head = readHeadBytes(input);
  const std::string_view text = asText(head.bytes);
  if (!head.complete || text.find("compressor=") != std::string_view::npos) return false;
  const std::string_view tag = text.substr(text.find("<AppendedData"));
  return tag.substr(0, tag.find('_')).find("base64") == std::string_view::npos;
}

void VtuFile::readHead() {
  XmlTag tag;
  std::string_view section;
  while (tags_.next(tag)) {
    if (!hasFileTag_ && tag.name != "VTKFile") break;
    if (tag.name == "VTKFile" && !tag.closing) readFileTag(tag);
    if (tag.name == "Piece" && !tag.closing) readPieceTag(tag);
    if (tag.name == "FieldData" || tag.name == "PointData" || tag.name == "CellData" ||
        tag.name == "Points" || tag.name == "Cells") {
      section = tag.closing ? std::string_view() : tag.name;
    }
    if (tag.name == "DataArray" && !tag.closing) readArrayTag(tag, section);
    if (tag.name == "AppendedData" && !tag.closing) {
      readAppendedTag(tag);
      break;  // binary data, no more tags
    }
  }
  if (!hasFileTag_) fail(ErrorCode::FileSyntax, "this is no VTK XML file: no tag VTKFile.");
  if (!piece_) fail(ErrorCode::FileSyntax, "the file has no tag Piece: it is incomplete.");
}

void VtuFile::readFileTag(const XmlTag& tag) {
  hasFileTag_ = true;
  if (tag.attribute("type") != "UnstructuredGrid") {
    tags_.fail(ErrorCode::FileUnsupported,
               "the file's type is " + quoted(tag.attribute("type")) +
                   ", only UnstructuredGrid is supported.",
               tag.begin);
  }
  const std::string_view compressor = tag.attribute("compressor");
  compressed_ = !compressor.empty();
  if (compressed_ && compressor != kZlibCompressor) {
    tags_.fail(ErrorCode::FileUnsupported,
               "the file is compressed with " + quoted(compressor) +
                   ". Save it uncompressed or with zlib (vtkZLibDataCompressor).",
               tag.begin);
  }
  const bool little = std::endian::native == std::endian::little;
  const std::string_view order = tag.attribute("byte_order");
  if (!order.empty() && order != (little ? "LittleEndian" : "BigEndian")) {
    tags_.fail(ErrorCode::FileUnsupported,
               "the byte order " + quoted(order) + " is not that of this machine.", tag.begin);
  }
  const std::string_view header = tag.attribute("header_type");
  lengthBytes_ = header == "UInt64" ? sizeof(std::uint64_t) : sizeof(std::uint32_t);
}

void VtuFile::readPieceTag(const XmlTag& tag) {
  if (piece_) {
    tags_.fail(ErrorCode::FileUnsupported,
               "the file has several pieces; merge them into one and save it again.", tag.begin);
  }
  piece_ = tag.begin;
  pointCount_ = readCount(tag, "NumberOfPoints");
  cellCount_ = readCount(tag, "NumberOfCells");
}

std::uint64_t VtuFile::readCount(const XmlTag& tag, std::string_view attribute) const {
  const std::string_view value = tag.attribute(attribute);
  std::uint64_t count = 0;
  const auto result = std::from_chars(value.data(), value.data() + value.size(), count);
  if (result.ec != std::errc{} || result.ptr != value.data() + value.size()) {
    tags_.fail(
        ErrorCode::FileSyntax,
        "expected a whole number as " + std::string(attribute) + ", found " + quoted(value) + ".",
        tag.begin);
  }
  // Each point or cell takes some bytes, which zlib makes smaller at most by its ratio. Besides,
  // products of this count cannot overflow then.
  if (count / (compressed_ ? kLargestZlibRatio : 1) > fileSize_) {
    tags_.fail(ErrorCode::FileSyntax,
               std::string(attribute) + " is " + std::to_string(count) +
                   ", more than the file has room for: it is wrong or the file is incomplete.",
               tag.begin);
  }
  return count;
}

void VtuFile::readArrayTag(const XmlTag& tag, std::string_view section) {
  const std::size_t next = std::min(text_.find('<', tag.end), text_.size());
  const ArrayTag array{tag, text_.substr(tag.end, next - tag.end)};
  const std::string_view name = tag.attribute("Name");
  if (section == "FieldData") dataArrays_.push_back({array, VtuSection::Field});
  if (section == "PointData") dataArrays_.push_back({array, VtuSection::Points});
  if (section == "CellData") dataArrays_.push_back({array, VtuSection::Cells});
  if (section == "Points") coordinatesTag_ = array;
  if (section == "Cells" && name == "connectivity") connectivityTag_ = array;
  if (section == "Cells" && name == "offsets") endsTag_ = array;
  if (section == "Cells" && name == "types") typesTag_ = array;
  if (section == "PointData" && name == "generator_tet") generatorTetsTag_ = array;
  if (section == "PointData" && name == "generator_corners") generatorCornersTag_ = array;
}

void VtuFile::readAppendedTag(const XmlTag& tag) {
  const std::string_view encoding = tag.attribute("encoding");
  appendedBase64_ = encoding == "base64";
  if (!appendedBase64_ && encoding != "raw") {
    tags_.fail(ErrorCode::FileUnsupported,
               "the appended data are encoded as " + quoted(encoding) +
                   ", which is neither raw nor base64.",
               tag.begin);
  }
  const std::size_t mark = text_.find('_', tag.end);
  if (mark == std::string_view::npos) {
    tags_.fail(ErrorCode::FileSyntax, "the appended data are missing: the file is incomplete.",
               tag.begin);
  }
  appended_ = mark + 1;
}

void VtuFile::requireIndexable() const {
  for (const std::uint64_t count : {pointCount_, cellCount_}) {
    if (count <= kNone) continue;
    tags_.fail(ErrorCode::TooLarge,
               "the file holds " + std::to_string(count) + " points or cells; at most " +
                   std::to_string(kNone) + " are supported.",
               *piece_);
  }
}

void VtuFile::findColumns() {
  if (pointCount_ > 0) {
    coordinates_ = column(coordinatesTag_, "points", Kind::Reals, 3 * pointCount_);
    generatorTets_ = generatorColumn(generatorTetsTag_, VtuScalar::UInt32);
    generatorCorners_ = generatorColumn(generatorCornersTag_, VtuScalar::UInt8);
  }
  if (cellCount_ > 0) {
    types_ = column(typesTag_, "cell types", Kind::Integers, cellCount_);
    ends_ = column(endsTag_, "cell offsets", Kind::Integers, cellCount_);
    connectivity_ = column(connectivityTag_, "cell corners", Kind::Integers, std::nullopt);
  }
}

/// The numbers of an array that is needed, exactly `count` of them if that is known.
VtuColumn VtuFile::column(const std::optional<ArrayTag>& array, const char* what, Kind kind,
                          std::optional<std::uint64_t> count) const {
  if (!array) {
    fail(ErrorCode::FileSyntax, "the file has no array of " + std::string(what) + ".");
  }
  const std::string_view format = array->tag.attribute("format");
  if (format == "ascii") return parsedColumn(*array, kind, count);
  if (format != "appended" && format != "binary") {
    tags_.fail(ErrorCode::FileUnsupported,
               "the data format " + quoted(format) + " is none of appended, binary and ascii.",
               array->tag.begin);
  }
  const bool plain = format == "appended" && !appendedBase64_ && !compressed_;
  VtuColumn column = plain ? appendedColumn(*array, kind) : decodedColumn(*array, kind);
  if (count && column.count != *count) {
    tags_.fail(ErrorCode::FileSyntax,
               "this array should hold " + std::to_string(*count) + " numbers, but it holds " +
                   std::to_string(column.count) + ".",
               array->tag.begin);
  }
  return column;
}

/// An array without its numbers.
VtuColumn VtuFile::typedColumn(const ArrayTag& array, Kind kind) const {
  const std::string_view type = array.tag.attribute("type");
  const auto scalar = std::find_if(kScalars.begin(), kScalars.end(),
                                   [type](const ScalarName& entry) { return entry.name == type; });
  const bool isReal = type.starts_with("Float");
  if (scalar == kScalars.end() || isReal != (kind == Kind::Reals)) {
    tags_.fail(ErrorCode::FileUnsupported,
               "the number type " + quoted(type) + " is not supported for this array.",
               array.tag.begin);
  }
  VtuColumn column;
  column.scalar = scalar->scalar;
  column.bytesEach = scalar->bytes;
  return column;
}

VtuColumn VtuFile::appendedColumn(const ArrayTag& array, Kind kind) const {
  VtuColumn column = typedColumn(array, kind);
  const std::uint64_t offset = readCount(array.tag, "offset");
  const auto incomplete = [this, &array]() {
    tags_.fail(ErrorCode::FileSyntax,
               "the data of this array lie beyond the end of the file: it is incomplete.",
               array.tag.begin);
  };
  const std::uint64_t room = appended_ ? fileSize_ - *appended_ : 0;
  if (offset > room || room - offset < lengthBytes_) incomplete();
  column.position = *appended_ + offset + lengthBytes_;
  std::array<char, sizeof(std::uint64_t)> length{};
  readBytes(column.position - lengthBytes_, lengthBytes_, length.data());
  std::uint64_t bytes = 0;
  convert(lengthBytes_ == sizeof(std::uint64_t) ? VtuScalar::UInt64 : VtuScalar::UInt32,
          length.data(), 1, &bytes);
  if (bytes > room - offset - lengthBytes_) incomplete();
  column.count = bytes / column.bytesEach;
  return column;
}

/// An array that is base64 in its tag or appended, or compressed.
VtuColumn VtuFile::decodedColumn(const ArrayTag& array, Kind kind) const {
  VtuColumn column = typedColumn(array, kind);
  std::string_view text = array.content;
  bool base64 = true;
  if (array.tag.attribute("format") == "appended") {
    const std::uint64_t offset = readCount(array.tag, "offset");
    const std::uint64_t room = appended_ ? text_.size() - *appended_ : 0;
    if (offset > room) {
      tags_.fail(ErrorCode::FileSyntax,
                 "the data of this array lie beyond the end of the file: it is incomplete.",
                 array.tag.begin);
    }
    text = text_.substr(appended_ ? *appended_ + offset : text_.size());
    base64 = appendedBase64_;
  }
  std::string problem;
  std::optional<Array<char>> bytes =
      decodeVtuArray(text, {base64, compressed_, lengthBytes_}, stage_, problem);
  if (!bytes) {
    tags_.fail(compressed_ && !hasZlib() ? ErrorCode::FileUnsupported : ErrorCode::FileSyntax,
               problem, array.tag.begin);
  }
  column.inMemory = true;
  column.count = bytes->size() / column.bytesEach;
  column.decoded = std::move(*bytes);
  return column;
}

std::size_t VtuFile::componentsOf(const ArrayTag& array) {
  const std::string_view value = array.tag.attribute("NumberOfComponents");
  std::size_t components = 1;
  std::from_chars(value.data(), value.data() + value.size(), components);
  return components;
}

const VtuFile::DataArray* VtuFile::findArray(std::string_view name, VtuSection section,
                                             std::size_t components, Kind kind) const {
  for (const DataArray& data : dataArrays_) {
    const XmlTag& tag = data.array.tag;
    const std::string_view type = tag.attribute("type");
    const bool right = kind == Kind::Reals ? type.starts_with("Float")
                                           : type.starts_with("Int") || type.starts_with("UInt");
    if (right && data.section == section && tag.attribute("Name") == name &&
        componentsOf(data.array) == components) {
      return &data;
    }
  }
  return nullptr;
}

std::optional<VtuColumn> VtuFile::findReals(std::string_view name, bool ofCells,
                                            std::size_t components) const {
  const DataArray* const data =
      findArray(name, ofCells ? VtuSection::Cells : VtuSection::Points, components, Kind::Reals);
  if (data == nullptr) return std::nullopt;
  const std::uint64_t tuples = ofCells ? cellCount_ : pointCount_;
  return column(data->array, "the map", Kind::Reals, components * tuples);
}

std::optional<VtuColumn> VtuFile::findIntegers(std::string_view name, VtuSection section,
                                               std::size_t components) const {
  const DataArray* const data = findArray(name, section, components, Kind::Integers);
  if (data == nullptr) return std::nullopt;
  std::optional<std::uint64_t> count;
  if (section == VtuSection::Points) count = components * pointCount_;
  if (section == VtuSection::Cells) count = components * cellCount_;
  return column(data->array, "tags", Kind::Integers, count);
}

std::vector<std::string> VtuFile::describeArrays() const {
  std::vector<std::string> list;
  for (const DataArray& data : dataArrays_) {
    if (data.section == VtuSection::Field) continue;
    list.push_back(describeArray(data.array.tag.attribute("Name"),
                                 data.section == VtuSection::Cells, componentsOf(data.array)));
  }
  return list;
}

/// An array that is used if it is as this library writes it.
std::optional<VtuColumn> VtuFile::generatorColumn(const std::optional<ArrayTag>& array,
                                                  VtuScalar scalar) const {
  if (!array || array->tag.attribute("format") != "appended") return std::nullopt;
  if (!array->tag.attribute("type").starts_with("UInt")) return std::nullopt;
  const bool plain = !appendedBase64_ && !compressed_;
  VtuColumn column =
      plain ? appendedColumn(*array, Kind::Integers) : decodedColumn(*array, Kind::Integers);
  if (column.scalar != scalar || column.count != pointCount_) return std::nullopt;
  return column;
}

/// The numbers of a text, as Int64 or Float64. Without a count: as many as there are.
VtuColumn VtuFile::parsedColumn(const ArrayTag& array, Kind kind,
                                std::optional<std::uint64_t> count) const {
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
  VtuColumn values;
  values.inMemory = true;
  values.scalar = kind == Kind::Reals ? VtuScalar::Float64 : VtuScalar::Int64;
  values.bytesEach = 8;
  values.decoded.resize((count ? *count : room) * values.bytesEach);
  for (char* place = values.decoded.data(); count ? values.count < *count : scanner.skipSpace();
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
  if (scanner.skipSpace()) scanner.failToken("the end of the array");
  return values;
}

void VtuFile::readBytes(std::uint64_t position, std::size_t size, char* to) const {
  if (input_ != nullptr) return input_->readAt(position, to, size);
  std::copy_n(text_.data() + position, size, to);
}

template <class T>
void VtuFile::copy(const VtuColumn& column, std::uint64_t begin, std::size_t count, T* to) const {
  const std::uint64_t position = column.position + begin * column.bytesEach;
  if (column.inMemory) return convert(column.scalar, column.decoded.data() + position, count, to);
  if (input_ == nullptr) return convert(column.scalar, text_.data() + position, count, to);
  if (isStoredAs<T>(column.scalar)) return input_->readAt(position, to, count * sizeof(T));
  Array<char> bytes(count * column.bytesEach);
  input_->readAt(position, bytes.data(), bytes.size());
  convert(column.scalar, bytes.data(), count, to);
}

template void VtuFile::copy(const VtuColumn&, std::uint64_t, std::size_t, double*) const;
template void VtuFile::copy(const VtuColumn&, std::uint64_t, std::size_t, std::int64_t*) const;
template void VtuFile::copy(const VtuColumn&, std::uint64_t, std::size_t, Index*) const;
template void VtuFile::copy(const VtuColumn&, std::uint64_t, std::size_t, CornerSet*) const;

}  // namespace hexhex
