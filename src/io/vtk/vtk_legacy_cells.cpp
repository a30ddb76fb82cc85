#include <algorithm>
#include <string>

#include <hexhex/error.hpp>

#include <base/parallel.hpp>
#include <io/vtk/vtk_legacy_cells.hpp>

namespace hexhex {

template <std::size_t corners>
void VtkLegacyCells<corners>::readCells() {
  TextScanner& scanner = source_.scanner();
  // Counted as numbers of one digit or four bytes.
  const std::size_t first = scanner.readCount("cells", 2);
  const std::size_t second = scanner.readCount("numbers of cells", 2);
  const std::size_t before = scanner.position();
  if (source_.readKeyword() == "offsets") return readNewCells(first, second);
  scanner.moveTo(before);
  readOldCells(first, second);
}

/// Up to version 4: each cell is its number of corners, and its corners.
template <std::size_t corners>
void VtkLegacyCells<corners>::readOldCells(std::size_t cells, std::size_t numbers) {
  cellCount_ = cells;
  if (source_.binary() && numbers == (corners + 1) * cells && takePlainCells(cells)) return;
  corners_ = source_.readIntegers(numbers, kVtkInt, "a corner of a cell");
  splitCells(numbers);
}

/// From version 5 on: where cells begin and the last one ends, and all corners.
template <std::size_t corners>
void VtkLegacyCells<corners>::readNewCells(std::size_t places, std::size_t numbers) {
  const VtkNumberType& type = source_.readType();
  const Array<std::int64_t> begins = source_.readIntegers(places, type, "an offset of a cell");
  if (source_.readKeyword() != "connectivity") source_.scanner().failToken("\"CONNECTIVITY\"");
  corners_ = source_.readIntegers(numbers, source_.readType(), "a corner of a cell");
  cells_.resize(std::max<std::size_t>(places, 1) - 1);
  cellCount_ = cells_.size();
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    const std::int64_t begin = begins[cell];
    const std::int64_t end = begins[cell + 1];
    if (begin < 0 || end < begin || static_cast<std::uint64_t>(end) > numbers) {
      source_.scanner().fail(ErrorCode::FileSyntax,
                             "the corners of cell " + std::to_string(cell) + " lie from " +
                                 std::to_string(begin) + " to " + std::to_string(end) + " of the " +
                                 std::to_string(numbers) + " corners, which cannot be.",
                             Place{PlaceKind::Cell, cell});
    }
    cells_[cell] = {static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)};
  }
}

template <std::size_t corners>
void VtkLegacyCells<corners>::readTypes() {
  const std::size_t count = source_.scanner().readCount("types of cells", 2);
  // None are plain for none: the cells may follow behind.
  if (source_.binary() && count > 0 && count == cellCount_ && takePlainTypes(count)) return;
  types_ = source_.readIntegers(count, kVtkInt, "the type of a cell");
}

/// Whether all cells have as many corners as are wanted, so that they need not be looked at one by
/// one. If not, nothing was read.
template <std::size_t corners>
bool VtkLegacyCells<corners>::takePlainCells(std::size_t cells) {
  const std::size_t before = source_.scanner().position();
  const char* const bytes = source_.takeBytes((corners + 1) * cells, kVtkInt.bytes);
  const std::size_t fault = firstFault(source_.stage(), cells, [&](std::size_t i) {
    return loadBig<std::int32_t>(bytes + kVtkInt.bytes * (corners + 1) * i) ==
           static_cast<std::int32_t>(corners);
  });
  if (fault < cells) {
    source_.scanner().moveTo(before);
    return false;
  }
  plainCells_ = bytes;
  return true;
}

/// Whether all cells are of the kind that is wanted. If not, nothing was read.
template <std::size_t corners>
bool VtkLegacyCells<corners>::takePlainTypes(std::size_t count) {
  const std::size_t before = source_.scanner().position();
  const char* const bytes = source_.takeBytes(count, kVtkInt.bytes);
  plainTypes_ = firstFault(source_.stage(), count, [&](std::size_t i) {
                  return loadBig<std::int32_t>(bytes + kVtkInt.bytes * i) == kKind.vtkType;
                }) == count;
  if (!plainTypes_) source_.scanner().moveTo(before);
  return plainTypes_;
}

