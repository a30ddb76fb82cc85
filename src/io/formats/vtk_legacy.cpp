// Legacy `.vtk` files (see formats.hpp): reads sections in any order; streams versions up to 4; and
// writes meshes and maps.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <base/stage.hpp>
#include <io/core/bytes.hpp>
#include <io/core/cell_counts.hpp>
#include <io/core/checked_sink.hpp>
#include <io/core/hdf_reader.hpp>
#include <io/core/output_file.hpp>
#include <io/core/plain_mesh.hpp>
#include <io/core/text_scanner.hpp>
#include <io/formats/formats.hpp>
#include <io/formats/vtk_source.hpp>

namespace hexhex::io {

namespace {

/// Decodes an array name, in which VTK writes separators as "%20".
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

// The first three are implied where files omit the type. Bits and strings are not numbers and never
// read.
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
      : VtkSource(std::move(bytes), fileName), stage_(stage), scanner_(text(), fileName, stage) {
    readHead();
    require(hasPoints_, "POINTS");
    require(hasCells_, "CELLS");
    require(hasTypes_, "CELL_TYPES");
    if (types.count == cells) return;
    scanner_.fail(ErrorCode::FileSyntax, "the file has ", cells, " cells but ", types.count,
                  " types of cells.");
  }

  /// Reads the regions of cells if they follow as written by this library; otherwise all arrays.
  void readRegions() {
    const std::string begin =
        concat("CELL_DATA ", cells, "\nSCALARS region int 1\nLOOKUP_TABLE default");
    if (isSurface || !scanner_.skipSpace()) return;
    if (!text().substr(scanner_.position()).starts_with(begin)) {
      while (readOn()) {
      }
      return;
    }
    const std::size_t numbers = scanner_.position() + begin.size();
    arrays.push_back({VtkSection::CellData, std::string(kVtkRegions), VtkNumbers::Integers, 1,
                      false, [this, numbers](VtkNumbers, std::optional<std::uint64_t>) {
                        scanner_.moveTo(numbers);
                        return readIntegers(cells, kTypes[0], "a region");
                      }});
  }

  /// Reads the next array, or the head of a field.
  bool readOn() override {
    if (fieldArrays_ > 0) {
      readFieldArray();
      return true;
    }
    if (!scanner_.skipSpace()) return false;
    readAttribute(readKeyword());
    return true;
  }

 private:
  void readHead() {
    constexpr std::string_view kMagic = "# vtk DataFile Version ";
    const std::string_view first = scanner_.takeLine();
    if (first.size() == kMagic.size() || !first.starts_with(kMagic)) {
      scanner_.moveTo(0);
      scanner_.fail(
          ErrorCode::FileSyntax,
          "a .vtk file begins with \"# vtk DataFile Version\". If it is XML, name it .vtu.");
    }
    // Version 5.1 changed their order.
    const std::string_view version = first.substr(kMagic.size());
    if (version[0] < '5' || version.starts_with("5.0")) uprightEdges = VtkEdges::RowByRow;
    static_cast<void>(scanner_.takeLine());  // the title, any text
    const std::string encoding = readKeyword();
    binary_ = encoding == "binary";
    if (!binary_ && encoding != "ascii") scanner_.failToken("\"ASCII\" or \"BINARY\"");
    if (readKeyword() != "dataset") scanner_.failToken("\"DATASET\"");
    const std::string kind = readKeyword();
    const bool isGrid =
        kind == "structured_points" || kind == "structured_grid" || kind == "rectilinear_grid";
    if (!isGrid && kind != "polydata" && kind != "unstructured_grid") {
      scanner_.fail(ErrorCode::FileUnsupported, "the data set ", quoted(scanner_.currentToken()),
                    " is not supported.");
    }
    if (!binary_) scanner_.makeIndex();
    if (isGrid) return readGrid(kind);
    kind == "polydata" ? readPolygons() : readMesh();
  }

