// The reading half of vtk_legacy.hpp. Integers go through a plain array, as text and bytes, old and
// new layouts differ in nothing but how they fill it.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/cell_mesh.hpp>
#include <io/finite_points.hpp>
#include <io/grid_map.hpp>
#include <io/ovm_first_fault.hpp>
#include <io/ovmb_bytes.hpp>
#include <io/read_with.hpp>
#include <io/text_elements.hpp>
#include <io/text_scanner.hpp>
#include <io/token_index.hpp>
#include <io/vtk_legacy.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 14;

/// VTK's keywords and type names come in any letter case.
std::string lowerCase(std::string_view token) {
  std::string result(token);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

/// VTK writes characters of names that separate tokens as "%20".
std::string nameOf(std::string_view token) {
  std::string name;
  for (std::size_t i = 0; i < token.size(); ++i) {
    unsigned code = 0;
    const char* const digits = token.data() + i + 1;
    const bool coded = token[i] == '%' && token.size() - i > 2 &&
                       std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
    name += coded ? static_cast<char>(code) : token[i];
    if (coded) i += 2;
  }
  return name;
}

enum class Kind : std::uint8_t { Float, Signed, Unsigned, Bits, Text };

/// A type of numbers.
struct NumberType {
  std::string_view name;
  Kind kind;
  std::size_t bytes;
};

constexpr std::array<NumberType, 16> kTypes = {{{"double", Kind::Float, 8},
                                                {"float", Kind::Float, 4},
                                                {"int", Kind::Signed, 4},
                                                {"vtktypeint64", Kind::Signed, 8},
                                                {"vtkidtype", Kind::Signed, 4},
                                                {"vtktypeint32", Kind::Signed, 4},
                                                {"long", Kind::Signed, 8},
                                                {"unsigned_int", Kind::Unsigned, 4},
                                                {"unsigned_long", Kind::Unsigned, 8},
                                                {"vtktypeuint64", Kind::Unsigned, 8},
                                                {"short", Kind::Signed, 2},
                                                {"unsigned_short", Kind::Unsigned, 2},
                                                {"char", Kind::Signed, 1},
                                                {"unsigned_char", Kind::Unsigned, 1},
                                                {"bit", Kind::Bits, 0},
                                                {"string", Kind::Text, 0}}};

constexpr NumberType kInt = {"int", Kind::Signed, 4};
constexpr NumberType kFloat = {"float", Kind::Float, 4};
constexpr NumberType kByte = {"unsigned_char", Kind::Unsigned, 1};

/// Where the corners of a cell are.
struct CellCorners {
  std::size_t begin;
  std::size_t count;
};

/// Numbers of legacy files are stored with the largest byte first.
template <class T>
T loadBig(const char* place) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;
  static_assert(sizeof(T) == sizeof(Bits));
  Bits bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {  // compilers make one instruction of it
    bits = bits << 8U | static_cast<unsigned char>(place[i]);
  }
  return std::bit_cast<T>(bits);
}

/// Reads one file from top to bottom.
template <std::size_t corners>
class VtkReader {
 public:
  /// @param mapArray  the name of the map's array; empty: arrays are not read
  VtkReader(std::string_view text, const std::string& fileName, Stage& stage,
            std::string_view mapArray = {})
      : text_(text), scanner_(text, fileName), stage_(stage), mapArray_(mapArray) {}

  Grid<corners> read();

 private:
  static constexpr CellKind kKind = kCellKind<corners>;

