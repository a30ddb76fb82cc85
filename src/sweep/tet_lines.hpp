// The grid points of every tet as lines: of the lattice (hex vertices), or of the lattice shifted
// by one half (cell centres).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <lattice/line_rasterizer.hpp>
#include <map/exact_map.hpp>

namespace hexhex {

/// Which points are swept. A cell is named by its corner with the smallest coordinates, so that
/// grid point z stands for the centre z + (1/2, 1/2, 1/2).
enum class SweptGrid : std::uint8_t { Vertices, Centers };

/// Tets are worked on in blocks of this many.
inline constexpr std::size_t kSweepBlock = 256;

/// One tet, ready to be swept.
struct TetSweep {
  LatticeTet shifted;  ///< corners, so that the swept points are integers
  GridBox box;
  SweepAxes axes;

  TetSweep(const ExactMap& map, Index tet, SweptGrid grid) noexcept;

  /// Appends the tet's lines.
  void run(std::int64_t unit, std::vector<SweptLine>& lines) const;
};

/// Appends the lines of both grids.
void sweepBoth(const ExactMap& map, Index tet, std::vector<SweptLine>& vertices,
               std::vector<SweptLine>& centers);

/// The lines of all tets, stored by block.
class TetLines {
 public:
  /// @param tets  number of tets
  explicit TetLines(std::size_t tets) : lineBegin_(tets), blocks_(blockCount(tets, kSweepBlock)) {}

  /// Stores the lines of a block of tets.
  /// @param ends  per tet of the block, where its lines end
  void store(std::size_t block, std::span<const SweptLine> lines, std::span<const Index> begins);

  [[nodiscard]] std::span<const SweptLine> of(Index tet) const noexcept {
    const Array<SweptLine>& block = blocks_[tet / kSweepBlock];
    const std::size_t begin = lineBegin_[tet];
    const std::size_t next = std::size_t{tet} + 1;
    const bool last = next % kSweepBlock == 0 || next == lineBegin_.size();
    return std::span(block).subspan(begin, (last ? block.size() : lineBegin_[next]) - begin);
  }

 private:
  Array<Index> lineBegin_;  ///< per tet, within its block
  std::vector<Array<SweptLine>> blocks_;
};

}  // namespace hexhex
