// Hex cells, tet by tet in canonical order: read from the grid where the picture is whole, looked
// up tet by tet where it is not.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <atlas/brick_block.hpp>
#include <atlas/cell_walker.hpp>
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
      : map_(map),
        vertices_(vertices),
        cache_(vertices.grid()),
        walker_(map, vertices.charts()),
        tracer_(map) {}

  /// Writes the cells whose centres the tet owns, `count` of them.
  /// @param lines  the tet's lines of centres
  void emit(Index tet, std::span<const SweptLine> lines, std::span<Cell> cells);

  /// Cells so far with a corner that the picture hides.
  [[nodiscard]] std::uint64_t traced() const noexcept { return traced_; }

 private:
  /// One tet on its way.
  struct Job {
    const TetSweep& sweep;
    SweepFrame frame;
    CenterOwner owner;
    Cell* place;
  };

  [[nodiscard]] std::size_t load(const Job& job, std::span<const SweptLine> lines);
  void loadBox(const Job& job, const GridPoint& first, const GridPoint& last);
  void emitLine(Job& job, const SweptLine& line, std::uint32_t first, std::uint32_t count);
  void emitIrregular(const GridPoint& z, CornerMask generator, Cell& cell);

  const PreparedMap& map_;
  const VertexGrid<Id>& vertices_;
  BrickCache<Id> cache_;
  CellWalker walker_;
  CellTracer tracer_;
  std::uint64_t traced_ = 0;

  Index tet_ = 0;
  Index chart_ = 0;
  const Gauge* gauge_ = nullptr;
  BrickBlock<Id> block_;                     ///< the vertices around a few lines of cells
  std::array<std::ptrdiff_t, 8> corners_{};  ///< offsets of a cell's corners there
};

extern template class CellEmitter<std::uint32_t>;
extern template class CellEmitter<std::uint64_t>;

}  // namespace hexhex