  void readHead();
  [[nodiscard]] std::string_view takeLine();
  void readKeyword(const std::string& keyword);
  void readPoints();
  void readCells();
  void readOldCells(std::size_t cells, std::size_t numbers);
  void readNewCells(std::size_t places, std::size_t numbers);
  [[nodiscard]] bool takePlainCells(std::size_t cells);
  void splitCells(std::size_t numbers);
  void splitPlainCells();
  void readTypes();
  [[nodiscard]] bool takePlainTypes(std::size_t count);
  void skipNumbers(std::size_t count, const NumberType& type);
  void skipMetadata();
  void takeCells();
  void copyPlainCells();
  void readRegions();
  void readAttribute(const std::string& keyword);
  void beginArrays(bool ofCells);
  void readScalars(std::string_view name, std::size_t elements);
  void readField();
  void readArray(std::string_view name, std::size_t components, std::size_t tuples,
                 const NumberType& type);
  [[nodiscard]] Array<double> readReals(std::size_t count, const NumberType& type,
                                        const char* what);
  [[nodiscard]] bool takeCell(std::size_t cell, std::array<Index, corners>& corner) const;
  [[noreturn]] void failAbout(std::size_t cell, std::size_t count) const;

  const NumberType& readType();
  void skipLineBreak();
  /// The bytes of so many numbers.
  [[nodiscard]] const char* takeBytes(std::size_t count, std::size_t bytesEach);
  [[nodiscard]] Array<std::int64_t> readIntegers(std::size_t count, const NumberType& type,
                                                 const char* what);
  void failIfRepeated(bool present, const char* keyword);

  std::string_view text_;
  TextScanner scanner_;
  std::optional<TokenIndex> index_;  ///< only of text
  Stage& stage_;
  bool binary_ = false;
  bool hasPoints_ = false;
  bool hasCells_ = false;
  bool hasTypes_ = false;
  std::size_t cellCount_ = 0;
  /// The usual bytes: each cell has as many corners as are wanted. Null otherwise.
  const char* plainCells_ = nullptr;
  bool plainTypes_ = false;  ///< all cells are of the kind that is wanted
  Array<std::int64_t> corners_;
  Array<CellCorners> cells_;
  Array<std::int64_t> types_;
  std::string_view mapArray_;
  bool arraysOfCells_ = false;  ///< whether arrays belong to cells or to points
  CellMesh<corners> mesh_;
  Grid<corners> grid_;
};

template <std::size_t corners>
Grid<corners> VtkReader<corners>::read() {
  readHead();
  // What follows the three sections are arrays.
  while (!(hasPoints_ && hasCells_ && hasTypes_) && scanner_.skipSpace()) {
    readKeyword(lowerCase(scanner_.readToken()));
  }
  const auto require = [this](bool present, const char* keyword) {
    if (present) return;
    scanner_.fail(ErrorCode::FileSyntax, "the file ends without the section " +
                                             std::string(keyword) + ": it is incomplete.");
  };
  require(hasPoints_, "POINTS");
  require(hasCells_, "CELLS");
  require(hasTypes_, "CELL_TYPES");
  takeCells();
  if (corners == 8) readRegions();
  while (!mapArray_.empty() && !grid_.map && scanner_.skipSpace()) {
    readAttribute(lowerCase(scanner_.readToken()));
  }
  grid_.mesh = std::move(mesh_);
  return std::move(grid_);
}

template <std::size_t corners>
void VtkReader<corners>::readHead() {
  constexpr std::string_view kMagic = "# vtk DataFile Version ";
  if (!takeLine().starts_with(kMagic)) {
    scanner_.moveTo(0);
    scanner_.fail(
        ErrorCode::FileSyntax,
        "a .vtk file begins with \"# vtk DataFile Version\". If it is XML, name it .vtu.");
  }
  static_cast<void>(takeLine());  // a title, which may be anything
  const std::string encoding = lowerCase(scanner_.readToken());
  binary_ = encoding == "binary";
  if (!binary_ && encoding != "ascii") {
    scanner_.fail(ErrorCode::FileSyntax, "expected \"ASCII\" or \"BINARY\", found " +
                                             quoted(scanner_.currentToken()) + ".");
  }
  const std::string dataset = lowerCase(scanner_.readToken());
  if (dataset != "dataset") {
    scanner_.fail(ErrorCode::FileSyntax,
                  "expected \"DATASET\", found " + quoted(scanner_.currentToken()) + ".");
  }
  if (lowerCase(scanner_.readToken()) != "unstructured_grid") {
    scanner_.fail(ErrorCode::FileUnsupported, "the data set must be an UNSTRUCTURED_GRID, found " +
                                                  quoted(scanner_.currentToken()) + ".");
  }
  if (!binary_) index_.emplace(text_, stage_);
}

