// Reads legacy `.vtk` files: their sections, in any order, and where the numbers are; up to version
// 4 also piece by piece.
#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/plain_mesh.hpp>
#include <io/core/text_scanner.hpp>
#include <io/core/text_window.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/vtk_source.hpp>

namespace hexhex::io {

namespace {

/// VTK writes characters of names that separate tokens as "%20".
std::string decodedVtkName(std::string_view token) {
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

bool isReal(VtkScalar scalar) { return isOf<float>(scalar) || isOf<double>(scalar); }

struct NumberType {
  std::string_view name;
  VtkScalar scalar;
};

// The first three are those that a file need not tell. Bits and strings are no numbers, and never
// wanted.
constexpr std::array<NumberType, 16> kTypes = {{{"int", std::int32_t{}},
                                                {"float", float{}},
                                                {"unsigned_char", std::uint8_t{}},
                                                {"double", double{}},
                                                {"vtktypeint64", std::int64_t{}},
                                                {"vtkidtype", std::int32_t{}},
                                                {"vtktypeint32", std::int32_t{}},
                                                {"long", std::int64_t{}},
                                                {"unsigned_int", std::uint32_t{}},
                                                {"unsigned_long", std::uint64_t{}},
                                                {"vtktypeuint64", std::uint64_t{}},
                                                {"short", std::int16_t{}},
                                                {"unsigned_short", std::uint16_t{}},
                                                {"char", std::int8_t{}},
                                                {"bit", std::uint8_t{}},
                                                {"string", std::uint8_t{}}}};

/// An open `.vtk` file. Functions throw Error FileSyntax, FileUnsupported, NotFinite or TooLarge,
/// with the line.
class VtkLegacyFile final : public VtkSource {
 public:
  VtkLegacyFile(VtkFileBytes bytes, const std::string& fileName, Stage& stage)
      : VtkSource(std::move(bytes), fileName), stage_(stage), scanner_(text(), fileName) {
    readHead();
    while (!isBehindMesh() && readOn()) {
    }
    require(hasPoints_, "POINTS");
    require(hasCells_, "CELLS");
    require(hasTypes_, "CELL_TYPES");
    if (types.count == cells) return;
    scanner_.fail(ErrorCode::FileSyntax, "the file has " + std::to_string(cells) + " cells but " +
                                             std::to_string(types.count) + " types of cells.");
  }

  /// Reads the regions of cells if they follow as this library writes them.
  void readRegions() {
    const std::string begin =
        "CELL_DATA " + std::to_string(cells) + "\nSCALARS region int 1\nLOOKUP_TABLE default";
    if (!scanner_.skipSpace() || !text().substr(scanner_.position()).starts_with(begin)) return;
    const std::size_t numbers = scanner_.position() + begin.size();
    arrays.push_back({VtkSection::CellData, std::string(kVtkRegions), VtkNumbers::Integers, 1,
                      false, [this, numbers](VtkNumbers, std::optional<std::uint64_t>) {
                        scanner_.moveTo(numbers);
                        return readIntegers(cells, kTypes[0], "a region");
                      }});
  }

  /// Reads the next section, array, or beginning of several arrays.
  bool readOn() override {
    if (fieldArrays_ > 0) {
      readFieldArray();
      return true;
    }
    if (!scanner_.skipSpace()) return false;
    const std::string keyword = readKeyword();
    if (isBehindMesh()) {
      readAttribute(keyword);
    } else {
      readSection(keyword);
    }
    return true;
  }

 private:
  void readHead() {
    constexpr std::string_view kMagic = "# vtk DataFile Version ";
    if (!scanner_.takeLine().starts_with(kMagic)) {
      scanner_.moveTo(0);
      scanner_.fail(
          ErrorCode::FileSyntax,
          "a .vtk file begins with \"# vtk DataFile Version\". If it is XML, name it .vtu.");
    }
    static_cast<void>(scanner_.takeLine());  // a title, which may be anything
    const std::string encoding = readKeyword();
    binary_ = encoding == "binary";
    if (!binary_ && encoding != "ascii") scanner_.failToken("\"ASCII\" or \"BINARY\"");
    if (readKeyword() != "dataset") scanner_.failToken("\"DATASET\"");
    if (readKeyword() != "unstructured_grid") {
      scanner_.fail(ErrorCode::FileUnsupported,
                    "the data set must be an UNSTRUCTURED_GRID, found " +
                        quoted(scanner_.currentToken()) + ".");
    }
    if (!binary_) index_.emplace(text(), stage_);
  }

  /// Whether only arrays follow.
  [[nodiscard]] bool isBehindMesh() const { return hasPoints_ && hasCells_ && hasTypes_; }

  void readSection(const std::string& keyword) {
    if (keyword == "points") {
      beginSection(hasPoints_, "POINTS");
      readPoints();
    } else if (keyword == "cells") {
      beginSection(hasCells_, "CELLS");
      readCells();
    } else if (keyword == "cell_types") {
      beginSection(hasTypes_, "CELL_TYPES");
      types =
          readIntegers(scanner_.readCount("types of cells", 2), kTypes[0], "the type of a cell");
    } else if (keyword == "field") {
      beginField();
    } else if (keyword == "metadata") {
      skipMetadata();
    } else {
      scanner_.failToken("POINTS, CELLS or CELL_TYPES");
    }
  }

  /// Notes that a section is there, unless it was before.
  void beginSection(bool& present, std::string_view keyword) {
    scanner_.failIfRepeated(present, keyword);
    present = true;
  }

  void require(bool present, std::string_view keyword) const {
    if (present) return;
    scanner_.fail(ErrorCode::FileSyntax, "the file ends without the section " +
                                             std::string(keyword) + ": it is incomplete.");
  }

  void readPoints() {
    points = scanner_.readCount("points", 6);
    const NumberType& type = readType();
    if (!isReal(type.scalar)) {
      scanner_.fail(ErrorCode::FileUnsupported,
                    "the coordinates of points must be float or double.");
    }
    coordinates = readNumbers(3 * points, type, VtkNumbers::Reals, [](std::size_t i) {
      return NumberName("a coordinate of ", "point", i / 3);
    });
  }

  void readCells() {
    // Counted as numbers of one digit or four bytes.
    const std::size_t first = scanner_.readCount("cells", 2);
    const std::size_t second = scanner_.readCount("numbers of cells", 2);
    const std::size_t before = scanner_.position();
    if (readKeyword() != "offsets") {
      scanner_.moveTo(before);
      cells = first;
      return readOldCells(second);
    }
    // From version 5 on: where cells begin and the last one ends, and all corners.
    cells = std::max<std::size_t>(first, 1) - 1;
    offsets = readIntegers(first, readType(), "an offset of a cell");
    if (readKeyword() != "connectivity") scanner_.failToken("\"CONNECTIVITY\"");
    connectivity = readIntegers(second, readType(), "a corner of a cell");
  }

  /// Up to version 4: each cell is its number of corners, and its corners.
  void readOldCells(std::size_t numbers) {
    gap = 1;
    connectivity = readIntegers(numbers, kTypes[0], "a corner of a cell");
    const auto numberAt = [&](std::size_t i) {
      if (binary_)
        return std::int64_t{loadBig<std::int32_t>(text().data() + connectivity.position + 4 * i)};
      std::int64_t number = 0;
      copy(connectivity, i, 1, &number);
      return number;
    };
    // Usually all cells are alike.
    const std::size_t each = cells > 0 ? numbers / cells : 0;
    const auto hasAsMany = [&](std::size_t cell) {
      return numberAt(each * cell) == static_cast<std::int64_t>(each - 1);
    };
    if (each > 0 && each * cells == numbers && firstFault(stage_, cells, hasAsMany) == cells) {
      stride = each;
      return;
    }
    offsets = textColumn(VtkNumbers::Integers, cells + 1);
    std::size_t place = 0;
    for (std::size_t cell = 0; cell <= cells; ++cell) {
      const auto offset = static_cast<std::int64_t>(place);
      std::memcpy(offsets.decoded.data() + cell * sizeof(offset), &offset, sizeof(offset));
      if (cell == cells) break;
      const std::int64_t count = place < numbers ? numberAt(place) : -1;
      if (count < 0 || static_cast<std::uint64_t>(count) > numbers - place - 1) {
        scanner_.fail(ErrorCode::FileSyntax,
                      "cell " + std::to_string(cell) + " of " + std::to_string(cells) +
                          " goes beyond the " + std::to_string(numbers) +
                          " numbers that the section CELLS announces.",
                      Place{PlaceKind::Cell, cell});
      }
      place += 1 + static_cast<std::size_t>(count);
    }
  }

  /// Reads one array, or the beginning of several.
  void readAttribute(const std::string& keyword) {
    if (keyword == "metadata") return skipMetadata();
    if (keyword == "field") return beginField();
    if (keyword == "point_data" || keyword == "cell_data")
      return beginArrays(keyword == "cell_data");
    const std::string_view name = scanner_.readToken();
    const auto array = [&](std::size_t components, const NumberType& type) {
      readArray(name, components, elements(), type);
    };
    const NumberType& colour = binary_ ? kTypes[2] : kTypes[1];
    if (keyword == "scalars") return readScalars(name);
    if (keyword == "vectors" || keyword == "normals") return array(3, readType());
    if (keyword == "tensors") return array(9, readType());
    if (keyword == "tensors6") return array(6, readType());
    if (keyword == "global_ids" || keyword == "pedigree_ids") return array(1, readType());
    if (keyword == "texture_coordinates") {
      const std::size_t components = scanner_.readCount("components", 1);
      return array(components, readType());
    }
    if (keyword == "color_scalars") return array(scanner_.readCount("components", 1), colour);
    if (keyword == "lookup_table") return skipNumbers(4 * scanner_.readCount("colours", 4), colour);
    scanner_.fail(ErrorCode::FileSyntax, "expected a keyword of point or cell data, found " +
                                             quoted(std::string_view(keyword)) + ".");
  }

  void beginArrays(bool ofCells) {
    ofCells_ = ofCells;
    const std::int64_t count = scanner_.integer("the number of values");
    if (count >= 0 && static_cast<std::uint64_t>(count) == elements()) return;
    scanner_.fail(ErrorCode::FileSyntax,
                  "the arrays are for " + std::to_string(count) + (ofCells ? " cells" : " points") +
                      ", but the file has " + std::to_string(elements()) + ".");
  }

  /// "SCALARS name type components", where the last may be missing, and the name of a table of
  /// colours.
  void readScalars(std::string_view name) {
    constexpr std::string_view kTable = "lookup_table";
    const NumberType& type = readType();
    std::size_t components = 1;
    if (lowerCase(scanner_.peekToken()) != kTable) components = scanner_.readCount("components", 1);
    if (lowerCase(scanner_.peekToken()) == kTable) {
      scanner_.readToken();
      scanner_.readToken();
    }
    readArray(name, components, elements(), type);
  }

  void beginField() {
    scanner_.readToken();
    fieldArrays_ = scanner_.readCount("arrays", 8);
  }

  void readFieldArray() {
    --fieldArrays_;
    if (lowerCase(scanner_.peekToken()) == "metadata") {
      scanner_.readToken();
      skipMetadata();
    }
    const std::string_view name = scanner_.readToken();
    const std::size_t components = scanner_.readCount("components", 1);
    const std::size_t tuples = scanner_.readCount("tuples", 1);
    readArray(name, components, tuples, readType());
  }

  /// Skips the numbers of an array. In front of the mesh's sections, arrays belong to nothing.
  void readArray(std::string_view name, std::size_t components, std::size_t tuples,
                 const NumberType& type) {
    if (components > 0 && tuples > text().size() / components) {
      scanner_.fail(ErrorCode::FileSyntax, "an array has more numbers than the file has bytes.");
    }
    see(name, ofCells_, components);
    const std::size_t count = components * tuples;
    const std::size_t begin = scanner_.position();
    const bool isNumbers = type.name != "string" && type.name != "bit";
    if (isBehindMesh() && tuples == elements() && isNumbers) {
      arrays.push_back({ofCells_ ? VtkSection::CellData : VtkSection::PointData,
                        decodedVtkName(name),
                        isReal(type.scalar) ? VtkNumbers::Reals : VtkNumbers::Integers, components,
                        false, [this, begin, count, &type](VtkNumbers numbers, auto&&) {
                          scanner_.moveTo(begin);
                          return readNumbers(count, type, numbers,
                                             [](std::size_t) { return "a number of an array"; });
                        }});
    }
    skipNumbers(count, type);
  }

  /// Reads a word that may come in any letter case, in lower case.
  std::string readKeyword() { return lowerCase(scanner_.readToken()); }

  const NumberType& readType() {
    const std::string name = readKeyword();
    const auto* const found = std::find_if(
        kTypes.begin(), kTypes.end(), [&](const NumberType& type) { return type.name == name; });
    if (found != kTypes.end()) return *found;
    scanner_.failToken("a type of numbers, e.g. double");
  }

  /// Skips lines up to an empty one.
  void skipMetadata() {
    static_cast<void>(scanner_.takeLine());
    while (scanner_.position() < text().size()) {
      const std::string_view line = scanner_.takeLine();
      if (line.empty() || line == "\r") return;
    }
  }

  /// Goes on behind the bytes of so many numbers, which begin on the next line.
  /// @return where they begin
  std::size_t takeBytes(std::size_t count, std::size_t bytesEach) {
    scanner_.skipLineBreak();
    const std::size_t begin = scanner_.position();
    const std::size_t left = text().size() - begin;
    if (count > left / bytesEach) {
      scanner_.fail(ErrorCode::FileSyntax,
                    std::to_string(count) + " numbers of " + std::to_string(bytesEach) +
                        " bytes are announced, but only " + std::to_string(left) +
                        " bytes are left: the file is incomplete.");
    }
    scanner_.moveTo(begin + count * bytesEach);
    return begin;
  }

  /// @param what  for messages: what(i) is what number i should be
  template <class What>
  VtkColumn readNumbers(std::size_t count, const NumberType& type, VtkNumbers numbers,
                        const What& what) {
    VtkColumn column;
    if (binary_) {
      column.scalar = type.scalar;
      column.bigEndian = true;
      column.count = count;
      column.position = takeBytes(count, bytesOf(type.scalar));
      return column;
    }
    column = textColumn(numbers, count);
    readElements(scanner_, &*index_, stage_, count, 1, [&](TextScanner& scanner, std::size_t i) {
      readVtkNumber(scanner, numbers, column, i, what(i));
    });
    return column;
  }

  VtkColumn readIntegers(std::size_t count, const NumberType& type, const char* what) {
    if (!isOf<std::int32_t>(type.scalar) && !isOf<std::int64_t>(type.scalar)) {
      scanner_.fail(ErrorCode::FileUnsupported, std::string(what) + " cannot be of type " +
                                                    std::string(type.name) +
                                                    ", only int or vtktypeint64.");
    }
    return readNumbers(count, type, VtkNumbers::Integers, [what](std::size_t) { return what; });
  }

  void skipNumbers(std::size_t count, const NumberType& type) {
    if (!binary_) {
      scanner_.moveTo(index_->find(index_->countBefore(scanner_.position()) + count));
      return;
    }
    if (type.name == "string") {
      scanner_.fail(ErrorCode::FileUnsupported,
                    "an array of strings has no known length in bytes; save the file without it.");
    }
    static_cast<void>(type.name == "bit" ? takeBytes((count + 7) / 8, 1)
                                         : takeBytes(count, bytesOf(type.scalar)));
  }

  /// Number of points or cells, whichever arrays belong to.
  [[nodiscard]] std::size_t elements() const { return ofCells_ ? cells : points; }

  Stage& stage_;
  TextScanner scanner_;
  std::optional<TokenIndex> index_;  ///< only of text
  bool binary_ = false;
  bool hasPoints_ = false;
  bool hasCells_ = false;
  bool hasTypes_ = false;
  bool ofCells_ = false;         ///< whether arrays belong to cells or to points
  std::size_t fieldArrays_ = 0;  ///< that follow in the field that was begun
};

}  // namespace

std::unique_ptr<VtkSource> openVtkLegacyFile(const Input& input, bool withRegions, Stage& stage) {
  VtkFileBytes bytes;
  bytes.text = input.text(bytes.room, stage, "#");
  auto file = std::make_unique<VtkLegacyFile>(std::move(bytes), input.name(), stage);
  file->counts = input.counts();
  if (withRegions) file->readRegions();
  return file;
}

namespace {

// Legacy `.vtk` files up to version 4 piece by piece.

constexpr std::size_t kNumbers = 1 + 8;  // of a cell: how many corners it has, and these

constexpr std::size_t kVtkLegacyStreamGrain = 4096;

/// What stands where in a file with the sections POINTS, CELLS and CELL_TYPES, in this order, and
/// nothing but hexahedra. Arrays may follow.
class VtkSections : public PlainMesh {
 public:
  VtkSections(const InputFile& file, const std::string& name, Context& context, std::size_t window)
      : text_(file, name, context, window) {}