  /// Reads the sections of a structured grid, whose cells are implied.
  void readGrid(const std::string& kind) {
    GridIndex size{};
    Vec3 origin{};
    Vec3 spacing{1, 1, 1};
    std::array<Array<double>, 3> axes;
    readSections([&](const std::string& keyword) {
      if (keyword == "dimensions") {
        for (auto& n : size) {
          n = static_cast<std::uint64_t>(
              std::max(std::int64_t{0}, scanner_.integer("a dimension")));
        }
      } else if (keyword == "origin" || keyword == "spacing" || keyword == "aspect_ratio") {
        Vec3& numbers = keyword == "origin" ? origin : spacing;
        for (double& x : numbers) x = scanner_.number("a number");
      } else if (keyword == "points") {
        readPoints();
      } else if (keyword.size() == 13 && keyword.ends_with("_coordinates")) {
        readAxis(axes[static_cast<std::size_t>(keyword[0] - 'x') % 3]);
      } else {
        return false;
      }
      return true;
    });
    const std::uint64_t given = points;
    if (kind == "structured_points") {
      makeGrid(size, fileSize(), [=](std::size_t axis, const GridIndex& point) {
        return spacing[axis] * static_cast<double>(point[axis]) + origin[axis];
      });
    } else if (kind == "structured_grid") {
      makeGrid(size, fileSize(), {});
      if (given != points) failSizes(points, given);
    } else {
      for (std::size_t i = 0; i < 3; ++i) {
        if (axes[i].size() != size[i]) failSizes(size[i], axes[i].size());
      }
      makeGrid(size, fileSize(),
               [axes](std::size_t i, const GridIndex& point) { return axes[i][point[i]]; });
    }
    hasPoints_ = hasCells_ = hasTypes_ = true;
  }

  [[noreturn]] void failSizes(std::uint64_t expected, std::uint64_t found) const {
    scanner_.fail(ErrorCode::FileSyntax, "the section DIMENSIONS announces ", expected,
                  " points or coordinates, but there are ", found, ".");
  }

  void readAxis(Array<double>& axis) {
    axis.resize(scanner_.readCount("coordinates", 2));
    const VtkColumn column = readNumbers(axis.size(), readType(), VtkNumbers::Reals,
                                         [](std::size_t) { return NumberName("a coordinate"); });
    copy(column, 0, axis.size(), axis.data());
  }

  /// Reads the sections of a surface. Of its cells, polygons remain.
  void readPolygons() {
    readSections([&](const std::string& keyword) {
      if (keyword == "points") {
        readPoints();
      } else if (keyword == "polygons") {
        beginSection(hasCells_, "POLYGONS");
        readCells();
      } else if (keyword == "vertices" || keyword == "lines") {
        skipCells();
      } else if (keyword == "triangle_strips") {
        scanner_.fail(ErrorCode::FileUnsupported,
                      "triangle strips are not read; save the surface as triangles.");
      } else {
        return false;
      }
      return true;
    });
    makePolygons();
    hasCells_ = hasTypes_ = true;
  }

  /// Reads sections up to the arrays of points and cells.
  /// @param read  reads the section of a keyword; false if it is none of this data set
  template <class Read>
  void readSections(const Read& read) {
    while (!isBehindMesh() && scanner_.skipSpace()) {
      const std::size_t begin = scanner_.position();
      const std::string keyword = readKeyword();
      if (keyword == "field") {
        beginField();
        while (fieldArrays_ > 0) readFieldArray();
      } else if (keyword == "metadata") {
        skipMetadata();
      } else if (!read(keyword)) {
        if (keyword == "point_data" || keyword == "cell_data") return scanner_.moveTo(begin);
        scanner_.failToken("a section of the data set");
      }
    }
  }

  /// Whether only arrays follow.
  [[nodiscard]] bool isBehindMesh() const { return hasPoints_ && hasCells_ && hasTypes_; }