template <std::size_t corners>
std::string_view VtkReader<corners>::takeLine() {
  const std::size_t begin = scanner_.position();
  const std::size_t end = std::min(text_.find('\n', begin), text_.size());
  scanner_.moveTo(std::min(end + 1, text_.size()));
  return text_.substr(begin, end - begin);
}

template <std::size_t corners>
void VtkReader<corners>::readKeyword(const std::string& keyword) {
  if (keyword == "points") return readPoints();
  if (keyword == "cells") return readCells();
  if (keyword == "cell_types") return readTypes();
  if (keyword == "field") return readField();
  if (keyword == "metadata") return skipMetadata();
  scanner_.fail(ErrorCode::FileSyntax, "expected POINTS, CELLS or CELL_TYPES, found " +
                                           quoted(scanner_.currentToken()) + ".");
}

template <std::size_t corners>
void VtkReader<corners>::failIfRepeated(bool present, const char* keyword) {
  if (!present) return;
  scanner_.fail(ErrorCode::FileSyntax,
                "the section " + std::string(keyword) + " occurs a second time.");
}

template <std::size_t corners>
const NumberType& VtkReader<corners>::readType() {
  const std::string name = lowerCase(scanner_.readToken());
  const auto* const found = std::find_if(kTypes.begin(), kTypes.end(),
                                         [&](const NumberType& type) { return type.name == name; });
  if (found != kTypes.end()) return *found;
  scanner_.fail(ErrorCode::FileSyntax, "expected a type of numbers, e.g. double, found " +
                                           quoted(scanner_.currentToken()) + ".");
}

template <std::size_t corners>
void VtkReader<corners>::skipLineBreak() {
  std::size_t place = scanner_.position();
  while (place < text_.size() && (text_[place] == ' ' || text_[place] == '\r')) ++place;
  if (place == text_.size() || text_[place] != '\n') {
    scanner_.fail(ErrorCode::FileSyntax,
                  "the line has to end behind " + quoted(scanner_.currentToken()) +
                      ", since the bytes of numbers begin on the next line.");
  }
  scanner_.moveTo(place + 1);
}

template <std::size_t corners>
const char* VtkReader<corners>::takeBytes(std::size_t count, std::size_t bytesEach) {
  const std::size_t left = text_.size() - scanner_.position();
  if (bytesEach > 0 && count > left / bytesEach) {
    scanner_.fail(ErrorCode::FileSyntax,
                  std::to_string(count) + " numbers of " + std::to_string(bytesEach) +
                      " bytes are announced, but only " + std::to_string(left) +
                      " bytes are left: the file is incomplete.");
  }
  const char* const bytes = text_.data() + scanner_.position();
  scanner_.moveTo(scanner_.position() + count * bytesEach);
  return bytes;
}

template <std::size_t corners>
void VtkReader<corners>::readPoints() {
  failIfRepeated(hasPoints_, "POINTS");
  hasPoints_ = true;
  const std::size_t count = scanner_.readCount("points", 6);
  const NumberType& type = readType();
  if (type.kind != Kind::Float) {
    scanner_.fail(ErrorCode::FileUnsupported, "the coordinates of points must be float or double.");
  }
  if (!binary_) {
    mesh_.points.resize(count);
    readElements(scanner_, &*index_, stage_, count, 3, [this](TextScanner& scanner, std::size_t i) {
      for (double& coordinate : mesh_.points[i]) {
        if (scanner.readNumber(coordinate)) continue;
        scanner.failNumber("a coordinate of point " + std::to_string(i));
      }
    });
    return;
  }
  skipLineBreak();
  const std::size_t begin = scanner_.position();
  const char* const bytes = takeBytes(3 * count, type.bytes);
  mesh_.points.resize(count);
  parallelFor(stage_, count, kGrain, [&](std::size_t i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const char* const place = bytes + (3 * i + k) * type.bytes;
      mesh_.points[i][k] = type.bytes == 8 ? loadBig<double>(place) : loadBig<float>(place);
    }
  });
  const std::size_t wrong = firstNotFinite(mesh_.points, stage_);
  if (wrong == count) return;
  throw Error(ErrorCode::NotFinite,
              scanner_.fileName() + ", byte " + std::to_string(begin + 3 * wrong * type.bytes) +
                  ": a coordinate of point " + std::to_string(wrong) + " is not finite.",
              Place{PlaceKind::Vertex, wrong});
}

