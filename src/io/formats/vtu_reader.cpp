// Reads `.vtu` files: tags locate the arrays, whose own lengths must agree. Every size and offset
// is checked against the file.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/bytes.hpp>
#include <io/core/compressed_blocks.hpp>
#include <io/core/input_file.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/vtk_source.hpp>
#include <io/formats/xml_tags.hpp>

namespace hexhex::io {

namespace {

/// A way in which blocks are compressed.
struct VtuCompressor {
  std::string_view name;
  std::size_t largestRatio;
  bool (*decode)(std::string_view compressed, std::span<char> bytes) noexcept;
};
constexpr std::array<VtuCompressor, 3> kCompressors = {
    {{"vtkZLibDataCompressor", kLargestZlibRatio, inflateBlock},
     {"vtkLZ4DataCompressor", kLargestLz4Ratio, decodeLz4Block},
     {"vtkLZMADataCompressor", kLargestLzmaRatio, decodeLzmaBlock}}};

/// The encoding of an array.
struct VtuEncoding {
  bool base64 = false;
  bool bigEndian = false;       ///< as in VtkColumn
  std::size_t lengthBytes = 4;  ///< of the numbers before the data
  const VtuCompressor* compressor = nullptr;
};

constexpr std::uint8_t kNoDigit = 255;
constexpr std::uint8_t kPadding = 64;

constexpr std::array<std::uint8_t, 256> kBase64Digits = [] {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/=";
  std::array<std::uint8_t, 256> table{};
  table.fill(kNoDigit);
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    table[static_cast<unsigned char>(kDigits[i])] = static_cast<std::uint8_t>(i);
  }
  return table;
}();

/// Reads bytes in sequence, raw or from base64 text. In base64, white space is skipped, and several
/// texts that end with padding may be concatenated.
class EncodedBytes {
 public:
  EncodedBytes(std::string_view text, bool base64) : rest_(text), base64_(base64) {}

  /// Reads `size` bytes; false if there are fewer, or the text is not base64.
  [[nodiscard]] bool read(char* to, std::size_t size) {
    if (!base64_) {
      if (size > rest_.size()) return false;
      std::copy_n(rest_.data(), size, to);
      rest_.remove_prefix(size);
      return true;
    }
    while (size > 0) {
      if (pendingBegin_ == pendingEnd_ && !decodeGroup()) return false;
      *to++ = pending_[pendingBegin_++];
      --size;
    }
    return true;
  }

  /// Upper bound on the bytes left.
  [[nodiscard]] std::size_t room() const noexcept {
    return base64_ ? rest_.size() / 4 * 3 + (pendingEnd_ - pendingBegin_) : rest_.size();
  }

 private:
  /// Decodes four characters to three bytes, or fewer if they are padded.
  bool decodeGroup() {
    std::array<std::uint8_t, 4> digits{};
    std::size_t count = 0;
    std::size_t used = 0;
    while (count < digits.size()) {
      if (used == rest_.size()) return false;
      const char c = rest_[used++];
      if (isSpace(c)) continue;
      digits[count] = kBase64Digits[static_cast<unsigned char>(c)];
      if (digits[count++] == kNoDigit) return false;
    }
    rest_.remove_prefix(used);
    if (digits[0] == kPadding || digits[1] == kPadding) return false;
    const bool one = digits[2] == kPadding;
    const bool two = digits[3] == kPadding;
    if (one && !two) return false;
    const auto digit = [&](std::size_t i) { return std::uint32_t{digits[i]} & 63U; };
    const std::uint32_t bits =
        digit(0) << 18U | digit(1) << 12U | (one ? 0 : digit(2) << 6U) | (two ? 0 : digit(3));
    pending_ = {static_cast<char>(bits >> 16U), static_cast<char>(bits >> 8U),
                static_cast<char>(bits)};
    pendingBegin_ = 0;
    pendingEnd_ = one ? 1 : (two ? 2 : 3);
    return true;
  }

