// Hex cells, tet by tet in canonical order: read from the grid where the picture is whole, looked
// up tet by tet where it is not.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

#include <atlas/brick_grid.hpp>
#include <atlas/cell_walker.hpp>
#include <atlas/vertex_grid.hpp>
#include <sweep/cell_seeds.hpp>
#include <sweep/cell_tracer.hpp>

namespace hexhex {

/// Emits the cells of one tet after another. One per thread.
template <class Id>
class CellEmitter {
 public:
  using Cell = std::array<Id, 8>;

  CellEmitter(const PreparedMap& map, const VertexGrid<Id>& vertices, const Jumps& jumps)
      : map_(map),
        vertices_(vertices),
        jumps_(jumps),
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
    SweepFrame frame;
    CenterOwner owner;
    Cell* place;
    /// From the first of the four rows of points around a line of cells to the others.
    std::array<ChartPoint, 4> rows;
    std::array<std::ptrdiff_t, 4> strides;  ///< the same as places in a brick
    /// From the first corner of a cell to its smallest one in the chart, where cuts are noted.
    ChartPoint toSmallest;
  };
  /// What there is to say of a line of cells that was read.
  struct Flags {
    bool special = false;  ///< some corner may be no vertex
    bool cut = false;      ///< some brick around has cut cells
  };

  /// A cell as the picture on the other side of a cut shows it.
  struct OtherSide {
    JumpId jump = kNoJump;  ///< leads there
    JumpId back = kNoJump;
    Rotation rotation;
    Index chart = 0;
    ChartPoint cell{};                 ///< its smallest corner there
    const Brick<Id>* brick = nullptr;  ///< of that corner; null if nothing is known of cuts there
    CutCell cut;                       ///< what is known
    bool inOneBrick = false;           ///< and of all others
  };

  void emitLine(Job& job, const SweptLine& line, std::uint32_t first, std::uint32_t count);
  template <std::size_t Permutation>
  [[nodiscard]] Flags readLine(const Job& job, const ChartRow& row, Cell* cells);
  [[nodiscard]] std::array<const Id*, 4> rowsAt(const Job& job, const ChartPoint& c, bool& cut);
  void mendLine(const Job& job, const SweptLine& line, std::uint32_t first, ChartRow row,
                bool special, Cell* cells);
  [[nodiscard]] CellCornerSet lookAcross(const ChartPoint& c, const CutCell& cut, Cell& cell,
                                         bool& hidden);
  [[nodiscard]] OtherSide otherSide(const ChartPoint& c, JumpId id);
  [[nodiscard]] Id vertexBeyond(const OtherSide& other, std::size_t corner);
  bool emitIrregular(const GridPoint& z, CornerMask generator, CellCornerSet corners, Cell& cell);

  const PreparedMap& map_;
  const VertexGrid<Id>& vertices_;
  const Jumps& jumps_;
  BrickCache<Id> cache_;
  CellWalker walker_;
  CellTracer tracer_;
  std::uint64_t traced_ = 0;

  Index tet_ = 0;
  Index chart_ = 0;
};

extern template class CellEmitter<std::uint32_t>;
extern template class CellEmitter<std::uint64_t>;

}  // namespace hexhex
