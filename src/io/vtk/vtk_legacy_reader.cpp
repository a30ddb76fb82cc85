// The reading half of vtk_legacy.hpp: the sections of a file, in any order.
#include <cstdint>
#include <string>
#include <utility>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/core/cell_mesh.hpp>
#include <io/core/grid_map.hpp>
#include <io/core/input_file.hpp>
#include <io/core/writable.hpp>
#include <io/vtk/vtk_legacy.hpp>
#include <io/vtk/vtk_legacy_arrays.hpp>
#include <io/vtk/vtk_legacy_cells.hpp>
#include <io/vtk/vtk_legacy_source.hpp>

namespace hexhex {
namespace {

/// Points as bytes.
Array<Vec3> readVtkPointBytes(VtkLegacySource& source, std::size_t count, std::size_t bytesEach) {
  const char* const bytes = source.takeBytes(3 * count, bytesEach);
  Array<Vec3> points(count);
  parallelFor(source.stage(), count, kVtkLegacyGrain, [&](std::size_t i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const char* const place = bytes + (3 * i + k) * bytesEach;
      points[i][k] = bytesEach == 8 ? loadBig<double>(place) : loadBig<float>(place);
    }
  });
  const std::size_t wrong = firstNotFinite(points, source.stage());
  if (wrong == count) return points;
  const auto begin = static_cast<std::size_t>(bytes - source.text().data());
  throw Error(ErrorCode::NotFinite,
              source.scanner().fileName() + ", byte " +
                  std::to_string(begin + 3 * wrong * bytesEach) + ": a coordinate of point " +
                  std::to_string(wrong) + " is not finite.",
              Place{PlaceKind::Vertex, wrong});
}

/// The section POINTS, behind its keyword.
Array<Vec3> readVtkPoints(VtkLegacySource& source) {
  const std::size_t count = source.scanner().readCount("points", 6);
  const VtkNumberType& type = source.readType();
  if (type.kind != VtkNumberType::Kind::Float) {
    source.scanner().fail(ErrorCode::FileUnsupported,
                          "the coordinates of points must be float or double.");
  }
  if (source.binary()) return readVtkPointBytes(source, count, type.bytes);
  Array<Vec3> points(count);
  source.readAsText(count, 3, [&points](TextScanner& scanner, std::size_t i) {
    for (double& coordinate : points[i]) {
      if (scanner.readNumber(coordinate)) continue;
      scanner.failNumber("a coordinate of point " + std::to_string(i));
    }
  });
  return points;
}

/// Reads one file from top to bottom.
template <std::size_t corners>
class VtkLegacyReader {
 public:
  /// @param mapArray  the name of the map's array; empty: arrays are not read
  VtkLegacyReader(std::string_view text, const std::string& fileName, Stage& stage,
                  std::string_view mapArray = {})
      : source_(text, fileName, stage), cells_(source_), arrays_(source_, mapArray) {}
  // Parts know each other by their place.
  VtkLegacyReader(const VtkLegacyReader&) = delete;
  VtkLegacyReader& operator=(const VtkLegacyReader&) = delete;

  Grid<corners> read();

 private:
  void readSection(const std::string& keyword);
  void beginSection(bool& present, std::string_view keyword);
  void require(bool present, std::string_view keyword);
  void readRegions();