 protected:
  /// Reads everything up to the first section.
  [[nodiscard]] bool lookAtHead(std::string_view encoding) {
    const std::string magic = text_.takeLine();
    constexpr std::string_view kMagic = "# vtk DataFile Version ";
    // From version 5 on, cells are stored in another way.
    if (!magic.starts_with(kMagic) || magic.size() == kMagic.size() || magic[kMagic.size()] < '1' ||
        magic[kMagic.size()] > '4') {
      return false;
    }
    static_cast<void>(text_.takeLine());  // a title, which may be anything
    return lowerCase(text_.token()) == encoding && lowerCase(text_.token()) == "dataset" &&
           lowerCase(text_.token()) == "unstructured_grid";
  }
  /// "POINTS n double".
  [[nodiscard]] bool lookAtPoints() {
    if (lowerCase(text_.token()) != "points" || !takeCount(points)) return false;
    const std::string type = lowerCase(text_.token());
    isFloat_ = type == "float";
    return isFloat_ || type == "double";
  }
  /// "CELLS n 9n".
  [[nodiscard]] bool lookAtCells() {
    return lowerCase(text_.token()) == "cells" && takeCount(cells) &&
           text_.count() == kNumbers * cells;
  }
  /// "CELL_TYPES n".
  [[nodiscard]] bool lookAtTypes() {
    return lowerCase(text_.token()) == "cell_types" && text_.count() == cells;
  }

