// All hex vertices in the charts of the atlas.
#pragma once

#include <cassert>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <atlas/brick_grid.hpp>
#include <atlas/charts.hpp>
#include <atlas/grid_region.hpp>
#include <igm/igm.hpp>
#include <sweep/cell_order.hpp>
#include <sweep/tet_positions.hpp>
#include <sweep/vertex_numbers.hpp>

namespace hexhex::atlas {

/// Recognizes most keys it has seen before.
class KeyFilter {
 public:
  KeyFilter() { seen_.fill(kNoBrick); }
  [[nodiscard]] bool isNew(BrickKey key, const lattice::ChartPoint& c) noexcept {
    BrickKey& entry = seen_[recentBrick(c)];
    if (entry == key) return false;
    entry = key;
    return true;
  }

 private:
  std::array<BrickKey, kRecentBricks> seen_;
};

/// Arrays for vertices, from vertex number `first` on; null: not written.
struct VertexArrays {
  std::uint64_t first = 0;
  Vec3* points = nullptr;
  Index* tets = nullptr;
  CornerSet* corners = nullptr;
};

/// The grid that finds hex vertices by their places in charts.
///
/// Every tet claims its lattice points (those of its closure) in its chart for the vertices there.
/// A point that two vertices claim is contested, and the tets that claim it move to other charts.
/// In the end, all points of a tet that has a chart belong to its own vertices there.
///
/// With a region, all this holds for its tets and the points in their boxes; other tets have no
/// chart.
template <class Id>
class VertexGrid {
 public:
  /// @param charts     may receive further charts
  /// @param numbers    of all vertices of the map; filled by sweep()
  /// @param keepLines  whether to store lines between the steps or to sweep again
  VertexGrid(const igm::PreparedMap& map, Charts& charts, sweep::VertexNumbers& numbers,
             bool keepLines)
      : map_(map), charts_(charts), numbers_(numbers), swept_(&numbers) {
    if (keepLines) stored_.emplace(map.topology.tetCount());
  }
  /// For a part of the map, instead of sweep().
  /// @param charts  a chart for each tet of the region, and none for others
  VertexGrid(const igm::PreparedMap& map, Charts& charts, const sweep::VertexNumbers& numbers,
             const GridRegion& region, Stage& stage)
      : map_(map), charts_(charts), numbers_(numbers), region_(&region) {
    collectRegion(stage);
  }

  /// Sweeps all tets, for vertices and for cells, and numbers both.
  /// @param observer   sees every tet, if not null
  /// @param fewPoints  as in EngineSwitches
  void sweep(sweep::CellCenters& cells, Stage& stage, sweep::SweepObserver* observer = nullptr,
             bool fewPoints = true);
  /// Makes the grid, enters all vertices, and writes them to `arrays`.
  void fill(const VertexArrays& arrays, Stage& stage);
  /// Finds and resolves overlaps.
  /// @return the number of tets with contested points
  std::uint64_t resolveOverlaps(Stage& stage);
  /// Frees what only the steps above need.
  void dropLines() noexcept { stored_.reset(); }
  /// Moves out what is known of vertices besides the grid, if lines were kept.
  [[nodiscard]] sweep::SweptVertices takeVertices() noexcept {
    assert(stored_);
    return {std::move(*stored_), std::move(*swept_)};
  }

  /// Writes the vertices that a tet owns.
  void describe(Index tet, const VertexArrays& arrays) const;

  /// The hex vertex at a grid point of a closed tet.
  [[nodiscard]] Id vertexAt(Index tet, const lattice::GridPoint& z, BrickCache<Id>& cache) const;

  /// The same without the grid: slow, but correct even for tets without a chart.
  [[nodiscard]] std::uint64_t exactNumber(Index tet, const lattice::GridPoint& z) const;

  [[nodiscard]] const sweep::VertexNumbers& numbers() const noexcept { return numbers_; }
  [[nodiscard]] BrickGrid<Id>& grid() noexcept { return grid_; }
  [[nodiscard]] const BrickGrid<Id>& grid() const noexcept { return grid_; }
  [[nodiscard]] const Charts& charts() const noexcept { return charts_; }

 private:
  using Bricks = Brick<Id>;
  enum class Faces : std::uint8_t { Owned, OwnedAndCut, All };

  /// The lines of a block of tets.
  struct SweptLines {
    sweep::BlockLines vertices;
    sweep::BlockLines centers;
  };

  void collectRegion(Stage& stage);
  [[nodiscard]] std::size_t tetCount() const noexcept {
    return region_ != nullptr ? region_->tets.size() : map_.topology.tetCount();
  }
  [[nodiscard]] Index tetAt(std::size_t i) const noexcept {
    return region_ != nullptr ? region_->tets[i] : static_cast<Index>(i);
  }
  template <class Visit>
  void forEachBrick(Index tet, std::span<const lattice::SweptLine> lines, const Visit& visit) const;
  void collectKeys(Index tet, std::span<const lattice::SweptLine> lines, KeyFilter& filter,
                   std::vector<BrickKey>& keys) const;
  [[nodiscard]] std::span<const lattice::SweptLine> linesOf(
      Index tet, std::vector<lattice::SweptLine>& scratch) const;

  template <class VisitRun, class VisitRow>
  void forEachClaim(Index tet, Faces faces, const VisitRun& visitRun,
                    const VisitRow& visitRow) const;
  template <class VisitRow>
  void forEachForeignClaim(Index tet, int face, const VisitRow& visitRow) const;

  void write(const sweep::VertexRun& run, Index tet, std::optional<sweep::TetPositions>& positions,
             const VertexArrays& arrays) const;

  const igm::PreparedMap& map_;
  Charts& charts_;
  const sweep::VertexNumbers& numbers_;
  sweep::VertexNumbers* swept_ = nullptr;  ///< the same if sweep() fills them
  const GridRegion* region_ = nullptr;     ///< null: all tets
  std::optional<sweep::TetLines> stored_;
  std::vector<std::vector<BrickKey>> keys_;  ///< bricks with points of each block of tets
  BrickGrid<Id> grid_;
  bool overlaps_ = false;  ///< some point was claimed by two vertices
};

extern template class VertexGrid<std::uint32_t>;
extern template class VertexGrid<std::uint64_t>;

}  // namespace hexhex::atlas