/// Finds out where the corners of each cell are.
template <std::size_t corners>
void VtkLegacyCells<corners>::splitCells(std::size_t numbers) {
  const std::size_t cells = cellCount_;
  cells_.resize(cells);
  std::size_t place = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::int64_t count = place < numbers ? corners_[place] : -1;
    if (count < 0 || static_cast<std::uint64_t>(count) > numbers - place - 1) {
      source_.scanner().fail(ErrorCode::FileSyntax,
                             "cell " + std::to_string(cell) + " of " + std::to_string(cells) +
                                 " goes beyond the " + std::to_string(numbers) +
                                 " numbers that the section CELLS announces.",
                             Place{PlaceKind::Cell, cell});
    }
    cells_[cell] = {place + 1, static_cast<std::size_t>(count)};
    place += 1 + static_cast<std::size_t>(count);
  }
}

/// Cells that are plain but for their types.
template <std::size_t corners>
void VtkLegacyCells<corners>::splitPlainCells() {
  const std::size_t numbers = (corners + 1) * cellCount_;
  corners_.resize(numbers);
  parallelFor(source_.stage(), numbers, kVtkLegacyGrain, [&](std::size_t i) {
    corners_[i] = loadBig<std::int32_t>(plainCells_ + kVtkInt.bytes * i);
  });
  splitCells(numbers);
}

template <std::size_t corners>
void VtkLegacyCells<corners>::takeCells(Grid<corners>& grid) {
  if (plainTypes_ && plainCells_ != nullptr) return copyPlainCells(grid.mesh);
  if (plainCells_ != nullptr) splitPlainCells();
  if (plainTypes_) types_.assign(cellCount_, kKind.vtkType);
  if (types_.size() != cells_.size()) {
    source_.scanner().fail(ErrorCode::FileSyntax,
                           "the file has " + std::to_string(cells_.size()) + " cells but " +
                               std::to_string(types_.size()) + " types of cells.");
  }
  Array<std::size_t>& wanted = grid.cellInFile;
  for (std::size_t cell = 0; cell < types_.size(); ++cell) {
    if (types_[cell] == kKind.vtkType) wanted.push_back(cell);
  }
  if (wanted.empty() && !types_.empty()) {
    throw Error(ErrorCode::FileUnsupported, source_.scanner().fileName() + ": the file holds no " +
                                                std::string(kKind.plural) + " (cells of type " +
                                                std::to_string(kKind.vtkType) +
                                                "), but other cells only.");
  }
  const std::size_t points = grid.mesh.points.size();
  Array<Cell>& cells = grid.mesh.cells;
  cells.resize(wanted.size());
  const std::size_t fault = firstFault(
      source_.stage(), wanted.size(),
      [&](std::size_t i) { return takeCell(wanted[i], points, cells[i]); }, kVtkLegacyGrain);
  if (fault < wanted.size()) failAbout(wanted[fault], cells_[wanted[fault]].count, points);
}

/// Cells without anything special.
template <std::size_t corners>
void VtkLegacyCells<corners>::copyPlainCells(CellMesh<corners>& mesh) const {
  const std::uint64_t points = mesh.points.size();
  mesh.cells.resize(cellCount_);
  const std::size_t fault = firstFault(source_.stage(), cellCount_, [&](std::size_t i) {
    const char* const place = plainCells_ + kVtkInt.bytes * ((corners + 1) * i + 1);
    Index largest = 0;  // a negative number is a large one here
    for (std::size_t k = 0; k < corners; ++k) {
      mesh.cells[i][k] = loadBig<Index>(place + kVtkInt.bytes * k);
      largest = std::max(largest, mesh.cells[i][k]);
    }
    return largest < points;
  });
  if (fault < cellCount_) failAbout(fault, corners, mesh.points.size());
}

/// Whether the cell has all corners, which are points.
template <std::size_t corners>
bool VtkLegacyCells<corners>::takeCell(std::size_t cell, std::size_t points, Cell& corner) const {
  if (cells_[cell].count != corners) return false;
  for (std::size_t k = 0; k < corners; ++k) {
    const auto vertex = static_cast<std::uint64_t>(corners_[cells_[cell].begin + k]);
    if (vertex >= points) return false;
    corner[k] = static_cast<Index>(vertex);
  }
  return true;
}

template <std::size_t corners>
void VtkLegacyCells<corners>::failAbout(std::size_t cell, std::size_t count,
                                        std::size_t points) const {
  const std::string name = source_.scanner().fileName() + ": cell " + std::to_string(cell);
  const Place place{PlaceKind::Cell, cell};
  if (count != corners) {
    throw Error(ErrorCode::FileSyntax,
                name + " is a " + std::string(kKind.singular) + " with " + std::to_string(count) +
                    " instead of " + std::to_string(corners) + " corners.",
                place);
  }
  throw Error(ErrorCode::IndexOutOfRange,
              name + " names a point that does not exist: the file has " + std::to_string(points) +
                  " points, numbered from 0.",
              place);
}

template class VtkLegacyCells<4>;
template class VtkLegacyCells<8>;

}  // namespace hexhex