  TextWindow text_;
  std::uint64_t positionOfPoints_ = 0;
  std::uint64_t positionOfCells_ = 0;
  bool isFloat_ = false;

 private:
  [[nodiscard]] bool takeCount(std::uint64_t& to) {
    const std::optional<std::uint64_t> found = text_.count();
    to = found.value_or(0);
    return found.has_value();
  }
};

std::uint64_t vertexAt(std::int64_t number, std::uint64_t points) {
  const auto vertex = static_cast<std::uint64_t>(number);
  if (vertex < points) return vertex;
  throw Error(ErrorCode::IndexOutOfRange, "A cell names point " + std::to_string(number) + " of " +
                                              std::to_string(points) + ".");
}

void requireCorners(std::int64_t number) {
  if (number == 8) return;
  throw Error(ErrorCode::FileSyntax,
              "A hexahedron has " + std::to_string(number) + " corners instead of 8.");
}

class VtkTextPieces final : public VtkSections {
 public:
  VtkTextPieces(const InputFile& file, const std::string& name, Context& context)
      : VtkSections(file, name, context, TextWindow::kText) {}

  [[nodiscard]] bool look() {
    if (!lookAtHead("ascii") || !lookAtPoints()) return false;
    positionOfPoints_ = text_.position();
    if (!text_.skip(3 * points) || !lookAtCells()) return false;
    positionOfCells_ = text_.position();
    return text_.skip(kNumbers * cells) && lookAtTypes() && areHexahedra();
  }