template <std::size_t corners>
Array<std::int64_t> VtkReader<corners>::readIntegers(std::size_t count, const NumberType& type,
                                                     const char* what) {
  const std::size_t bytesEach = type.bytes;
  if (type.kind != Kind::Signed || bytesEach < 4) {
    scanner_.fail(ErrorCode::FileUnsupported, std::string(what) + " cannot be of type " +
                                                  std::string(type.name) +
                                                  ", only int or vtktypeint64.");
  }
  Array<std::int64_t> numbers;
  if (binary_) {
    skipLineBreak();
    const char* const bytes = takeBytes(count, bytesEach);
    numbers.resize(count);
    parallelFor(stage_, count, kGrain, [&](std::size_t i) {
      const char* const place = bytes + i * bytesEach;
      numbers[i] = bytesEach == 8 ? loadBig<std::int64_t>(place) : loadBig<std::int32_t>(place);
    });
    return numbers;
  }
  numbers.resize(count);
  readElements(scanner_, &*index_, stage_, count, 1, [&](TextScanner& scanner, std::size_t i) {
    if (!scanner.readInteger(numbers[i])) scanner.failInteger(what);
  });
  return numbers;
}

template <std::size_t corners>
void VtkReader<corners>::readCells() {
  failIfRepeated(hasCells_, "CELLS");
  hasCells_ = true;
  // Counted as numbers of one digit or four bytes.
  const std::size_t first = scanner_.readCount("cells", 2);
  const std::size_t second = scanner_.readCount("numbers of cells", 2);
  const std::size_t before = scanner_.position();
  if (lowerCase(scanner_.readToken()) == "offsets") return readNewCells(first, second);
  scanner_.moveTo(before);
  readOldCells(first, second);
}

/// Up to version 4: each cell is its number of corners, and its corners.
template <std::size_t corners>
void VtkReader<corners>::readOldCells(std::size_t cells, std::size_t numbers) {
  cellCount_ = cells;
  if (binary_ && numbers == (corners + 1) * cells && takePlainCells(cells)) return;
  corners_ = readIntegers(numbers, kInt, "a corner of a cell");
  splitCells(numbers);
}

/// Whether all cells have as many corners as are wanted, so that they need not be looked at one by
/// one. If not, nothing was read.
template <std::size_t corners>
bool VtkReader<corners>::takePlainCells(std::size_t cells) {
  const std::size_t before = scanner_.position();
  skipLineBreak();
  const char* const bytes = takeBytes((corners + 1) * cells, kInt.bytes);
  const std::size_t fault = firstFault(stage_, cells, [&](std::size_t i) {
    return loadBig<std::int32_t>(bytes + kInt.bytes * (corners + 1) * i) ==
           static_cast<std::int32_t>(corners);
  });
  if (fault < cells) {
    scanner_.moveTo(before);
    return false;
  }
  plainCells_ = bytes;
  return true;
}

