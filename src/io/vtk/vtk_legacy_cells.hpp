// The sections CELLS and CELL_TYPES of legacy VTK files, and the cells of one kind among them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <hexhex/types.hpp>

#include <io/core/cell_mesh.hpp>
#include <io/core/grid_map.hpp>
#include <io/vtk/vtk_legacy_source.hpp>

namespace hexhex {

/// Reads both sections, in any order, and takes the cells with so many corners, hexahedra or tets.
///
/// Integers go through a plain array, as text and bytes, old and new layouts differ in nothing but
/// how they fill it. The usual bytes, of which nothing has to be sorted out, go without.
template <std::size_t corners>
class VtkLegacyCells {
 public:
  /// @param source  must outlive this
  explicit VtkLegacyCells(VtkLegacySource& source) : source_(source) {}

  /// Read a section behind its keyword.
  /// @throws Error FileSyntax, FileUnsupported
  void readCells();
  void readTypes();

  /// Number of cells of all kinds.
  [[nodiscard]] std::size_t count() const noexcept { return cellCount_; }

  /// Takes the cells, after both sections and the points of the grid were read.
  /// @throws Error FileSyntax; FileUnsupported if all cells are of other kinds; IndexOutOfRange
  void takeCells(Grid<corners>& grid);

 private:
  static constexpr CellKind kKind = kCellKind<corners>;
  using Cell = std::array<Index, corners>;

  /// Where the corners of a cell are.
  struct CellCorners {
    std::size_t begin;
    std::size_t count;
  };

  void readOldCells(std::size_t cells, std::size_t numbers);
  void readNewCells(std::size_t places, std::size_t numbers);
  [[nodiscard]] bool takePlainCells(std::size_t cells);
  [[nodiscard]] bool takePlainTypes(std::size_t count);
  void splitCells(std::size_t numbers);
  void splitPlainCells();
  void copyPlainCells(CellMesh<corners>& mesh) const;
  [[nodiscard]] bool takeCell(std::size_t cell, std::size_t points, Cell& corner) const;
  [[noreturn]] void failAbout(std::size_t cell, std::size_t count, std::size_t points) const;

  VtkLegacySource& source_;
  std::size_t cellCount_ = 0;
  /// The usual bytes: each cell has as many corners as are wanted. Null otherwise.
  const char* plainCells_ = nullptr;
  bool plainTypes_ = false;  ///< all cells are of the kind that is wanted
  Array<std::int64_t> corners_;
  Array<CellCorners> cells_;
  Array<std::int64_t> types_;
};

extern template class VtkLegacyCells<4>;
extern template class VtkLegacyCells<8>;

}  // namespace hexhex
