// The grid points of every tet as lines: of the lattice (hex vertices), or of the lattice shifted
// by one half (cell centres).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <igm/exact_map.hpp>
#include <lattice/both_grids.hpp>
#include <lattice/half_grids.hpp>
#include <lattice/line_rasterizer.hpp>

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
inline void sweepBoth(const ExactMap& map, Index tet, std::vector<SweptLine>& vertices,
                      std::vector<SweptLine>& centers) {
  sweepBothGrids(map.corners[tet], map.unit, vertices, centers);
}

/// Appends the lines of one grid of several.
inline void appendLines(const HalfGrids& grids, HalfGrid grid, std::vector<SweptLine>& lines) {
  static_cast<void>(grids.sweep(grid, [&](const SweptLine& line) { lines.push_back(line); }));
}

/// The lines of a block of tets, one tet after the other.
class BlockLines {
 public:
  /// @param keep  whether to keep the lines of all tets, or just those of the last one
  explicit BlockLines(bool keep) noexcept : keep_(keep) {}

  /// Begins another block.
  void clear() noexcept {
    lines_.clear();
    tets_ = 0;
  }
  /// Gives memory for many lines back, as each thread has such a list.
  void shrink() noexcept {
    constexpr std::size_t kFew = 1024;
    if (lines_.capacity() > kFew) lines_ = std::vector<SweptLine>();
  }

  /// Begins the next tet. Its lines are to be appended to what this returns.
  [[nodiscard]] std::vector<SweptLine>& next() noexcept {
    if (!keep_) lines_.clear();
    begins_[tets_++] = static_cast<Index>(lines_.size());
    return lines_;
  }
  /// Those of the last tet.
  [[nodiscard]] std::span<const SweptLine> last() const noexcept {
    return std::span(lines_).subspan(begins_[tets_ - 1]);
  }
  [[nodiscard]] std::span<const SweptLine> all() const noexcept { return lines_; }
  [[nodiscard]] std::span<const Index> begins() const noexcept {
    return std::span(begins_).first(tets_);
  }

 private:
  bool keep_;
  std::vector<SweptLine> lines_;
  std::array<Index, kSweepBlock> begins_;
  std::size_t tets_ = 0;
};

/// The lines of all tets, stored by block.
class TetLines {
 public:
  /// @param tets  number of tets
  explicit TetLines(std::size_t tets)
      : lineBegin_(tets + blockCount(tets, kSweepBlock)), blocks_(blockCount(tets, kSweepBlock)) {}

  void store(std::size_t block, const BlockLines& lines);

  [[nodiscard]] bool areEmpty(Index tet) const noexcept {
    const std::size_t place = placeOf(tet);
    return lineBegin_[place] == lineBegin_[place + 1];
  }
  [[nodiscard]] std::span<const SweptLine> of(Index tet) const noexcept {
    const std::size_t place = placeOf(tet);
    return std::span(blocks_[tet / kSweepBlock])
        .subspan(lineBegin_[place], lineBegin_[place + 1] - lineBegin_[place]);
  }
  /// Takes the lines of a block away, one tet after the other.
  [[nodiscard]] Array<SweptLine> takeBlock(std::size_t block) noexcept {
    return std::exchange(blocks_[block], {});
  }

 private:
  static std::size_t placeOf(Index tet) noexcept { return std::size_t{tet} + tet / kSweepBlock; }

  Array<Index> lineBegin_;  ///< per tet, within its block, and at the end of each block
  std::vector<Array<SweptLine>> blocks_;
};

}  // namespace hexhex