  void readMesh() {
    readSections([&](const std::string& keyword) {
      if (keyword == "points") {
        readPoints();
      } else if (keyword == "cells") {
        beginSection(hasCells_, "CELLS");
        readCells();
      } else if (keyword == "cell_types") {
        beginSection(hasTypes_, "CELL_TYPES");
        types =
            readIntegers(scanner_.readCount("types of cells", 2), kTypes[0], "the type of a cell");
      } else {
        scanner_.failToken("POINTS, CELLS or CELL_TYPES");
      }
      return true;
    });
  }

  /// Marks a section as present; throws if it was already.
  void beginSection(bool& present, std::string_view keyword) {
    scanner_.failIfRepeated(present, keyword);
    present = true;
  }

  void require(bool present, std::string_view keyword) const {
    if (present) return;
    scanner_.fail(ErrorCode::FileSyntax, "the file ends without the section ", keyword,
                  ": it is incomplete.");
  }

  void readPoints() {
    beginSection(hasPoints_, "POINTS");
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

  /// Skips cells that are not read.
  void skipCells() {
    const auto kept = std::tuple(cells, offsets, stride, connectivity, gap);
    readCells();
    std::tie(cells, offsets, stride, connectivity, gap) = kept;
  }

  void readCells() {
    // Each takes at least one digit and a separator, or four bytes.
    const std::size_t first = scanner_.readCount("cells", 2);
    const std::size_t second = scanner_.readCount("numbers of cells", 2);
    const std::size_t before = scanner_.position();
    if (readKeyword() != "offsets") {
      scanner_.moveTo(before);
      cells = first;
      return readOldCells(second);
    }
    // From version 5 on: offsets including the end of the last cell, then all corners.
    cells = std::max<std::size_t>(first, 1) - 1;
    offsets = readIntegers(first, readType(), "an offset of a cell");
    if (readKeyword() != "connectivity") scanner_.failToken("\"CONNECTIVITY\"");
    connectivity = readIntegers(second, readType(), "a corner of a cell");
  }

  /// Up to version 4: each cell is its number of corners followed by these.
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
    // Usually all cells have the same number of corners.
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
        scanner_.fail(ErrorCode::FileSyntax, Place{PlaceKind::Cell, cell}, "cell ", cell, " of ",
                      cells, " goes beyond the ", numbers,
                      " numbers that the section CELLS announces.");
      }
      place += 1 + static_cast<std::size_t>(count);
    }
  }

  /// Reads one array, or the head of a field.
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
    scanner_.fail(ErrorCode::FileSyntax, "expected a keyword of point or cell data, found ",
                  quoted(std::string_view(keyword)), ".");
  }

  void beginArrays(bool ofCells) {
    ofCells_ = ofCells;
    const std::int64_t count = scanner_.integer("the number of values");
    if (count >= 0 && static_cast<std::uint64_t>(count) == elements()) return;
    scanner_.fail(ErrorCode::FileSyntax, "the arrays are for ", count,
                  (ofCells ? " cells" : " points"), ", but the file has ", elements(), ".");
  }

  /// Reads "SCALARS name type components", where the last is optional, and the name of a lookup
  /// table.
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

  /// Reads the numbers of an array. Arrays before the mesh's sections are skipped.
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
      arrays.push_back(
          {ofCells_ ? VtkSection::CellData : VtkSection::PointData, decodedVtkName(name),
           isReal(type.scalar) ? VtkNumbers::Reals : VtkNumbers::Integers, components, false,
           [this, begin, count, &type](VtkNumbers numbers, auto&&) {
             scanner_.moveTo(begin);
             return readNumbers(count, type, numbers,
                                [](std::size_t) { return NumberName("a number of an array"); });
           }});
    }
    skipNumbers(count, type);
  }

  /// Reads a keyword in any letter case; returns it in lower case.
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

  /// Skips the bytes of `count` numbers, which begin on the next line.
  /// @return their position
  std::size_t takeBytes(std::size_t count, std::size_t bytesEach) {
    scanner_.skipLineBreak();
    const std::size_t begin = scanner_.position();
    const std::size_t left = text().size() - begin;
    if (count > left / bytesEach) {
      scanner_.fail(ErrorCode::FileSyntax, count, " numbers of ", bytesEach,
                    " bytes are announced, but only ", left,
                    " bytes are left: the file is incomplete.");
    }
    scanner_.moveTo(begin + count * bytesEach);
    return begin;
  }

  /// @param what  for messages: what(i) names number i
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
    scanner_.elements(count, 1, [&](TextScanner& scanner, std::size_t i) {
      readVtkNumber(scanner, numbers, column, i, what(i));
    });
    return column;
  }

  VtkColumn readIntegers(std::size_t count, const NumberType& type, std::string_view what) {
    if (!isOf<std::int32_t>(type.scalar) && !isOf<std::int64_t>(type.scalar)) {
      scanner_.fail(ErrorCode::FileUnsupported, what, " cannot be of type ", type.name,
                    ", only int or vtktypeint64.");
    }
    return readNumbers(count, type, VtkNumbers::Integers, [what](std::size_t) { return what; });
  }

  void skipNumbers(std::size_t count, const NumberType& type) {
    if (!binary_) {
      scanner_.skipTokens(count);
      return;
    }
    if (type.name == "string") {
      scanner_.fail(ErrorCode::FileUnsupported,
                    "an array of strings has no known length in bytes; save the file without it.");
    }
    static_cast<void>(type.name == "bit" ? takeBytes((count + 7) / 8, 1)
                                         : takeBytes(count, bytesOf(type.scalar)));
  }

  /// The number of points or cells, whichever the current arrays belong to.
  [[nodiscard]] std::size_t elements() const { return ofCells_ ? cells : points; }

  Stage& stage_;
  TextSource scanner_;
  bool binary_ = false;
  bool hasPoints_ = false;
  bool hasCells_ = false;
  bool hasTypes_ = false;
  bool ofCells_ = false;         ///< whether arrays belong to cells rather than points
  std::size_t fieldArrays_ = 0;  ///< arrays left in the current field
};

}  // namespace