/// Finds out where the corners of each cell are.
template <std::size_t corners>
void VtkReader<corners>::splitCells(std::size_t numbers) {
  const std::size_t cells = cellCount_;
  cells_.resize(cells);
  std::size_t place = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::int64_t count = place < numbers ? corners_[place] : -1;
    if (count < 0 || static_cast<std::uint64_t>(count) > numbers - place - 1) {
      scanner_.fail(ErrorCode::FileSyntax,
                    "cell " + std::to_string(cell) + " of " + std::to_string(cells) +
                        " goes beyond the " + std::to_string(numbers) +
                        " numbers that the section CELLS announces.",
                    Place{PlaceKind::Cell, cell});
    }
    cells_[cell] = {place + 1, static_cast<std::size_t>(count)};
    place += 1 + static_cast<std::size_t>(count);
  }
}

/// From version 5 on: where cells begin and the last one ends, and all corners.
template <std::size_t corners>
void VtkReader<corners>::readNewCells(std::size_t places, std::size_t numbers) {
  const Array<std::int64_t> begins = readIntegers(places, readType(), "an offset of a cell");
  if (lowerCase(scanner_.readToken()) != "connectivity") {
    scanner_.fail(ErrorCode::FileSyntax,
                  "expected \"CONNECTIVITY\", found " + quoted(scanner_.currentToken()) + ".");
  }
  corners_ = readIntegers(numbers, readType(), "a corner of a cell");
  cells_.resize(std::max<std::size_t>(places, 1) - 1);
  cellCount_ = cells_.size();
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    const std::int64_t begin = begins[cell];
    const std::int64_t end = begins[cell + 1];
    if (begin < 0 || end < begin || static_cast<std::uint64_t>(end) > numbers) {
      scanner_.fail(ErrorCode::FileSyntax,
                    "the corners of cell " + std::to_string(cell) + " lie from " +
                        std::to_string(begin) + " to " + std::to_string(end) + " of the " +
                        std::to_string(numbers) + " corners, which cannot be.",
                    Place{PlaceKind::Cell, cell});
    }
    cells_[cell] = {static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)};
  }
}

/// Whether all cells are of the kind that is wanted. If not, nothing was read.
template <std::size_t corners>
bool VtkReader<corners>::takePlainTypes(std::size_t count) {
  const std::size_t before = scanner_.position();
  skipLineBreak();
  const char* const bytes = takeBytes(count, kInt.bytes);
  plainTypes_ = firstFault(stage_, count, [&](std::size_t i) {
                  return loadBig<std::int32_t>(bytes + kInt.bytes * i) == kKind.vtkType;
                }) == count;
  if (!plainTypes_) scanner_.moveTo(before);
  return plainTypes_;
}

template <std::size_t corners>
void VtkReader<corners>::readTypes() {
  failIfRepeated(hasTypes_, "CELL_TYPES");
  hasTypes_ = true;
  const std::size_t count = scanner_.readCount("types of cells", 2);
  if (binary_ && count == cellCount_ && takePlainTypes(count)) return;
  types_ = readIntegers(count, kInt, "the type of a cell");
}

template <std::size_t corners>
void VtkReader<corners>::skipNumbers(std::size_t count, const NumberType& type) {
  if (!binary_) {
    scanner_.moveTo(index_->find(index_->countBefore(scanner_.position()) + count));
    return;
  }
  if (type.kind == Kind::Text) {
    scanner_.fail(ErrorCode::FileUnsupported,
                  "an array of strings has no known length in bytes; save the file without it.");
  }
  skipLineBreak();
  const bool bits = type.kind == Kind::Bits;
  static_cast<void>(takeBytes(bits ? (count + 7) / 8 : count, bits ? 1 : type.bytes));
}

/// Skips lines up to an empty one.
template <std::size_t corners>
void VtkReader<corners>::skipMetadata() {
  static_cast<void>(takeLine());
  while (scanner_.position() < text_.size()) {
    const std::string_view line = takeLine();
    if (line.empty() || line == "\r") return;
  }
}

