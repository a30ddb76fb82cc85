// The part of each cell. It is known before there are cells, from their number per tet.
//
// A tet is assigned as a whole unless it has so many cells that parts could not be balanced: then
// its cells are assigned in blocks of its chart. So parts differ by at most about 3 % of their
// cells, however few tets there are.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/parts.hpp>

#include <lattice/swept_line.hpp>
#include <sweep/tet_counts.hpp>

namespace hexhex::parts {

/// The blocks of a tet: cubes of `side` cells along each axis of its chart.
struct TetBlocks {
  Index tet = 0;
  std::int32_t side = 1;
  lattice::GridPoint low{};             ///< smallest corner of the first block's first cell
  std::array<std::uint32_t, 3> size{};  ///< blocks along each axis
  std::size_t first = 0;                ///< index among all blocks

  [[nodiscard]] std::size_t count() const noexcept {
    return std::size_t{size[0]} * size[1] * size[2];
  }
  /// The block of the cell with smallest corner z, counted from the tet's first block.
  [[nodiscard]] std::size_t blockOf(const lattice::GridPoint& z) const noexcept {
    std::size_t block = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      block = block * size[k] + static_cast<std::size_t>((z[k] - low[k]) / side);
    }
    return block;
  }
  /// Number of cells from z on that are in the same block, along a sweep's lines.
  [[nodiscard]] std::uint32_t cellsAhead(const lattice::GridPoint& z,
                                         lattice::SweepAxes axes) const noexcept {
    const std::size_t along = axes()[2];
    assert(z[along] >= low[along]);
    return static_cast<std::uint32_t>(side - (z[along] - low[along]) % side);
  }
  /// The smallest corner of the first cell of a block.
  [[nodiscard]] lattice::GridPoint lowOf(std::size_t block) const noexcept {
    lattice::GridPoint z = low;
    for (const std::size_t k : {2U, 1U, 0U}) {
      z[k] += static_cast<std::int32_t>(block % size[k]) * side;
      block /= size[k];
    }
    return z;
  }
};

/// The unit of assignment: a whole tet, or a block of one.
struct PartitionElement {
  Index tet;
  Index blocks;         ///< index in Partition::blocks, or kNone for a whole tet
  std::size_t block;    ///< among those
  std::uint64_t cells;  ///< may be zero
  Vec3 place;           ///< in space, near the middle
};

class Partition {
 public:
  std::uint32_t parts = 1;
  std::vector<TetBlocks> blocks;  ///< of tets that are not assigned as a whole; ascending by tet

  /// The part of a cell, given its owner and smallest corner.
  [[nodiscard]] std::uint32_t partOf(Index tet, const lattice::GridPoint& z) const noexcept {
    assert(tet < ofTet.size());
    const std::uint32_t part = ofTet[tet];
    if (part < kSplit) return part;
    const TetBlocks& split = blocks[part - kSplit];
    return ofBlock[split.first + split.blockOf(z)];
  }
  /// Calls visit(part, first, count) for some cells of a tet's line, in pieces that each belong to
  /// one part.
  template <class Visit>
  void forEachPiece(Index tet, const lattice::SweptLine& line, std::uint32_t first,
                    std::uint32_t count, const Visit& visit) const {
    const TetBlocks* const split = blocksOf(tet);
    const std::uint32_t end = first + count;
    while (first < end) {
      const lattice::GridPoint z = line.point(first);
      const std::uint32_t piece =
          split == nullptr ? end - first : std::min(end - first, split->cellsAhead(z, line.axes));
      visit(partOf(tet, z), first, piece);
      first += piece;
    }
  }
  /// The blocks of a tet, or null if it is assigned as a whole.
  [[nodiscard]] const TetBlocks* blocksOf(Index tet) const noexcept {
    return ofTet[tet] < kSplit ? nullptr : &blocks[ofTet[tet] - kSplit];
  }
  /// Number of a tet's cells in a part.
  [[nodiscard]] std::uint64_t cellsOf(const TetBlocks& split, std::uint32_t part) const noexcept {
    std::uint64_t cells = 0;
    for (std::size_t b = split.first; b < split.first + split.count(); ++b) {
      if (ofBlock[b] == part) cells += inBlock[b];
    }
    return cells;
  }
  /// The tets of a part, whole or with a nonempty block, ascending.
  [[nodiscard]] std::span<const Index> tetsOf(std::uint32_t part) const noexcept {
    return std::span(tets).subspan(begin[part], begin[part + 1] - begin[part]);
  }

  static constexpr std::uint32_t kSplit = 1U << 31;
  std::vector<std::uint32_t> ofTet;    ///< per tet: its part, or kSplit + its index in `blocks`
  std::vector<std::uint32_t> ofBlock;  ///< per block, counted over all tets: its part
  std::vector<std::uint64_t> inBlock;  ///< per block: number of its cells
  std::vector<std::size_t> begin;      ///< per part (+1): its first tet in `tets`
  std::vector<Index> tets;
};

struct PartitionInput {
  const igm::PreparedMap& map;
  const sweep::ElementCounts& counts;
  ProcessTeam* team;  ///< if not null, its processes all call this and share the work
};

/// @param method  InvalidArgument if its library is not available
[[nodiscard]] Partition makePartition(const PartitionInput& input, std::uint32_t parts,
                                      PartitionMethod method, Context& context);

/// Bisects elements by position into parts with about the same number of cells.
/// @param elements  get reordered
/// @return  the part of each, in the new order
[[nodiscard]] std::vector<std::uint32_t> bisect(std::vector<PartitionElement>& elements,
                                                std::uint32_t parts);

/// Uses METIS or Scotch, loaded on demand: cuts the graph of elements, weighted by cells, with
/// edges weighted by the approximate number of cell faces between them.
/// @return  per element: its part
/// @throws Error InvalidArgument if the library is missing, was built for other integers, or fails;
///         TooLarge if the graph exceeds its integers
[[nodiscard]] std::vector<std::uint32_t> cutGraph(const igm::PreparedMap& map,
                                                  const Partition& partition,
                                                  const std::vector<PartitionElement>& elements,
                                                  PartitionMethod method);

}  // namespace hexhex::parts