std::unique_ptr<VtkSource> openVtkLegacyFile(const Input& input, bool withRegions, Stage& stage) {
  VtkFileBytes bytes;
  bytes.text = input.text(bytes.room, stage, "#");
  auto file = std::make_unique<VtkLegacyFile>(std::move(bytes), input.name(), stage);
  file->counts = input.counts();
  file->others = input.others();
  if (withRegions) file->readRegions();
  return file;
}

bool holdsVtkLegacySurface(const Input& input) {
  // The title, which comes before, has at most 256 characters.
  constexpr std::size_t kTitleRoom = 1024;
  return lowerCase(firstBytes(input, kTitleRoom)).find("dataset polydata") != std::string::npos;
}

namespace {

// Streaming of versions up to 4.

/// Finds the sections POINTS, CELLS and CELL_TYPES, in this order, with hexahedra only. Arrays may
/// follow.
class VtkPieces {
 public:
  VtkPieces(const ByteFile& file, Context& context, bool isText)
      : file_(file),
        context_(context),
        text_(file, context, isText ? TextWindow::kText : TextWindow::kWords) {
    layout.isText = isText;
  }

  /// @return whether the file has this layout
  [[nodiscard]] bool look() {
    constexpr std::uint64_t kNumbers = 1 + 8;  // per cell: the number of corners, and these
    if (!lookAtHead() || !isNext("points") || !takeCount(layout.points.count)) return false;
    const std::string type = lowerCase(text_.token());
    if (type != "float" && type != "double") return false;
    layout.coordinateBytes = type == "float" ? 4 : 8;
    if (!skip(layout.points, 3, layout.coordinateBytes) || !isNext("cells") ||
        !takeCount(layout.cells.count) || text_.count() != kNumbers * layout.cells.count) {
      return false;
    }
    return skip(layout.cells, kNumbers, 4) && isNext("cell_types") &&
           text_.count() == layout.cells.count && areHexahedra();
  }