template <std::size_t corners>
void VtkReader<corners>::takeCells() {
  if (plainTypes_ && hasCells_ && plainCells_ != nullptr) return copyPlainCells();
  if (plainCells_ != nullptr) splitPlainCells();
  if (plainTypes_) types_.assign(cellCount_, kKind.vtkType);
  if (types_.size() != cells_.size()) {
    scanner_.fail(ErrorCode::FileSyntax, "the file has " + std::to_string(cells_.size()) +
                                             " cells but " + std::to_string(types_.size()) +
                                             " types of cells.");
  }
  Array<std::size_t>& wanted = grid_.cellInFile;
  for (std::size_t cell = 0; cell < types_.size(); ++cell) {
    if (types_[cell] == kKind.vtkType) wanted.push_back(cell);
  }
  if (wanted.empty() && !types_.empty()) {
    throw Error(ErrorCode::FileUnsupported, scanner_.fileName() + ": the file holds no " +
                                                std::string(kKind.plural) + " (cells of type " +
                                                std::to_string(kKind.vtkType) +
                                                "), but other cells only.");
  }
  mesh_.cells.resize(wanted.size());
  std::atomic<std::size_t> firstWrong{wanted.size()};
  parallelFor(stage_, wanted.size(), kGrain, [&](std::size_t i) {
    if (takeCell(wanted[i], mesh_.cells[i])) return;
    std::size_t known = firstWrong.load(std::memory_order_relaxed);
    while (i < known && !firstWrong.compare_exchange_weak(known, i)) {
    }
  });
  if (firstWrong < wanted.size()) failAbout(wanted[firstWrong], cells_[wanted[firstWrong]].count);
}

/// Cells without anything special.
template <std::size_t corners>
void VtkReader<corners>::copyPlainCells() {
  const std::uint64_t points = mesh_.points.size();
  mesh_.cells.resize(cellCount_);
  const std::size_t fault = firstFault(stage_, cellCount_, [&](std::size_t i) {
    const char* const place = plainCells_ + kInt.bytes * ((corners + 1) * i + 1);
    Index largest = 0;  // a negative number is a large one here
    for (std::size_t k = 0; k < corners; ++k) {
      mesh_.cells[i][k] = loadBig<Index>(place + kInt.bytes * k);
      largest = std::max(largest, mesh_.cells[i][k]);
    }
    return largest < points;
  });
  if (fault < cellCount_) failAbout(fault, corners);
}

/// Cells that are plain but for their types.
template <std::size_t corners>
void VtkReader<corners>::splitPlainCells() {
  const std::size_t numbers = (corners + 1) * cellCount_;
  corners_.resize(numbers);
  parallelFor(stage_, numbers, kGrain, [&](std::size_t i) {
    corners_[i] = loadBig<std::int32_t>(plainCells_ + kInt.bytes * i);
  });
  splitCells(numbers);
}

/// Whether the cell has all corners, which are points.
template <std::size_t corners>
bool VtkReader<corners>::takeCell(std::size_t cell, std::array<Index, corners>& corner) const {
  if (cells_[cell].count != corners) return false;
  for (std::size_t k = 0; k < corners; ++k) {
    const auto vertex = static_cast<std::uint64_t>(corners_[cells_[cell].begin + k]);
    if (vertex >= mesh_.points.size()) return false;
    corner[k] = static_cast<Index>(vertex);
  }
  return true;
}

template <std::size_t corners>
void VtkReader<corners>::failAbout(std::size_t cell, std::size_t count) const {
  const std::string name = scanner_.fileName() + ": cell " + std::to_string(cell);
  const Place place{PlaceKind::Cell, cell};
  if (count != corners) {
    throw Error(ErrorCode::FileSyntax,
                name + " is a " + std::string(kKind.singular) + " with " + std::to_string(count) +
                    " instead of " + std::to_string(corners) + " corners.",
                place);
  }
  throw Error(ErrorCode::IndexOutOfRange,
              name + " names a point that does not exist: the file has " +
                  std::to_string(mesh_.points.size()) + " points, numbered from 0.",
              place);
}