  void beginPoints() override { text_.moveTo(positionOfPoints_); }
  void read(std::span<Vec3> to) override {
    text_.elements(to.size(), 3, [&](TextScanner& scanner, std::size_t i) {
      for (double& x : to[i]) x = scanner.number("a coordinate of a point");
    });
  }
  void beginCells() override { text_.moveTo(positionOfCells_); }
  void read(std::span<Hex64> to) override {
    text_.elements(to.size(), kNumbers, [&](TextScanner& scanner, std::size_t i) {
      requireCorners(scanner.integer("a number of corners"));
      for (std::uint64_t& vertex : to[i]) {
        vertex = vertexAt(scanner.integer("a corner of a cell"), points);
      }
    });
  }

 private:
  [[nodiscard]] bool areHexahedra() {
    std::atomic<bool> all{true};
    for (std::uint64_t first = 0; first < cells && all; first += kPieceElements) {
      text_.elements(std::min<std::uint64_t>(kPieceElements, cells - first), 1,
                     [&](TextScanner& scanner, std::size_t) {
                       if (scanner.integer("the type of a cell") != kCellKind<8>.vtkType)
                         all = false;
                     });
    }
    return all;
  }
};

class VtkBytePieces final : public VtkSections {
 public:
  VtkBytePieces(const InputFile& file, const std::string& name, Context& context)
      : VtkSections(file, name, context, TextWindow::kWords),
        file_(file),
        quiet_(context.threads()) {}