  std::string_view rest_;
  bool base64_;
  std::array<char, 3> pending_{};
  std::size_t pendingBegin_ = 0;
  std::size_t pendingEnd_ = 0;
};

/// The blocks of a compressed array.
struct Blocks {
  std::uint64_t size = 0;             ///< uncompressed size of each block
  std::uint64_t lastSize = 0;         ///< of the last block
  std::vector<std::uint64_t> begins;  ///< of the compressed blocks, and the end of the last
};

/// Reads a number before the data.
bool readLength(EncodedBytes& source, const VtuEncoding& encoding, std::uint64_t& length) {
  std::array<char, sizeof(length)> bytes{};
  if (!source.read(bytes.data(), encoding.lengthBytes)) return false;
  const auto load = [&]<class Length>(Length number) {
    std::memcpy(&number, bytes.data(), sizeof(number));
    return encoding.bigEndian ? loadBig<Length>(bytes.data()) : number;
  };
  length = encoding.lengthBytes == 4 ? load(std::uint32_t{}) : load(std::uint64_t{});
  return true;
}

/// Reads the header of compressed data: number of blocks, their size, size of a shorter last block
/// or 0, and the compressed sizes.
bool readBlocks(EncodedBytes& source, const VtuEncoding& encoding, Blocks& blocks) {
  std::uint64_t count = 0;
  if (!readLength(source, encoding, count) || !readLength(source, encoding, blocks.size) ||
      !readLength(source, encoding, blocks.lastSize) ||
      count > source.room() / encoding.lengthBytes) {
    return false;
  }
  if (blocks.lastSize == 0) blocks.lastSize = blocks.size;
  blocks.begins = {0};
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint64_t size = 0;
    if (!readLength(source, encoding, size) || size > source.room()) return false;
    const std::uint64_t limit = size * encoding.compressor->largestRatio;
    if ((i + 1 < count ? blocks.size : blocks.lastSize) > limit) return false;
    blocks.begins.push_back(blocks.begins.back() + size);
  }
  return blocks.begins.back() <= source.room() && blocks.lastSize <= blocks.size;
}

constexpr const char* kIncomplete = "the data of this array are incomplete.";
constexpr const char* kIncompleteOrNoBase64 =
    "the data of this array are incomplete, or no base64.";

/// Decodes the bytes of an array.
/// @param text  starting with the array; whatever follows it is ignored
/// @param fail  throws an error about the array with this sentence
Array<char> decodeVtuArray(std::string_view text, const VtuEncoding& encoding, Stage& stage,
                           const std::function<void(const char* sentence)>& fail) {
  EncodedBytes source(text, encoding.base64);
  if (encoding.compressor == nullptr) {
    std::uint64_t length = 0;
    if (!readLength(source, encoding, length) || length > source.room()) {
      fail(kIncomplete);
    }
    Array<char> bytes(static_cast<std::size_t>(length));
    if (!source.read(bytes.data(), bytes.size())) fail(kIncompleteOrNoBase64);
    return bytes;
  }
  Blocks blocks;
  if (!readBlocks(source, encoding, blocks)) fail(kIncomplete);
  const std::size_t count = blocks.begins.size() - 1;
  if (count == 0) return {};
  Array<char> compressed(memorySize(blocks.begins.back()));
  if (!source.read(compressed.data(), compressed.size())) fail(kIncompleteOrNoBase64);
  Array<char> bytes(memorySize((count - 1) * blocks.size + blocks.lastSize));
  constexpr std::size_t kGrain = 8;  // blocks of a few tens of kilobytes
  const auto decode = [&](std::size_t i) {
    const auto begin = static_cast<std::size_t>(blocks.begins[i]);
    const auto end = static_cast<std::size_t>(blocks.begins[i + 1]);
    const auto place = static_cast<std::size_t>(i * blocks.size);
    const auto size = static_cast<std::size_t>(i + 1 < count ? blocks.size : blocks.lastSize);
    return encoding.compressor->decode({compressed.data() + begin, end - begin},
                                       {bytes.data() + place, size});
  };
  if (firstFault(stage, count, decode, kGrain) < count) {
    fail("the compressed data of this array are damaged.");
  }
  return bytes;
}

// Files.

constexpr std::array<std::pair<std::string_view, VtkSection>, 7> kSections = {
    {{"FieldData", VtkSection::FieldData},
     {"PointData", VtkSection::PointData},
     {"CellData", VtkSection::CellData},
     {"Points", VtkSection::Points},
     {"Coordinates", VtkSection::Points},  // of rectilinear grids
     {"Polys", VtkSection::Polys},
     {"Cells", VtkSection::Cells}}};

constexpr std::array<std::pair<std::string_view, VtkScalar>, 11> kScalars = {
    {{"String", std::uint8_t{}},
     {"Int8", std::int8_t{}},
     {"UInt8", std::uint8_t{}},
     {"Int16", std::int16_t{}},
     {"UInt16", std::uint16_t{}},
     {"Int32", std::int32_t{}},
     {"UInt32", std::uint32_t{}},
     {"Int64", std::int64_t{}},
     {"UInt64", std::uint64_t{}},
     {"Float32", float{}},
     {"Float64", double{}}}};