/// Reads the regions of hexahedra if they follow as this library writes them.
template <std::size_t corners>
void VtkReader<corners>::readRegions() {
  const std::string begin =
      "CELL_DATA " + std::to_string(cellCount_) + "\nSCALARS region int 1\nLOOKUP_TABLE default";
  if (!scanner_.skipSpace() || mesh_.cells.size() != cellCount_ ||
      !text_.substr(scanner_.position()).starts_with(begin)) {
    return;
  }
  scanner_.moveTo(scanner_.position() + begin.size());
  const Array<std::int64_t> numbers = readIntegers(cellCount_, kInt, "a region");
  mesh_.regions.resize(numbers.size());
  const std::size_t fault = firstFault(stage_, numbers.size(), [&](std::size_t i) {
    mesh_.regions[i] = static_cast<std::int32_t>(numbers[i]);
    return std::in_range<std::int32_t>(numbers[i]);
  });
  if (fault == numbers.size()) return;
  scanner_.fail(ErrorCode::FileUnsupported,
                "the region " + std::to_string(numbers[fault]) + " does not fit into 32 bits.",
                Place{PlaceKind::Cell, fault});
}

/// Reads one array, or the beginning of the arrays of points or cells.
template <std::size_t corners>
void VtkReader<corners>::readAttribute(const std::string& keyword) {
  if (keyword == "metadata") return skipMetadata();
  if (keyword == "field") return readField();
  if (keyword == "point_data" || keyword == "cell_data") return beginArrays(keyword == "cell_data");
  const std::string_view name = scanner_.readToken();
  const std::size_t elements = arraysOfCells_ ? cellCount_ : mesh_.points.size();
  const auto array = [&](std::size_t components, const NumberType& type) {
    readArray(name, components, elements, type);
  };
  if (keyword == "scalars") return readScalars(name, elements);
  if (keyword == "vectors" || keyword == "normals") return array(3, readType());
  if (keyword == "tensors") return array(9, readType());
  if (keyword == "tensors6") return array(6, readType());
  if (keyword == "global_ids" || keyword == "pedigree_ids") return array(1, readType());
  if (keyword == "texture_coordinates") {
    const std::size_t components = scanner_.readCount("components", 1);
    return array(components, readType());
  }
  if (keyword == "color_scalars") {
    return array(scanner_.readCount("components", 1), binary_ ? kByte : kFloat);
  }
  if (keyword == "lookup_table") {
    return skipNumbers(4 * scanner_.readCount("colours", 4), binary_ ? kByte : kFloat);
  }
  scanner_.fail(ErrorCode::FileSyntax, "expected a keyword of point or cell data, found " +
                                           quoted(std::string_view(keyword)) + ".");
}

template <std::size_t corners>
void VtkReader<corners>::beginArrays(bool ofCells) {
  arraysOfCells_ = ofCells;
  std::int64_t count = 0;
  if (!scanner_.readInteger(count)) scanner_.failInteger("the number of values");
  const std::size_t expected = ofCells ? cellCount_ : mesh_.points.size();
  if (count >= 0 && static_cast<std::uint64_t>(count) == expected) return;
  scanner_.fail(ErrorCode::FileSyntax, "the arrays are for " + std::to_string(count) +
                                           (ofCells ? " cells" : " points") +
                                           ", but the file has " + std::to_string(expected) + ".");
}

/// "SCALARS name type components", where the last may be missing, and the name of a table of
/// colours.
template <std::size_t corners>
void VtkReader<corners>::readScalars(std::string_view name, std::size_t elements) {
  const NumberType& type = readType();
  std::size_t components = 1;
  const std::string_view next = scanner_.peekToken();
  if (lowerCase(next) != "lookup_table") components = scanner_.readCount("components", 1);
  if (lowerCase(scanner_.peekToken()) == "lookup_table") {
    scanner_.readToken();
    scanner_.readToken();
  }
  readArray(name, components, elements, type);
}

template <std::size_t corners>
void VtkReader<corners>::readField() {
  scanner_.readToken();
  const std::size_t arrays = scanner_.readCount("arrays", 8);
  for (std::size_t i = 0; i < arrays && !grid_.map; ++i) {
    if (lowerCase(scanner_.peekToken()) == "metadata") {
      scanner_.readToken();
      skipMetadata();
    }
    const std::string_view name = scanner_.readToken();
    const std::size_t components = scanner_.readCount("components", 1);
    const std::size_t tuples = scanner_.readCount("tuples", 1);
    readArray(name, components, tuples, readType());
  }
}