  PlainLayout layout{
      .isBigEndian = true, .firstVertex = 0, .inFrontOfCell = 1, .tellsCorners = true};

 private:
  /// Reads everything before the first section.
  [[nodiscard]] bool lookAtHead() {
    const std::string magic = text_.takeLine();
    constexpr std::string_view kMagic = "# vtk DataFile Version ";
    // From version 5 on, cells are stored differently.
    if (!magic.starts_with(kMagic) || magic.size() == kMagic.size() || magic[kMagic.size()] < '1' ||
        magic[kMagic.size()] > '4') {
      return false;
    }
    static_cast<void>(text_.takeLine());  // the title, any text
    return isNext(layout.isText ? "ascii" : "binary") && isNext("dataset") &&
           isNext("unstructured_grid");
  }
  [[nodiscard]] bool isNext(std::string_view keyword) {
    return lowerCase(text_.token()) == keyword;
  }
  [[nodiscard]] bool takeCount(std::uint64_t& to) {
    const std::optional<std::uint64_t> found = text_.count();
    to = found.value_or(0);
    return found.has_value();
  }
  /// Records the position of a run and skips it. Binary data begins on the next line.
  [[nodiscard]] bool skip(PlainRun& run, std::uint64_t numbersEach, std::uint64_t bytesEach) {
    const std::uint64_t numbers = numbersEach * run.count;
    if (!layout.isText && !text_.skipLineBreak()) return false;
    run.position = text_.position();
    if (layout.isText) return text_.skip(numbers);
    if (numbers > (file_.size() - run.position) / bytesEach) return false;
    text_.moveTo(run.position + numbers * bytesEach);
    return true;
  }

  [[nodiscard]] bool areHexahedra() {
    PlainRun types{0, layout.cells.count};
    if (!layout.isText && !skip(types, 1, 4)) return false;
    std::atomic<bool> all{true};
    Array<char> bytes;
    for (std::uint64_t first = 0; first < types.count && all; first += kPieceElements) {
      const std::size_t count = std::min<std::uint64_t>(kPieceElements, types.count - first);
      if (layout.isText) {
        text_.elements(count, 1, [&](TextScanner& scanner, std::size_t) {
          if (scanner.integer("the type of a cell") != kCellKind<8>.vtkType) all = false;
        });
        continue;
      }
      context_.throwIfCancelled();
      bytes.resize(4 * count);
      file_.readAt(types.position + 4 * first, bytes.data(), bytes.size());
      for (std::size_t i = 0; i < count; ++i) {
        if (loadBig<std::int32_t>(bytes.data() + 4 * i) != kCellKind<8>.vtkType) return false;
      }
    }
    return all;
  }

  const ByteFile& file_;
  Context& context_;
  TextWindow text_;
};

std::optional<PlainLayout> lookAtVtk(const ByteFile& file, Context& context) {
  for (const bool isText : {false, true}) {
    VtkPieces pieces(file, context, isText);
    if (pieces.look()) return pieces.layout;
  }
  return {};
}

}  // namespace

void readVtkLegacyTo(MeshSink& sink, const Input& input, Context& context) {
  readPlainMesh({lookAtVtk, readVtkLegacy}, sink, input, context);
}

namespace {

// Writing. A mesh or map in memory is written like a mesh of one piece.

/// Text, in the form of version 2.0, which every program reads.
struct VtkText {
  static constexpr std::string_view kEncoding = "ASCII";
  static constexpr std::string_view kEndOfSection = {};
  static constexpr std::size_t kRoom = kNumberRoom + 1;  ///< per number

  template <class T, std::size_t n>
  static char* numbers(char* place, const std::array<T, n>& numbers) {
    return put(putNumbers(place, numbers), '\n');
  }
  template <class Vertex, std::size_t corners>
  static char* cell(char* place, const std::array<Vertex, corners>& cell) {
    return numbers(put(put(place, corners), ' '), cell);
  }
};

/// Big-endian binary numbers.
struct VtkBigBytes {
  static constexpr std::string_view kEncoding = "BINARY";
  static constexpr std::string_view kEndOfSection = "\n";
  static constexpr std::size_t kRoom = 8;