  [[nodiscard]] bool look() {
    if (!lookAtHead("binary") || !lookAtPoints()) return false;
    return skipBytes(3 * points, isFloat_ ? 4 : 8, positionOfPoints_) && lookAtCells() &&
           skipBytes(kNumbers * cells, 4, positionOfCells_) && lookAtTypes() && areHexahedra();
  }

  void beginPoints() override { next_ = positionOfPoints_; }
  void read(std::span<Vec3> to) override {
    if (isFloat_) return readPoints<float>(to);
    readPoints<double>(to);
  }
  void beginCells() override { next_ = positionOfCells_; }
  void read(std::span<Hex64> to) override {
    const char* const bytes = take(to.size() * kNumbers * 4);
    forEach(to.size(), [&](std::size_t i) {
      const char* place = bytes + i * kNumbers * 4;
      requireCorners(loadBig<std::int32_t>(place));
      for (std::uint64_t& vertex : to[i]) {
        vertex = vertexAt(loadBig<std::int32_t>(place += 4), points);
      }
    });
  }

 private:
  /// Numbers begin on the next line.
  [[nodiscard]] bool skipBytes(std::uint64_t numbers, std::uint64_t bytesEach,
                               std::uint64_t& position) {
    if (!text_.skipLineBreak()) return false;
    position = text_.position();
    if (numbers > (file_.size() - position) / bytesEach) return false;
    text_.moveTo(position + numbers * bytesEach);
    return true;
  }

