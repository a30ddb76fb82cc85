// Which vertices lie at those corners of a cell that its chart may not show, because the cell meets
// a cut or its tet has no chart.
//
// 1. Look across one cut. If all cuts recorded in front of a corner have the same transition, and
//    all those recorded at the cell's image on the other side have its inverse, the half diagonal
//    ends in one of these two charts; if only one of them shows a vertex there, or both show the
//    same, that is it. Without this step whole extractions take up to 27 % longer (s17c_sphere_r10;
//    5 to 12 % on most maps; switch lookAcrossCuts, docs/results/ablation.md).
// 2. Trace. Where several cuts meet, or the two charts show different vertices, the half diagonal
//    is followed exactly, tet by tet. (Walking to all such corners of a cell at once, in floating
//    point, gained nothing.)
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include <hexhex/types.hpp>

#include <atlas/brick_grid.hpp>
#include <atlas/cut_marks.hpp>
#include <atlas/vertex_grid.hpp>
#include <sweep/cell_order.hpp>
#include <sweep/cell_tracer.hpp>

namespace hexhex::atlas {

/// A cell, as seen by the tet that owns its centre.
struct CellInQuestion {
  Index tet;
  const lattice::SweptLine* centers;  ///< a line of the tet's sweep over centres
  std::uint32_t index;                ///< of the cell's centre in that line
  lattice::ChartPoint place;          ///< the cell's smallest corner in the tet's chart
  CutCell cuts;                       ///< recorded there: corners behind them are in question
};

/// Resolves the corners of one cell after the other. One per thread.
template <class Id>
class CornerResolver {
 public:
  using Cell = std::array<Id, 8>;

  CornerResolver(const igm::PreparedMap& map, const VertexGrid<Id>& vertices,
                 const CutTransitions& transitions, bool lookAcrossCuts)
      : vertices_(vertices),
        transitions_(transitions),
        lookAcrossCuts_(lookAcrossCuts),
        tracer_(map) {}

  /// Finds the vertices at the corners in question.
  /// @param cell  what the tet's chart shows at each corner; receives the vertices that are there
  /// @param cache  of the vertex grid
  /// @return whether the chart showed something else
  bool resolve(const CellInQuestion& question, Cell& cell, BrickCache<Id>& cache);

 private:
  /// A cell on the other side of a cut.
  struct Image {
    CutTransitionId id = kNoCut;         ///< leads there
    const CutTransition* map = nullptr;  ///< null if it is uncertain where it leads
    lattice::ChartPoint place{};         ///< smallest corner
    CutCell cuts;                        ///< recorded there
  };

  [[nodiscard]] lattice::CellCornerSet lookAcross(const CellInQuestion& question, Cell& cell,
                                                  BrickCache<Id>& cache);
  [[nodiscard]] Image imageAcross(CutTransitionId id, const lattice::ChartPoint& place,
                                  BrickCache<Id>& cache);
  [[nodiscard]] std::optional<Id> shownBeyond(const Image& image, std::size_t corner,
                                              BrickCache<Id>& cache);
  void trace(const CellInQuestion& question, lattice::CellCornerSet corners, Cell& cell,
             BrickCache<Id>& cache);

  const VertexGrid<Id>& vertices_;
  const CutTransitions& transitions_;
  bool lookAcrossCuts_;
  sweep::CellTracer tracer_;
};

extern template class CornerResolver<std::uint32_t>;
extern template class CornerResolver<std::uint64_t>;

// Hex cells, tet by tet in canonical order: read from the grid of the tet's chart, and resolved by
// CornerResolver where a cut may come in between.

/// Emits the cells of one tet after the other. One per thread.
template <class Id>
class CellEmitter {
 public:
  using Cell = std::array<Id, 8>;

  CellEmitter(const igm::PreparedMap& map, const VertexGrid<Id>& vertices,
              const CutTransitions& transitions, bool lookAcrossCuts)
      : topology_(map.topology),
        charts_(vertices.charts()),
        cache_(vertices.grid()),
        resolver_(map, vertices, transitions, lookAcrossCuts) {}

  /// Writes the cells whose centres the tet owns; there are as many as elements of `cells`.
  /// @param lines  the tet's lines of centres
  /// @return how many have a corner that their chart does not show
  std::uint64_t emit(Index tet, std::span<const lattice::SweptLine> lines, std::span<Cell> cells);
  /// Writes consecutive cells with centres on one of the tet's lines, whoever owns these.
  /// @param first  index of the first centre
  /// @return as emit()
  std::uint64_t emitOn(Index tet, const lattice::SweptLine& line, std::uint32_t first,
                       std::span<Cell> cells) {
    return emitSome(frameOf(tet, line.axes), {line, first, cells});
  }

 private:
  /// A tet in its chart.
  struct Frame {
    Index tet;
    Index chart;
    SweepFrame sweep;
    /// Offsets from the first of the four rows of points around a line of cells to each of them.
    std::array<lattice::ChartPoint, 4> rows{};
    std::array<std::ptrdiff_t, 4> strides{};  ///< the same, in places of a brick
    lattice::ChartPoint toSmallest{};  ///< from a cell's first corner in the sweep to its smallest
  };
  /// Consecutive cells of a line of centres.
  struct Cells {
    const lattice::SweptLine& line;
    std::uint32_t first;
    std::span<Cell> corners;
  };

  [[nodiscard]] Frame frameOf(Index tet, lattice::SweepAxes axes) const;
  std::uint64_t emitSome(const Frame& frame, const Cells& cells) {
    return frame.chart != Charts::kNoChart ? emitLine(frame, cells)
                                           : emitWithoutChart(frame, cells);
  }
  std::uint64_t emitLine(const Frame& frame, const Cells& cells);
  std::uint64_t emitWithoutChart(const Frame& frame, const Cells& cells);
  template <std::size_t Permutation>
  bool readCells(const Frame& frame, const ChartRow& row, const Cells& cells);
  std::array<const Id*, 4> rowsAt(const Frame& frame, const lattice::ChartPoint& c, bool& isCut);
  std::uint64_t resolveCells(const Frame& frame, const ChartRow& row, const Cells& cells);

  const adjacency::TetTopology& topology_;
  const Charts& charts_;
  BrickCache<Id> cache_;
  CornerResolver<Id> resolver_;
};

extern template class CellEmitter<std::uint32_t>;
extern template class CellEmitter<std::uint64_t>;

}  // namespace hexhex::atlas
