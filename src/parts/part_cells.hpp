// The cells of a part and those around them, with global vertex numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <parts/partition.hpp>
#include <parts/vertex_set.hpp>

#include <hexhex/types.hpp>

#include <atlas/cell_emitter.hpp>
#include <atlas/charts.hpp>
#include <atlas/cut_marks.hpp>
#include <atlas/grid_region.hpp>
#include <sweep/tet_counts.hpp>

namespace hexhex::parts {

/// The location of a cell: a centre on a line of its owner.
struct CellPlace {
  Index tet;
  lattice::CornerMask simplex;  ///< of the tet, with the centre in its interior
  lattice::GridPoint z;         ///< smallest corner
};

/// Cells and their global numbers, ascending.
template <class Id>
struct GlobalCells {
  Array<std::uint64_t> numbers;
  Array<std::array<Id, 8>> corners;
};

/// A cell of another part.
template <class Id>
struct NearbyCell {
  std::uint64_t number;
  std::uint32_t part;
  CellPlace place;
  std::array<Id, 8> corners;
};

/// Calls visit(line, first, count, number) for runs of cells that a tet owns and a part has:
/// `count` centres of a line, starting at index `first`; `number` is that first cell's number among
/// those that the tet owns.
template <class Visit>
void forEachRun(const igm::PreparedMap& map, const Partition& partition, std::uint32_t part,
                Index tet, std::span<const lattice::SweptLine> lines, const Visit& visit) {
  sweep::CenterOwner owner(map.topology, tet);
  std::uint64_t number = 0;
  for (const lattice::SweptLine& line : lines) {
    const auto [first, count] = owner.owned(line);
    partition.forEachPiece(
        tet, line, first, count,
        [&, first = first](std::uint32_t owned, std::uint32_t at, std::uint32_t run) {
          if (owned == part) visit(line, at, run, number + (at - first));
        });
    number += count;
  }
}

/// The vertices in the region of one part after another, in charts.
template <class Id>
class PartGrid {
 public:
  /// @param map     with everything else, outlives this
  /// @param charts  of the whole map
  PartGrid(const igm::PreparedMap& map, const sweep::ElementCounts& counts,
           const Partition& partition, const atlas::Charts& charts);
  PartGrid(const PartGrid&) = delete;
  PartGrid& operator=(const PartGrid&) = delete;

  /// Builds the grid of a region, replacing the previous one.
  void enter(atlas::GridRegion region, Stage& stage);
  /// Frees the grid.
  void clear() noexcept;

  // For the current region:
  [[nodiscard]] GlobalCells<Id> ownCells(std::uint32_t part, Stage& stage) const;
  /// The cells of other parts in the boxes of the region, ascending.
  /// @param touched  if not null, only cells with one of these vertices
  [[nodiscard]] std::vector<NearbyCell<Id>> nearbyCells(std::uint32_t part,
                                                        const VertexSet* touched,
                                                        Stage& stage) const;

 private:
  struct Surroundings;

  [[nodiscard]] std::vector<lattice::SweptLine> centersOf(Index tet) const;
  /// Adds the nearby cells of a tet of the region.
  void addNearby(std::size_t i, Surroundings& around, std::vector<NearbyCell<Id>>& list) const;

  const igm::PreparedMap& map_;
  const sweep::ElementCounts& counts_;
  const Partition& partition_;
  const atlas::Charts& all_;  ///< of the whole map
  atlas::Charts charts_;      ///< contain only tets of the region
  atlas::GridRegion region_;
  std::optional<atlas::VertexGrid<Id>> vertices_;
  atlas::CutTransitions transitions_;
};

extern template class PartGrid<std::uint32_t>;
extern template class PartGrid<std::uint64_t>;

// The location in space of vertices of which only the global numbers are known.

/// Fills entries of mesh.points, mesh.generatorTet and mesh.generatorCorners.
/// @param numbers  of the vertices, ascending
/// @param first    index of the first entry
void describeVertices(const igm::PreparedMap& map, const sweep::ElementCounts& counts,
                      std::span<const std::uint64_t> numbers, std::size_t first, HexMesh& mesh,
                      Stage& stage);

}  // namespace hexhex::parts