/// Looks up a name in a table; null if it is not there.
template <class Table>
auto* lookUp(const Table& table, std::string_view name) {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [name](const auto& entry) { return entry.first == name; });
  return found == table.end() ? nullptr : &found->second;
}

VtkNumbers vtkNumbersOf(std::string_view type) {
  if (type.starts_with("Float")) return VtkNumbers::Reals;
  if (type.starts_with("Int") || type.starts_with("UInt")) return VtkNumbers::Integers;
  return VtkNumbers::Others;
}

/// A tag Piece and its arrays.
struct VtuPiece {
  XmlTag tag;
  std::uint64_t points = 0;
  std::uint64_t cells = 0;
  std::vector<VtkSourceArray> arrays = {};

  /// The size of an array with this many numbers per point or cell.
  [[nodiscard]] std::uint64_t numbersOf(VtkSection section, std::size_t each) const {
    const bool ofPoints = section == VtkSection::Points || section == VtkSection::PointData;
    return each * (ofPoints ? points : cells);
  }
};

/// An open `.vtu` file. Functions throw Error FileSyntax or FileUnsupported.
///
/// If there are several pieces, their arrays are concatenated in memory, and points of different
/// pieces at the same position are merged, since pieces repeat shared points.
class VtuFile final : public VtkSource {
 public:
  /// @param stage  for parallel decoding
  VtuFile(VtkFileBytes bytes, const std::string& fileName, Stage& stage)
      : VtkSource(std::move(bytes), fileName), stage_(stage), tags_(text(), fileName) {
    readTags();
    if (type_ != "UnstructuredGrid" && pieces_.size() > 1) {
      tags_.fail(ErrorCode::FileUnsupported, pieces_[1].tag,
                 "several pieces are read of unstructured grids only; save it as one piece.");
    }
    leaveOutEmpty();
    if (isGrid()) {
      readGrid();
      return;
    }
    for (const VtuPiece& piece : pieces_) {
      pointsBefore_.push_back(std::exchange(points, points + piece.points));
      cells += piece.cells;
    }
    if (points > 0) {
      coordinates = joined(columnsOf(VtkSection::Points, {}, "points", VtkNumbers::Reals, 3),
                           VtkNumbers::Reals);
    }
    if (cells > 0) readCells();
    if (pieces_.size() == 1) {
      arrays.insert(arrays.end(), pieces_[0].arrays.begin(), pieces_[0].arrays.end());
    } else {
      joinPieces();
    }
  }

  void requireIndexable() const override {
    for (const std::uint64_t count : {points, cells}) {
      if (count <= kNone) continue;
      tags_.fail(ErrorCode::TooLarge, pieces_[0].tag, "the file holds ", count,
                 " points or cells; at most ", kNone, " are supported.");
    }
  }

 private:
  void readTags() {
    XmlTag tag;
    const VtkSection* section = nullptr;
    while (tags_.next(tag)) {
      if (!hasFileTag_ && tag.name != "VTKFile") break;
      if (const VtkSection* const named = lookUp(kSections, tag.name)) {
        section = tag.closing ? nullptr : named;
      }
      if (tag.closing) continue;
      if (tag.name == "VTKFile") readFileTag(tag);
      if (tag.name == "ImageData") image_ = tag;
      if (tag.name == "Piece") readPieceTag(tag);
      // VTK writes arrays of strings with the tag Array.
      const bool isTexts =
          tag.name == "Array" && section != nullptr && *section == VtkSection::FieldData;
      if ((tag.name == "DataArray" || isTexts) && section != nullptr) readArrayTag(tag, *section);
      if (tag.name == "AppendedData") {
        readAppendedTag(tag);
        break;  // binary data, no more tags
      }
    }
    if (!hasFileTag_) fail(ErrorCode::FileSyntax, "this is no VTK XML file: no tag VTKFile.");
    if (pieces_.empty())
      fail(ErrorCode::FileSyntax, "the file has no tag Piece: it is incomplete.");
  }

