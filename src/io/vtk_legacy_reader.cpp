// The reading half of vtk_legacy.hpp. Integers go through a plain array, as text and bytes, old and
// new layouts differ in nothing but how they fill it.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/finite_points.hpp>
#include <io/input_file.hpp>
#include <io/ovmb_bytes.hpp>
#include <io/text_elements.hpp>
#include <io/text_scanner.hpp>
#include <io/token_index.hpp>
#include <io/vtk_legacy.hpp>

namespace hexhex {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 14;
constexpr std::int64_t kHexahedron = 12;
constexpr std::uint64_t kCorners = 8;

/// VTK's keywords and type names come in any letter case.
std::string lowerCase(std::string_view token) {
  std::string result(token);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
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

/// Where the corners of a cell are.
struct CellCorners {
  std::size_t begin;
  std::size_t count;
};

/// Numbers of legacy files are stored with the largest byte first.
template <class T>
T loadBig(const char* place) {
  std::array<char, sizeof(T)> bytes;  // NOLINT(*-member-init): all of it is copied to
  std::reverse_copy(place, place + sizeof(T), bytes.begin());
  return loadLittle<T>(bytes.data());
}

/// Reads one file from top to bottom.
class VtkReader {
 public:
  VtkReader(std::string_view text, const std::string& fileName, Stage& stage)
      : text_(text), scanner_(text, fileName), stage_(stage) {}

  HexMesh read();

 private:
  void readHead();
  [[nodiscard]] std::string_view takeLine();
  void readKeyword(const std::string& keyword);
  void readPoints();
  void readCells();
  void readOldCells(std::size_t cells, std::size_t numbers);
  void readNewCells(std::size_t places, std::size_t corners);
  void readTypes();
  void skipField();
  void skipNumbers(std::size_t count, const NumberType& type);
  void skipMetadata();
  void takeHexahedra();
  [[nodiscard]] bool takeHexahedron(std::size_t cell, Hex& corners) const;
  [[noreturn]] void failAbout(std::size_t cell) const;

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
  Array<std::int64_t> corners_;
  Array<CellCorners> cells_;
  Array<std::int64_t> types_;
  HexMesh mesh_;
};

HexMesh VtkReader::read() {
  readHead();
  // What follows the three sections are arrays, which are not read.
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
  takeHexahedra();
  return std::move(mesh_);
}

void VtkReader::readHead() {
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

std::string_view VtkReader::takeLine() {
  const std::size_t begin = scanner_.position();
  const std::size_t end = std::min(text_.find('\n', begin), text_.size());
  scanner_.moveTo(std::min(end + 1, text_.size()));
  return text_.substr(begin, end - begin);
}

void VtkReader::readKeyword(const std::string& keyword) {
  if (keyword == "points") return readPoints();
  if (keyword == "cells") return readCells();
  if (keyword == "cell_types") return readTypes();
  if (keyword == "field") return skipField();
  if (keyword == "metadata") return skipMetadata();
  scanner_.fail(ErrorCode::FileSyntax, "expected POINTS, CELLS or CELL_TYPES, found " +
                                           quoted(scanner_.currentToken()) + ".");
}

void VtkReader::failIfRepeated(bool present, const char* keyword) {
  if (!present) return;
  scanner_.fail(ErrorCode::FileSyntax,
                "the section " + std::string(keyword) + " occurs a second time.");
}

const NumberType& VtkReader::readType() {
  const std::string name = lowerCase(scanner_.readToken());
  const auto* const found = std::find_if(kTypes.begin(), kTypes.end(),
                                         [&](const NumberType& type) { return type.name == name; });
  if (found != kTypes.end()) return *found;
  scanner_.fail(ErrorCode::FileSyntax, "expected a type of numbers, e.g. double, found " +
                                           quoted(scanner_.currentToken()) + ".");
}

void VtkReader::skipLineBreak() {
  std::size_t place = scanner_.position();
  while (place < text_.size() && (text_[place] == ' ' || text_[place] == '\r')) ++place;
  if (place == text_.size() || text_[place] != '\n') {
    scanner_.fail(ErrorCode::FileSyntax,
                  "the line has to end behind " + quoted(scanner_.currentToken()) +
                      ", since the bytes of numbers begin on the next line.");
  }
  scanner_.moveTo(place + 1);
}

const char* VtkReader::takeBytes(std::size_t count, std::size_t bytesEach) {
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

void VtkReader::readPoints() {
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

Array<std::int64_t> VtkReader::readIntegers(std::size_t count, const NumberType& type,
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

void VtkReader::readCells() {
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
void VtkReader::readOldCells(std::size_t cells, std::size_t numbers) {
  corners_ = readIntegers(numbers, kInt, "a corner of a cell");
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
void VtkReader::readNewCells(std::size_t places, std::size_t corners) {
  const Array<std::int64_t> begins = readIntegers(places, readType(), "an offset of a cell");
  if (lowerCase(scanner_.readToken()) != "connectivity") {
    scanner_.fail(ErrorCode::FileSyntax,
                  "expected \"CONNECTIVITY\", found " + quoted(scanner_.currentToken()) + ".");
  }
  corners_ = readIntegers(corners, readType(), "a corner of a cell");
  cells_.resize(std::max<std::size_t>(places, 1) - 1);
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    const std::int64_t begin = begins[cell];
    const std::int64_t end = begins[cell + 1];
    if (begin < 0 || end < begin || static_cast<std::uint64_t>(end) > corners) {
      scanner_.fail(ErrorCode::FileSyntax,
                    "the corners of cell " + std::to_string(cell) + " lie from " +
                        std::to_string(begin) + " to " + std::to_string(end) + " of the " +
                        std::to_string(corners) + " corners, which cannot be.",
                    Place{PlaceKind::Cell, cell});
    }
    cells_[cell] = {static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)};
  }
}

void VtkReader::readTypes() {
  failIfRepeated(hasTypes_, "CELL_TYPES");
  hasTypes_ = true;
  const std::size_t count = scanner_.readCount("types of cells", 2);
  types_ = readIntegers(count, kInt, "the type of a cell");
}

/// Skips a list of arrays.
void VtkReader::skipField() {
  scanner_.readToken();
  const std::size_t arrays = scanner_.readCount("arrays", 8);
  for (std::size_t i = 0; i < arrays; ++i) {
    scanner_.readToken();
    const std::size_t components = scanner_.readCount("components", 1);
    const std::size_t tuples = scanner_.readCount("tuples", 1);
    const NumberType& type = readType();
    if (components > 0 && tuples > text_.size() / components) {
      scanner_.fail(ErrorCode::FileSyntax, "an array has more numbers than the file has bytes.");
    }
    skipNumbers(components * tuples, type);
  }
}

void VtkReader::skipNumbers(std::size_t count, const NumberType& type) {
  if (!binary_) {
    scanner_.moveTo(index_->find(index_->countBefore(scanner_.position()) + count));
    return;
  }
  if (type.kind == Kind::Text) {
    scanner_.fail(ErrorCode::FileUnsupported,
                  "an array of strings stands before the cells; save the file without it.");
  }
  skipLineBreak();
  const bool bits = type.kind == Kind::Bits;
  static_cast<void>(takeBytes(bits ? (count + 7) / 8 : count, bits ? 1 : type.bytes));
}

/// Skips lines up to an empty one.
void VtkReader::skipMetadata() {
  static_cast<void>(takeLine());
  while (scanner_.position() < text_.size()) {
    const std::string_view line = takeLine();
    if (line.empty() || line == "\r") return;
  }
}

void VtkReader::takeHexahedra() {
  if (types_.size() != cells_.size()) {
    scanner_.fail(ErrorCode::FileSyntax, "the file has " + std::to_string(cells_.size()) +
                                             " cells but " + std::to_string(types_.size()) +
                                             " types of cells.");
  }
  Array<std::size_t> hexahedra;
  for (std::size_t cell = 0; cell < types_.size(); ++cell) {
    if (types_[cell] == kHexahedron) hexahedra.push_back(cell);
  }
  if (hexahedra.empty() && !types_.empty()) {
    throw Error(ErrorCode::FileUnsupported,
                scanner_.fileName() +
                    ": the file holds no hexahedra (cells of type 12), but other cells only.");
  }
  mesh_.cells.resize(hexahedra.size());
  std::atomic<std::size_t> firstWrong{hexahedra.size()};
  parallelFor(stage_, hexahedra.size(), kGrain, [&](std::size_t i) {
    if (takeHexahedron(hexahedra[i], mesh_.cells[i])) return;
    std::size_t known = firstWrong.load(std::memory_order_relaxed);
    while (i < known && !firstWrong.compare_exchange_weak(known, i)) {
    }
  });
  if (firstWrong < hexahedra.size()) failAbout(hexahedra[firstWrong]);
}

/// Whether the cell has eight corners that are points.
bool VtkReader::takeHexahedron(std::size_t cell, Hex& corners) const {
  if (cells_[cell].count != kCorners) return false;
  for (std::size_t k = 0; k < kCorners; ++k) {
    const auto corner = static_cast<std::uint64_t>(corners_[cells_[cell].begin + k]);
    if (corner >= mesh_.points.size()) return false;
    corners[k] = static_cast<Index>(corner);
  }
  return true;
}

void VtkReader::failAbout(std::size_t cell) const {
  const std::string name = scanner_.fileName() + ": cell " + std::to_string(cell);
  const Place place{PlaceKind::Cell, cell};
  if (cells_[cell].count != kCorners) {
    throw Error(ErrorCode::FileSyntax,
                name + " is a hexahedron with " + std::to_string(cells_[cell].count) +
                    " instead of 8 corners.",
                place);
  }
  throw Error(ErrorCode::IndexOutOfRange,
              name + " names a point that does not exist: the file has " +
                  std::to_string(mesh_.points.size()) + " points, numbered from 0.",
              place);
}

}  // namespace

HexMesh parseVtkLegacy(std::string_view text, const std::string& fileName, Context& context) {
  Stage stage(context, "read mesh");
  HexMesh mesh;
  withThreads(context.threads(), [&] { mesh = VtkReader(text, fileName, stage).read(); });
  return mesh;
}

HexMesh readVtkLegacy(const std::filesystem::path& file, Context& context) {
  Stage stage(context, "read mesh");
  HexMesh mesh;
  withThreads(context.threads(), [&] {
    const Array<char> bytes = readWholeFile(file, stage);
    mesh = VtkReader(asText(bytes), file.string(), stage).read();
  });
  return mesh;
}

}  // namespace hexhex