  [[nodiscard]] bool areHexahedra() {
    if (!text_.skipLineBreak() || cells > (file_.size() - text_.position()) / 4) return false;
    next_ = text_.position();
    for (std::uint64_t first = 0; first < cells; first += kPieceElements) {
      const std::size_t count = std::min<std::uint64_t>(kPieceElements, cells - first);
      const char* const bytes = take(4 * count);
      for (std::size_t i = 0; i < count; ++i) {
        if (loadBig<std::int32_t>(bytes + 4 * i) != kCellKind<8>.vtkType) return false;
      }
    }
    return true;
  }

  template <class T>
  void readPoints(std::span<Vec3> to) {
    const char* const bytes = take(to.size() * 3 * sizeof(T));
    forEach(to.size(), [&](std::size_t i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        to[i][axis] = loadBig<T>(bytes + (3 * i + axis) * sizeof(T));
        if (!std::isfinite(to[i][axis])) {
          throw Error(ErrorCode::NotFinite, "A coordinate is not finite.");
        }
      }
    });
  }

  /// The next bytes.
  [[nodiscard]] const char* take(std::size_t size) {
    bytes_.resize(size);
    file_.readAt(next_, bytes_.data(), size);
    next_ += size;
    return bytes_.data();
  }

  template <class F>
  void forEach(std::size_t n, const F& f) {
    Stage stage(quiet_, "read");
    parallelFor(stage, n, kVtkLegacyStreamGrain, f);
  }

  const InputFile& file_;
  Context quiet_;
  std::uint64_t next_ = 0;  ///< position in the file
  Array<char> bytes_;
};

template <class Mesh>
std::unique_ptr<PlainMesh> openVtkAs(const InputFile& file, const std::string& name,
                                     Context& context) {
  auto mesh = std::make_unique<Mesh>(file, name, context);
  return mesh->look() ? std::move(mesh) : nullptr;
}

std::unique_ptr<PlainMesh> openVtkPieces(const InputFile& file, const std::string& name,
                                         Context& context) {
  std::unique_ptr<PlainMesh> bytes = openVtkAs<VtkBytePieces>(file, name, context);
  return bytes ? std::move(bytes) : openVtkAs<VtkTextPieces>(file, name, context);
}

}  // namespace

void readVtkLegacyTo(MeshSink& sink, const Input& input, Context& context) {
  readPlainMesh({openVtkPieces, readVtkLegacy}, sink, input, context);
}

}  // namespace hexhex::io