  void readFileTag(const XmlTag& tag) {
    hasFileTag_ = true;
    type_ = tag.attribute("type");
    if (!isGrid() && !isPolyData() && type_ != "UnstructuredGrid") {
      tags_.fail(ErrorCode::FileUnsupported, tag, "the file's type is ", quoted(type_),
                 ", only grids and surfaces in one file are supported.");
    }
    const std::string_view compressor = tag.attribute("compressor");
    if (!compressor.empty()) {
      const auto known = std::find_if(kCompressors.begin(), kCompressors.end(),
                                      [&](const auto& each) { return each.name == compressor; });
      if (known == kCompressors.end()) {
        tags_.fail(ErrorCode::FileUnsupported, tag, "the file is compressed with ",
                   quoted(compressor), ", which is none of VTK's compressors.");
      }
      encoding_.compressor = &*known;
    }
    const std::string_view order = tag.attribute("byte_order");
    const bool bigHere = std::endian::native == std::endian::big;
    encoding_.bigEndian = order == "BigEndian" && !bigHere;
    if (!order.empty() && order != "BigEndian" && (bigHere || order != "LittleEndian")) {
      tags_.fail(ErrorCode::FileUnsupported, tag, "the byte order ", quoted(order),
                 " is not supported.");
    }
    const std::string_view header = tag.attribute("header_type");
    encoding_.lengthBytes = header == "UInt64" ? sizeof(std::uint64_t) : sizeof(std::uint32_t);
    const std::string_view version = tag.attribute("version");
    const bool isOld = version.empty() || version == "2.0" || version[0] < '2';
    uprightEdges = isOld ? VtkEdges::RowByRow : VtkEdges::Around;
  }

  [[nodiscard]] bool isPolyData() const { return type_ == "PolyData"; }
  [[nodiscard]] bool isGrid() const {
    return type_ == "ImageData" || type_ == "RectilinearGrid" || type_ == "StructuredGrid";
  }

  void readPieceTag(const XmlTag& tag) {
    VtuPiece& piece = pieces_.emplace_back(VtuPiece{tag});
    if (isGrid()) return;
    piece.points = readCount(tag, "NumberOfPoints");
    piece.cells = readCount(tag, isPolyData() ? "NumberOfPolys" : "NumberOfCells");
    const bool strips = isPolyData() && !tag.attribute("NumberOfStrips").empty() &&
                        readCount(tag, "NumberOfStrips") > 0;
    if (!strips) return;
    tags_.fail(ErrorCode::FileUnsupported, tag,
               "triangle strips are not read; save the surface as triangles.");
  }

  /// The numbers in an attribute.
  /// @param numbers  those that it has if it is missing
  template <std::size_t n>
  std::array<double, n> readNumbers(const XmlTag& tag, std::string_view attribute,
                                    std::array<double, n> numbers) const {
    TextScanner scanner(tag.attribute(attribute), name());
    if (!scanner.skipSpace()) return numbers;
    for (double& number : numbers) {
      if (scanner.readNumber(number)) continue;
      tags_.fail(ErrorCode::FileSyntax, tag, "expected ", n, " numbers as ", attribute, ", found ",
                 quoted(tag.attribute(attribute)), ".");
    }
    return numbers;
  }