  template <class T>
  static char* number(char* place, T number) {
    return putBigBytes(place, number);
  }
  template <class T, std::size_t n>
  static char* numbers(char* place, const std::array<T, n>& numbers) {
    for (const T value : numbers) place = number(place, value);
    return place;
  }
  template <class Vertex, std::size_t corners>
  static char* cell(char* place, const std::array<Vertex, corners>& cell) {
    place = number(place, static_cast<std::uint32_t>(corners));
    for (const Vertex vertex : cell) place = number(place, static_cast<std::uint32_t>(vertex));
    return place;
  }
};

/// Writes the sections of a file in order, for hexahedra, possibly in pieces, or for the tets of a
/// map.
template <class Numbers, std::size_t corners = 8>
class LegacyWriter {
 public:
  LegacyWriter(OutputFile& output, int threads) : output_(output), lines_(output, threads) {}

  /// Writes everything before the points.
  /// @throws Error TooLarge if there are more points than 32-bit indices can number
  /// @param others  written after the cells
  void begin(std::uint64_t points, std::uint64_t cells, const OtherCells& others = noOthers()) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
    if (Numbers::kEncoding == VtkBigBytes::kEncoding && points > kMost) {
      throw Error(ErrorCode::TooLarge,
                  concat(output_.target(),
                         ": legacy binary .vtk files have vertex numbers of 31 bits, which do not "
                         "suffice for ",
                         points, " points; write .vtu."));
    }
    cellCount_ = cells + others.count();
    others_ = &others;
    output_.write("# vtk DataFile Version 2.0\n");
    output_.write(corners == 8 ? "hexahedral mesh by hexhex\n" : "integer-grid map by hexhex\n");
    output_.write(Numbers::kEncoding).write("\nDATASET UNSTRUCTURED_GRID\n");
    output_.write("POINTS ").write(points).write(" double\n");
  }
  void points(const PointPiece& piece) {
    rows(piece.points.size(), [&](std::size_t i) -> const Vec3& { return piece.points[i]; });
  }
  void beginCells() {
    output_.write(Numbers::kEndOfSection);
    output_.write("CELLS ").write(cellCount_);
    const std::uint64_t ofOthers = corners * others_->count();
    output_.write(' ')
        .write((corners + 1) * cellCount_ - ofOthers + endOf(*others_, cellCount_))
        .write('\n');
  }
  template <class Vertex>
  void cells(std::uint64_t /*first*/, std::span<const std::array<Vertex, corners>> cells) {
    writeCells(cells);
  }
  void types() {
    output_.write(Numbers::kEndOfSection);
    output_.write("CELL_TYPES ").write(cellCount_).write('\n');
    const auto write = [this](std::uint64_t count, std::int64_t type) {
      rows(count, [type](std::size_t) { return std::array{static_cast<std::uint32_t>(type)}; });
    };
    write(cellCount_ - others_->count(), kCellKind<corners>.vtkType);
    for (const OtherCellList& kind : others_->kinds) {
      write(kind.count(), typeWith(kind.corners).vtkType);
    }
    output_.write(Numbers::kEndOfSection);
  }
  /// Writes a cell array.
  /// @param head  the text after the number of cells
  template <class Row>
  void cellData(std::string_view head, const Row& row) {
    output_.write("CELL_DATA ").write(cellCount_).write(head);
    rows(cellCount_, row);
    output_.write(Numbers::kEndOfSection);
  }
  void end() { types(); }

  /// Writes everything up to the cell types; advances the progress from now on.
  void write(std::span<const Vec3> allPoints, std::span<const std::array<Index, corners>> allCells,
             const OtherCells& others, LoopProgress& progress) {
    progress_ = &progress;
    begin(allPoints.size(), allCells.size(), others);
    points({0, allPoints, {}, {}});
    beginCells();
    cells(0, allCells);
    forEachOtherKind(others, [this](auto ofKind) { this->writeCells(ofKind); });
    types();
  }

