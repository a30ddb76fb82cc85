// Hex cells, tet by tet in canonical order: read from the grid where the picture is whole, traced
// where it is not.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <atlas/vertex_grid.hpp>
#include <sweep/cell_seeds.hpp>
#include <sweep/cell_tracer.hpp>

#include <hexhex/types.hpp>

namespace hexhex {

/// Emits the cells of one tet after another. One per thread.
template <class Id>
class CellEmitter {
 public:
  using Cell = std::array<Id, 8>;

  CellEmitter(const PreparedMap& map, const VertexGrid<Id>& vertices)
      : map_(map), vertices_(vertices), cache_(vertices.grid()), tracer_(map) {}

  /// Writes the cells whose centres the tet owns, `count` of them.
  /// @param lines  the tet's lines of centres
  void emit(Index tet, std::span<const SweptLine> lines, std::span<Cell> cells);

  /// Cells that had to be traced so far.
  [[nodiscard]] std::uint64_t traced() const noexcept { return traced_; }

 private:
  /// The four rows of vertices around a line of centres, and which cells are irregular.
  void gather(const TetSweep& sweep, const SweptLine& line, std::uint32_t first,
              std::uint32_t count);
  void gatherRow(const ChartRow& row, Id* ids);
  void gatherMarks(const ChartRow& row);
  void traceCell(const GridPoint& z, CornerMask generator, Cell& cell);

  const PreparedMap& map_;
  const VertexGrid<Id>& vertices_;
  BrickCache<Id> cache_;
  CellTracer tracer_;
  std::uint64_t traced_ = 0;

  Index tet_ = 0;
  Index chart_ = 0;
  const Gauge* gauge_ = nullptr;
  std::array<std::vector<Id>, 4> rows_;
  std::vector<std::uint8_t> irregular_;  ///< per cell of the line
  bool anyIrregular_ = false;
};

extern template class CellEmitter<std::uint32_t>;
extern template class CellEmitter<std::uint64_t>;

}  // namespace hexhex
