// Hex cells, tet by tet in canonical order: read from the grid of the tet's chart; where a cut may
// come in between, CornerResolver is asked.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

#include <atlas/brick_grid.hpp>
#include <atlas/corner_resolver.hpp>
#include <atlas/vertex_grid.hpp>
#include <sweep/cell_centers.hpp>

namespace hexhex::atlas {

/// Emits the cells of one tet after another. One per thread.
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

  /// Writes the cells whose centres the tet owns: as many as there are elements.
  /// @param lines  the tet's lines of centres
  /// @return how many have a corner that their chart does not show
  std::uint64_t emit(Index tet, std::span<const lattice::SweptLine> lines, std::span<Cell> cells);
  /// Writes consecutive cells with centres on one of the tet's lines, whoever owns these.
  /// @param first  of the centres
  /// @return likewise
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
    /// From the first of the four rows of points around a line of cells to each of them.
    std::array<lattice::ChartPoint, 4> rows{};
    std::array<std::ptrdiff_t, 4> strides{};  ///< the same as places in a brick
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