  /// Reads a structured grid, whose cells are implied.
  void readGrid() {
    VtuPiece& piece = pieces_[0];
    const auto extent = readNumbers(piece.tag, "Extent", std::array<double, 6>{});
    GridIndex size{};
    for (std::size_t i = 0; i < 3; ++i) {
      constexpr double kFar = 1e18;  // far beyond what can be read
      size[i] =
          static_cast<std::uint64_t>(std::clamp(extent[2 * i + 1] - extent[2 * i] + 1, 0.0, kFar));
    }
    const std::uint64_t dataSize = largestRatio() * fileSize();
    if (type_ == "ImageData") {
      const auto origin = readNumbers(image_, "Origin", Vec3{});
      const auto spacing = readNumbers(image_, "Spacing", Vec3{1, 1, 1});
      const auto axes =
          readNumbers(image_, "Direction", std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1});
      makeGrid(size, dataSize, [=](std::size_t axis, const GridIndex& point) {
        double place = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          place +=
              axes[3 * axis + i] * spacing[i] * (extent[2 * i] + static_cast<double>(point[i]));
        }
        return place + origin[axis];
      });
    } else if (type_ == "RectilinearGrid") {
      makeGrid(size, dataSize, readAxes(size));
    } else {
      makeGrid(size, dataSize, {});
      piece.points = points;
      coordinates = std::move(columnsOf(VtkSection::Points, {}, "points", VtkNumbers::Reals, 3)[0]);
    }
    arrays.insert(arrays.end(), piece.arrays.begin(), piece.arrays.end());
  }

  /// The coordinates of a rectilinear grid: three arrays, one for each axis.
  std::function<double(std::size_t axis, const GridIndex& point)> readAxes(const GridIndex& size) {
    std::array<std::vector<double>, 3> axes;
    std::size_t axis = 0;
    for (const VtkSourceArray& array : pieces_[0].arrays) {
      if (array.section != VtkSection::Points || axis == axes.size()) continue;
      const VtkColumn column = array.load(array.numbers, size[axis]);
      axes[axis].resize(memorySize(size[axis]));
      copy(column, 0, axes[axis].size(), axes[axis].data());
      ++axis;
    }
    if (axis < axes.size()) {
      fail(ErrorCode::FileSyntax, "the file has ", axis,
           " arrays of coordinates instead of three.");
    }
    return [axes](std::size_t i, const GridIndex& point) { return axes[i][point[i]]; };
  }

  std::uint64_t readCount(const XmlTag& tag, std::string_view attribute) const {
    const std::string_view value = tag.attribute(attribute);
    std::uint64_t count = 0;
    if (!parseInteger(value, count)) {
      tags_.fail(ErrorCode::FileSyntax, tag, "expected a whole number as ", attribute, ", found ",
                 quoted(value), ".");
    }
    requireRoom(count, tag, concat(attribute, " is"));
    return count;
  }

  [[nodiscard]] std::size_t largestRatio() const {
    return encoding_.compressor == nullptr ? 1 : encoding_.compressor->largestRatio;
  }

  /// Each point, cell or number takes at least a byte, which is compressed at most by the ratio.
  /// The bound also keeps products of the count from overflowing.
  void requireRoom(std::uint64_t count, const XmlTag& tag, const std::string& what) const {
    if (count / largestRatio() <= fileSize()) return;
    tags_.fail(ErrorCode::FileSyntax, tag, what, " ", count,
               ", more than the file has room for: it is wrong or the file is incomplete.");
  }

  void readArrayTag(const XmlTag& tag, VtkSection section) {
    VtkSourceArray array;
    array.section = section;
    array.name = tag.attribute("Name");
    // Only the array of points may lack a name; the last one counts.
    if (section != VtkSection::Points && array.name.empty()) return;
    array.numbers = vtkNumbersOf(tag.attribute("type"));
    const std::string_view components = tag.attribute("NumberOfComponents");
    std::from_chars(components.data(), components.data() + components.size(), array.components);
    array.appended = tag.attribute("format") == "appended";
    array.load = [this, tag](VtkNumbers numbers, std::optional<std::uint64_t> count) {
      return loadArray(tag, numbers, count);
    };
    if (section == VtkSection::FieldData) return arrays.push_back(std::move(array));
    if (pieces_.empty()) return;
    const bool ofCells = section == VtkSection::CellData;
    if ((ofCells || section == VtkSection::PointData) && pieces_.size() == 1) {
      see(array.name, ofCells, array.components);
    }
    pieces_.back().arrays.push_back(std::move(array));
  }

  void readAppendedTag(const XmlTag& tag) {
    const std::string_view encoding = tag.attribute("encoding");
    encoding_.base64 = encoding == "base64";
    if (!encoding_.base64 && encoding != "raw") {
      tags_.fail(ErrorCode::FileUnsupported, tag, "the appended data are encoded as ",
                 quoted(encoding), ", which is neither raw nor base64.");
    }
    const std::size_t mark = text().find('_', tag.end);
    if (mark == std::string_view::npos) {
      tags_.fail(ErrorCode::FileSyntax, tag,
                 "the appended data are missing: the file is incomplete.");
    }
    appended_ = mark + 1;
  }

  /// The numbers of a mandatory array, per piece. That of the points may have any name.
  /// @param each  numbers per point or cell; 0: not known
  std::vector<VtkColumn> columnsOf(VtkSection section, std::string_view name, const char* what,
                                   VtkNumbers numbers, std::size_t each) const {
    std::vector<VtkColumn> columns;
    for (const VtuPiece& piece : pieces_) {
      VtkColumn& column = columns.emplace_back();
      if (piece.numbersOf(section, 1) == 0) continue;
      const auto found = std::find_if(
          piece.arrays.rbegin(), piece.arrays.rend(), [&](const VtkSourceArray& array) {
            return array.section == section && (name.empty() || array.name == name);
          });
      if (found == piece.arrays.rend()) {
        fail(ErrorCode::FileSyntax, "the file has no array of ", what, ".");
      }
      std::optional<std::uint64_t> count;
      if (each > 0) count = piece.numbersOf(section, each);
      column = found->load(numbers, count);
    }
    return columns;
  }

  /// Concatenates columns.
  /// @param shifts  offsets added to the integers of each column; empty: none
  VtkColumn joined(std::vector<VtkColumn> columns, VtkNumbers numbers,
                   std::span<const std::uint64_t> shifts = {}) const {
    if (columns.size() == 1) return std::move(columns[0]);
    std::uint64_t count = 0;
    for (const VtkColumn& column : columns) count += column.count;
    requireRoom(count, pieces_.back().tag, "the numbers of one array of all pieces are");
    VtkColumn all = textColumn(numbers, memorySize(count));
    char* to = all.decoded.data();
    for (std::size_t p = 0; p < columns.size(); ++p) {
      const std::size_t size = memorySize(columns[p].count);
      auto* const integers = reinterpret_cast<std::int64_t*>(to);
      if (numbers == VtkNumbers::Reals) {
        copy(columns[p], 0, size, reinterpret_cast<double*>(to));
      } else {
        copy(columns[p], 0, size, integers);
      }
      for (std::size_t i = 0; i < size && !shifts.empty(); ++i) {
        integers[i] += static_cast<std::int64_t>(shifts[p]);
      }
      to += size * sizeof(double);
    }
    return all;
  }

  void readCells() {
    const auto load = [this](std::string_view name, const char* what, std::size_t each) {
      return columnsOf(isPolyData() ? VtkSection::Polys : VtkSection::Cells, name, what,
                       VtkNumbers::Integers, each);
    };
    if (isPolyData()) {
      makePolygons();
    } else {
      types = joined(load("types", "cell types", 1), VtkNumbers::Integers);
    }
    std::vector<VtkColumn> corners = load("connectivity", "cell corners", 0);
    std::vector<std::uint64_t> cornersBefore;
    std::uint64_t cornerCount = 0;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      cornersBefore.push_back(std::exchange(cornerCount, cornerCount + corners[p].count));
      if (pieces_.size() > 1) requireCorners(corners[p], p);
    }
    offsets = joined(load("offsets", "cell offsets", 1), VtkNumbers::Integers, cornersBefore);
    connectivity = joined(std::move(corners), VtkNumbers::Integers, pointsBefore_);
  }

  /// Checks corners against the points of their piece; after joining, they could refer to the next.
  void requireCorners(const VtkColumn& corners, std::size_t p) const {
    Array<std::int64_t> numbers(memorySize(corners.count));
    copy(corners, 0, numbers.size(), numbers.data());
    for (const std::int64_t number : numbers) {
      if (number >= 0 && static_cast<std::uint64_t>(number) < pieces_[p].points) continue;
      tags_.fail(ErrorCode::IndexOutOfRange, pieces_[p].tag, "a cell of this piece names point ",
                 number, ", but its ", pieces_[p].points, " points are numbered from 0.");
    }
  }

  /// Drops empty pieces, which need no arrays; keeps one if all are empty.
  void leaveOutEmpty() {
    const VtuPiece first = pieces_.front();
    std::erase_if(pieces_,
                  [](const VtuPiece& piece) { return piece.points == 0 && piece.cells == 0; });
    if (pieces_.empty()) pieces_.push_back(first);
  }

  /// Joins the arrays that all pieces have. Field arrays are dropped, since they refer to points.
  void joinPieces() {
    arrays.clear();
    joinPoints();
    for (const VtkSourceArray& first : pieces_[0].arrays) {
      std::vector<const VtkSourceArray*> parts;
      for (const VtuPiece& piece : pieces_) {
        for (const VtkSourceArray& array : piece.arrays) {
          const bool same = array.section == first.section && array.name == first.name &&
                            array.components == first.components && array.numbers == first.numbers;
          if (same) {
            parts.push_back(&array);
            break;
          }
        }
      }
      const bool data =
          first.section == VtkSection::PointData || first.section == VtkSection::CellData;
      if (!data || parts.size() < pieces_.size() || first.numbers == VtkNumbers::Others) continue;
      VtkSourceArray& all = arrays.emplace_back(first);
      all.appended = false;
      all.load = [this, parts](VtkNumbers numbers, std::optional<std::uint64_t> /*count*/) {
        std::vector<VtkColumn> columns;
        for (std::size_t p = 0; p < parts.size(); ++p) {
          columns.push_back(parts[p]->load(
              numbers, pieces_[p].numbersOf(parts[p]->section, parts[p]->components)));
        }
        VtkColumn column = joined(std::move(columns), numbers);
        if (parts[0]->section == VtkSection::PointData) keep(column, kept_, parts[0]->components);
        return column;
      };
    }
    leaveOutGhosts();
  }

  /// Keeps these rows, ascending, of a column of 64-bit numbers.
  static void keep(VtkColumn& column, const Array<std::size_t>& rows, std::size_t components) {
    const std::size_t size = components * sizeof(double);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      std::memmove(column.decoded.data() + size * i, column.decoded.data() + size * rows[i], size);
    }
    column.count = components * rows.size();
  }

  void joinPoints() {
    const std::vector<std::size_t> firstPoints(pointsBefore_.begin(), pointsBefore_.end());
    Array<std::size_t> firsts = firstsAtSamePosition(
        {reinterpret_cast<const double*>(coordinates.decoded.data()), memorySize(3 * points)},
        firstPoints);
    for (std::size_t i = 0; i < firsts.size(); ++i) {
      if (firsts[i] == i) kept_.push_back(i);
      firsts[i] = firsts[i] == i ? kept_.size() - 1 : firsts[firsts[i]];
    }
    auto* const corners = reinterpret_cast<std::int64_t*>(connectivity.decoded.data());
    for (std::size_t i = 0; i < connectivity.count; ++i) {
      corners[i] = static_cast<std::int64_t>(firsts[static_cast<std::size_t>(corners[i])]);
    }
    keep(coordinates, kept_, 3);
    points = kept_.size();
  }

  /// Turns cells that another piece owns into VTK's empty cells.
  void leaveOutGhosts() {
    const VtkSourceArray* const ghosts =
        find(VtkSection::CellData, kVtkGhosts, 1, VtkNumbers::Integers);
    if (ghosts == nullptr || cells == 0) return;
    const VtkColumn marks = load(*ghosts);
    const auto* const mark = reinterpret_cast<const std::int64_t*>(marks.decoded.data());
    auto* const type = reinterpret_cast<std::int64_t*>(types.decoded.data());
    for (std::size_t i = 0; i < cells; ++i) {
      if ((mark[i] & kVtkDuplicate) != 0) type[i] = 0;
    }
  }

  /// The numbers of an array, exactly `count` if that is known.
  VtkColumn loadArray(const XmlTag& tag, VtkNumbers numbers,
                      std::optional<std::uint64_t> count) const {
    const std::string_view format = tag.attribute("format");
    if (format == "ascii") {  // for strings, the codes of characters
      return parse(tag, numbers == VtkNumbers::Others ? VtkNumbers::Integers : numbers, count);
    }
    if (format != "appended" && format != "binary") {
      tags_.fail(ErrorCode::FileUnsupported, tag, "the data format ", quoted(format),
                 " is none of appended, binary and ascii.");
    }
    const std::string_view type = tag.attribute("type");
    const VtkScalar* const scalar = lookUp(kScalars, type);
    if (scalar == nullptr || vtkNumbersOf(type) != numbers) {
      tags_.fail(ErrorCode::FileUnsupported, tag, "the number type ", quoted(type),
                 " is not supported for this array.");
    }
    VtkColumn column;
    column.scalar = *scalar;
    column.bigEndian = encoding_.bigEndian;
    std::uint64_t bytes = 0;
    if (format == "appended" && !encoding_.base64 && encoding_.compressor == nullptr) {
      bytes = findAppended(tag, column);
    } else {
      column.decoded = decode(tag);
      bytes = column.decoded.size();
    }
    column.count = bytes / bytesOf(column.scalar);
    if (count && column.count != *count) {
      tags_.fail(ErrorCode::FileSyntax, tag, "this array should hold ", *count,
                 " numbers, but it holds ", column.count, ".");
    }
    return column;
  }

  /// Locates an array that is appended raw.
  /// @return its size in bytes
  std::uint64_t findAppended(const XmlTag& tag, VtkColumn& column) const {
    const std::uint64_t offset = readCount(tag, "offset");
    const std::uint64_t room = appended_ ? fileSize() - *appended_ : 0;
    const std::size_t lengthBytes = encoding_.lengthBytes;
    if (offset <= room && room - offset >= lengthBytes) {
      VtkColumn length;
      length.scalar = lengthBytes == sizeof(std::uint64_t) ? VtkScalar(std::uint64_t{})
                                                           : VtkScalar(std::uint32_t{});
      length.bigEndian = encoding_.bigEndian;
      length.position = *appended_ + offset;
      std::int64_t bytes = 0;
      copy(length, 0, 1, &bytes);
      column.position = length.position + lengthBytes;
      if (static_cast<std::uint64_t>(bytes) <= room - offset - lengthBytes) {
        return static_cast<std::uint64_t>(bytes);
      }
    }
    tags_.fail(ErrorCode::FileSyntax, tag,
               "the data of this array lie beyond the end of the file: it is incomplete.");
  }

  /// The bytes of an array that is compressed, or base64, inline or appended.
  Array<char> decode(const XmlTag& tag) const {
    std::string_view encoded = contentOf(tag);
    VtuEncoding encoding = encoding_;
    encoding.base64 = true;
    if (tag.attribute("format") == "appended") {
      const std::uint64_t offset = readCount(tag, "offset");
      const std::uint64_t room = appended_ ? text().size() - *appended_ : 0;
      if (offset > room) {
        tags_.fail(ErrorCode::FileSyntax, tag,
                   "the data of this array lie beyond the end of the file: it is incomplete.");
      }
      encoded = text().substr(appended_ ? *appended_ + offset : text().size());
      encoding.base64 = encoding_.base64;
    }
    if (encoding.compressor == &kCompressors[0]) {
      requireZlib(name(), "read compressed arrays", "save the file without compression");
    }
    if (encoding.compressor == &kCompressors[2]) requireLzma(name());
    return decodeVtuArray(encoded, encoding, stage_, [&](const char* sentence) {
      tags_.fail(ErrorCode::FileSyntax, tag, sentence);
    });
  }

  /// Parses the numbers of a text; without a count, all there are.
  VtkColumn parse(const XmlTag& tag, VtkNumbers numbers, std::optional<std::uint64_t> count) const {
    // The scanner views the file from its beginning, so that line numbers are right, and ends at
    // the next tag. A number takes at least two bytes with its separator.
    const std::string_view content = contentOf(tag);
    TextScanner scanner = tags_.scannerTo(tag.end + content.size());
    scanner.moveTo(tag.end);
    const std::size_t room = content.size() / 2 + 1;
    if (count && *count > room) {
      tags_.fail(ErrorCode::FileSyntax, tag, "this array should hold ", *count,
                 " numbers, but there is only room for ", room, ".");
    }
    VtkColumn column = textColumn(numbers, count ? *count : room);
    const std::string_view what = numbers == VtkNumbers::Reals ? "a number" : "a whole number";
    column.count = 0;
    while (count ? column.count < *count : scanner.skipSpace()) {
      readVtkNumber(scanner, numbers, column, column.count++, what);
    }
    if (scanner.skipSpace()) scanner.failToken("the end of the array");
    return column;
  }

  std::string_view contentOf(const XmlTag& tag) const {
    return text().substr(tag.end, std::min(text().find('<', tag.end), text().size()) - tag.end);
  }

  Stage& stage_;
  XmlTags tags_;
  bool hasFileTag_ = false;
  std::string_view type_;  ///< of the data set
  XmlTag image_;           ///< the tag ImageData
  std::vector<VtuPiece> pieces_;
  Array<std::size_t> kept_;  ///< of several pieces: points without an earlier duplicate
  std::vector<std::uint64_t> pointsBefore_;  ///< per piece: points before it
  VtuEncoding encoding_;                     ///< of appended arrays
  std::optional<std::uint64_t> appended_;    ///< position after the '_' of AppendedData
};