 private:
  template <class Cells>
  void writeCells(Cells cells) {
    lines_.write(
        cells.size(), (std::tuple_size_v<typename Cells::value_type> + 1) * Numbers::kRoom,
        [cells](char* place, std::size_t i) { return Numbers::cell(place, cells[i]); }, progress_);
  }
  /// Writes n rows: row(i) is an array of numbers.
  template <class Row>
  void rows(std::size_t n, const Row& row) {
    constexpr std::size_t kColumns = std::tuple_size_v<std::remove_cvref_t<decltype(row(n))>>;
    lines_.write(
        n, kColumns * Numbers::kRoom,
        [&row](char* place, std::size_t i) { return Numbers::numbers(place, row(i)); }, progress_);
  }

  OutputFile& output_;
  LineWriter lines_;
  std::uint64_t cellCount_ = 0;  ///< with others
  const OtherCells* others_ = &noOthers();
  LoopProgress* progress_ = nullptr;
};

/// Encodes an array name as a token, with other characters as "%20" like VTK.
std::string encodedName(std::string_view name) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  if (name.empty()) {
    throw Error(ErrorCode::InvalidArgument, "The name of the map's array is empty.");
  }
  std::string token;
  for (const char c : name) {
    if (c > ' ' && c <= '~' && c != '%' && c != '"') {
      token += c;
      continue;
    }
    const auto code = static_cast<unsigned char>(c);
    token += {'%', kDigits[code / 16U], kDigits[code % 16U]};
  }
  return token;
}

template <bool binary>
using LegacyNumbers = std::conditional_t<binary, VtkBigBytes, VtkText>;

}  // namespace

template <bool binary>
void VtkLegacyWriting<binary>::writeMesh(const HexMesh& mesh, OutputFile& output,
                                         const WriteOptions& options, Stage& stage) {
  LegacyWriter<LegacyNumbers<binary>> writer(output, stage.context().threads());
  const AllCells all(mesh, othersOf(options));
  const bool mixed = all.others().count() > 0;
  const Array<std::int32_t> ofAll = mixed ? all.regions() : Array<std::int32_t>();
  const std::span<const std::int32_t> regions = mixed ? ofAll : mesh.regions;
  LoopProgress progress(stage, mesh.points.size() + 2 * all.size() + regions.size());
  writer.write(mesh.points, mesh.cells, all.others(), progress);
  if (!regions.empty()) {
    writer.cellData("\nSCALARS region int 1\nLOOKUP_TABLE default\n",
                    [regions](std::size_t c) { return std::array{regions[c]}; });
  }
}

template <bool binary>
void VtkLegacyWriting<binary>::writeMap(const TetMap& map, OutputFile& output,
                                        const WriteOptions& options, Stage& stage) {
  const std::string name = encodedName(options.mapArray);
  LegacyWriter<LegacyNumbers<binary>, 4> writer(output, stage.context().threads());
  withThreads(stage.context().threads(), [&] { requireWritable(map, stage); });
  const std::size_t tets = map.tets.size();
  LoopProgress progress(stage, map.points.size() + 3 * tets);
  writer.write(map.points, map.tets, noOthers(), progress);
  writer.cellData(
      concat("\nFIELD FieldData 1\n", name, " 12 ", tets, " double\n"),
      [&map](std::size_t t) { return std::bit_cast<std::array<double, 12>>(map.parameters[t]); });
}

template <bool binary>
std::unique_ptr<MeshSink> VtkLegacyWriting<binary>::openSink(const std::filesystem::path& file,
                                                             Context& context) {
  return openWriterSink<LegacyWriter<LegacyNumbers<binary>>>(file, context);
}

template struct VtkLegacyWriting<false>;
template struct VtkLegacyWriting<true>;

}  // namespace hexhex::io