/// Reads the numbers of an array if it is the map, and skips them otherwise.
template <std::size_t corners>
void VtkReader<corners>::readArray(std::string_view name, std::size_t components,
                                   std::size_t tuples, const NumberType& type) {
  if (components > 0 && tuples > text_.size() / components) {
    scanner_.fail(ErrorCode::FileSyntax, "an array has more numbers than the file has bytes.");
  }
  grid_.arrays.push_back(describeArray(name, arraysOfCells_, components));
  const std::size_t elements = arraysOfCells_ ? cellCount_ : mesh_.points.size();
  const std::size_t wanted = arraysOfCells_ ? kCellMapComponents : kPointMapComponents;
  const std::size_t count = components * tuples;
  if (!(hasPoints_ && hasCells_ && hasTypes_) || nameOf(name) != mapArray_ ||
      components != wanted || tuples != elements || type.kind != Kind::Float) {
    return skipNumbers(count, type);
  }
  grid_.map = GridMap{arraysOfCells_, readReals(count, type, "a parameter of the map")};
}

template <std::size_t corners>
Array<double> VtkReader<corners>::readReals(std::size_t count, const NumberType& type,
                                            const char* what) {
  Array<double> numbers;
  if (binary_) {
    skipLineBreak();
    const char* const bytes = takeBytes(count, type.bytes);
    numbers.resize(count);
    parallelFor(stage_, count, kGrain, [&](std::size_t i) {
      const char* const place = bytes + i * type.bytes;
      numbers[i] = type.bytes == 8 ? loadBig<double>(place) : double{loadBig<float>(place)};
    });
    return numbers;
  }
  numbers.resize(count);
  readElements(scanner_, &*index_, stage_, count, 1, [&](TextScanner& scanner, std::size_t i) {
    if (!scanner.readNumber(numbers[i])) scanner.failNumber(what);
  });
  return numbers;
}

/// Reads the tets of a file and its map, if it has one.
class VtkMapReader {
 public:
  VtkMapReader(std::string_view text, const std::string& fileName, Stage& stage,
               std::string_view mapArray)
      : grid_(text, fileName, stage, mapArray),
        fileName_(fileName),
        stage_(stage),
        mapArray_(mapArray) {}
  TetMap read() { return toTetMap(grid_.read(), mapArray_, fileName_, stage_); }

 private:
  VtkReader<4> grid_;
  const std::string& fileName_;
  Stage& stage_;
  std::string_view mapArray_;
};

}  // namespace

HexMesh parseVtkLegacy(std::string_view text, const std::string& fileName, Context& context) {
  return toHexMesh(parseWith<VtkReader<8>>(text, fileName, "read mesh", context).mesh);
}

HexMesh readVtkLegacy(const std::filesystem::path& file, Context& context) {
  return toHexMesh(readWith<VtkReader<8>>(file, "read mesh", context).mesh);
}

TetCells parseVtkLegacyTets(std::string_view text, const std::string& fileName, Context& context) {
  return parseWith<VtkReader<4>>(text, fileName, "read tets", context).mesh;
}

TetCells readVtkLegacyTets(const std::filesystem::path& file, Context& context) {
  return readWith<VtkReader<4>>(file, "read tets", context).mesh;
}

TetMap parseVtkLegacyMap(std::string_view text, const std::string& fileName,
                         const ReadOptions& options, Context& context) {
  return parseWith<VtkMapReader>(text, fileName, "read map", context, options.mapArray);
}

TetMap readVtkLegacyMap(const std::filesystem::path& file, const ReadOptions& options,
                        Context& context) {
  return readWith<VtkMapReader>(file, "read map", context, options.mapArray);
}

}  // namespace hexhex
