// Which vertices lie at the corners of a cell that its chart may not show: for a cell that meets a
// cut, or whose tet has no chart.
//
// 1. Look across one cut. If all cuts noted in front of a corner have the same transition, and all
//    those noted at the cell's image on the other side have its inverse, the half diagonal ends in
//    one of these two charts; if just one of them shows a vertex there, or both the same, that is
//    it. Without this step whole extractions take up to 27 % longer (s17c_sphere_r10; 5 to 12 % on
//    most maps; switch lookAcrossCuts, docs/ablation.md).
// 2. Trace. Where several cuts come together, or both charts show something else, the half diagonal
//    is followed exactly, tet by tet. (To walk to all such corners of a cell at once, in floating
//    point, gained nothing.)
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <hexhex/types.hpp>

#include <atlas/cut_marks.hpp>
#include <atlas/vertex_grid.hpp>
#include <sweep/cell_tracer.hpp>

namespace hexhex::atlas {

/// A cell, as the tet that owns its centre sees it.
struct CellInQuestion {
  Index tet;
  const lattice::SweptLine* centers;  ///< a line of the tet's sweep over centres
  std::uint32_t index;                ///< of the cell's centre in that line
  lattice::ChartPoint place;          ///< the cell's smallest corner in the tet's chart
  CutCell cuts;                       ///< noted there: corners behind them are in question
};

/// Answers for one cell after the other. One per thread.
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
  /// @param cache  of the vertices' grid
  /// @return whether the chart showed something else
  bool resolve(const CellInQuestion& question, Cell& cell, BrickCache<Id>& cache);

 private:
  /// A cell on the other side of a cut.
  struct Image {
    CutTransitionId id = kNoCut;         ///< leads there
    const CutTransition* map = nullptr;  ///< null if it leads to no certain place
    lattice::ChartPoint place{};         ///< smallest corner
    CutCell cuts;                        ///< noted there
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

}  // namespace hexhex::atlas