  VtkLegacySource source_;
  VtkLegacyCells<corners> cells_;
  VtkLegacyArrays arrays_;
  bool hasPoints_ = false;
  bool hasCells_ = false;
  bool hasTypes_ = false;
  Grid<corners> grid_;
};

template <std::size_t corners>
Grid<corners> VtkLegacyReader<corners>::read() {
  source_.readHead();
  // What follows the three sections are arrays.
  while (!(hasPoints_ && hasCells_ && hasTypes_) && source_.scanner().skipSpace()) {
    readSection(source_.readKeyword());
  }
  require(hasPoints_, "POINTS");
  require(hasCells_, "CELLS");
  require(hasTypes_, "CELL_TYPES");
  cells_.takeCells(grid_);
  if (corners == 8) readRegions();
  grid_.map = arrays_.readMap(grid_.mesh.points.size(), cells_.count());
  grid_.arrays = arrays_.seen();
  return std::move(grid_);
}

template <std::size_t corners>
void VtkLegacyReader<corners>::readSection(const std::string& keyword) {
  if (keyword == "points") {
    beginSection(hasPoints_, "POINTS");
    grid_.mesh.points = readVtkPoints(source_);
  } else if (keyword == "cells") {
    beginSection(hasCells_, "CELLS");
    cells_.readCells();
  } else if (keyword == "cell_types") {
    beginSection(hasTypes_, "CELL_TYPES");
    cells_.readTypes();
  } else if (keyword == "field") {
    arrays_.readField();
  } else if (keyword == "metadata") {
    source_.skipMetadata();
  } else {
    source_.scanner().failToken("POINTS, CELLS or CELL_TYPES");
  }
}

/// Notes that a section is there, unless it was before.
template <std::size_t corners>
void VtkLegacyReader<corners>::beginSection(bool& present, std::string_view keyword) {
  source_.scanner().failIfRepeated(present, keyword);
  present = true;
}

template <std::size_t corners>
void VtkLegacyReader<corners>::require(bool present, std::string_view keyword) {
  if (present) return;
  source_.scanner().fail(ErrorCode::FileSyntax, "the file ends without the section " +
                                                    std::string(keyword) + ": it is incomplete.");
}

/// Reads the regions of hexahedra if they follow as this library writes them.
template <std::size_t corners>
void VtkLegacyReader<corners>::readRegions() {
  TextScanner& scanner = source_.scanner();
  CellMesh<corners>& mesh = grid_.mesh;
  const std::string begin = "CELL_DATA " + std::to_string(cells_.count()) +
                            "\nSCALARS region int 1\nLOOKUP_TABLE default";
  if (!scanner.skipSpace() || mesh.cells.size() != cells_.count() ||
      !source_.text().substr(scanner.position()).starts_with(begin)) {
    return;
  }
  scanner.moveTo(scanner.position() + begin.size());
  const Array<std::int64_t> numbers = source_.readIntegers(cells_.count(), kVtkInt, "a region");
  mesh.regions.resize(numbers.size());
  const std::size_t fault = firstFault(source_.stage(), numbers.size(), [&](std::size_t i) {
    mesh.regions[i] = static_cast<std::int32_t>(numbers[i]);
    return std::in_range<std::int32_t>(numbers[i]);
  });
  if (fault == numbers.size()) return;
  scanner.fail(ErrorCode::FileUnsupported,
               "the region " + std::to_string(numbers[fault]) + " does not fit into 32 bits.",
               Place{PlaceKind::Cell, fault});
}

/// Reads the tets of a file and its map.
class VtkLegacyMapReader {
 public:
  VtkLegacyMapReader(std::string_view text, const std::string& fileName, Stage& stage,
                     std::string_view mapArray)
      : grid_(text, fileName, stage, mapArray),
        fileName_(fileName),
        stage_(stage),
        mapArray_(mapArray) {}
  TetMap read() { return toTetMap(grid_.read(), mapArray_, fileName_, stage_); }

 private:
  VtkLegacyReader<4> grid_;
  const std::string& fileName_;
  Stage& stage_;
  std::string_view mapArray_;
};

}  // namespace

HexMesh parseVtkLegacy(std::string_view text, const std::string& fileName, Context& context) {
  return toHexMesh(parseWith<VtkLegacyReader<8>>(text, fileName, "read mesh", context).mesh);
}

HexMesh readVtkLegacy(const std::filesystem::path& file, Context& context) {
  return toHexMesh(readWith<VtkLegacyReader<8>>(file, "read mesh", context).mesh);
}

TetCells parseVtkLegacyTets(std::string_view text, const std::string& fileName, Context& context) {
  return parseWith<VtkLegacyReader<4>>(text, fileName, "read tets", context).mesh;
}

TetCells readVtkLegacyTets(const std::filesystem::path& file, Context& context) {
  return readWith<VtkLegacyReader<4>>(file, "read tets", context).mesh;
}

TetMap parseVtkLegacyMap(std::string_view text, const std::string& fileName,
                         const ReadOptions& options, Context& context) {
  return parseWith<VtkLegacyMapReader>(text, fileName, "read map", context, options.mapArray);
}

TetMap readVtkLegacyMap(const std::filesystem::path& file, const ReadOptions& options,
                        Context& context) {
  return readWith<VtkLegacyMapReader>(file, "read map", context, options.mapArray);
}

}  // namespace hexhex