/// Whether a text, possibly incomplete, begins with a complete header followed by raw appended
/// arrays; empty if the end of the header is not in the text.
std::optional<bool> isPlainHead(std::string_view text) {
  const std::size_t tag = text.find("<AppendedData");
  const std::size_t mark = tag == std::string_view::npos ? tag : text.find('_', tag);
  if (mark == std::string_view::npos) return {};
  return text.find("compressor=") == std::string_view::npos &&
         text.substr(tag, mark - tag).find("base64") == std::string_view::npos;
}

/// The header of a regular file with raw appended arrays; empty for other files.
Array<char> readPlainHead(const InputFile& input) {
  // How much of a file is searched for the end of its header: at first, and at most. A header takes
  // a few kilobytes; a longer one contains arrays as text.
  constexpr std::size_t kFirst = std::size_t{1} << 16;
  constexpr std::size_t kMost = std::size_t{1} << 24;
  Array<char> bytes;
  if (!input.isRegular()) return bytes;
  for (std::size_t most = kFirst; most <= kMost; most *= 4) {
    bytes.resize(std::min<std::uint64_t>(most, input.size()));
    input.readAt(0, bytes.data(), bytes.size());
    if (const std::optional<bool> plain = isPlainHead(asText(bytes))) {
      if (*plain) return bytes;
      break;
    }
    if (bytes.size() == input.size()) break;
  }
  return {};
}

}  // namespace

std::unique_ptr<VtkSource> openVtuFile(const Input& input, Stage& stage) {
  VtkFileBytes bytes;
  if (!input.bytes()) {
    bytes.file = std::make_unique<InputFile>(input.path());
    bytes.room = readPlainHead(*bytes.file);
    bytes.text = asText(bytes.room);
  }
  if (bytes.text.empty()) {
    bytes.file.reset();
    bytes.text = input.text(bytes.room, stage, kXmlFirst);
  }
  auto file = std::make_unique<VtuFile>(std::move(bytes), input.name(), stage);
  file->counts = input.counts();
  file->others = input.others();
  return file;
}

}  // namespace hexhex::io
