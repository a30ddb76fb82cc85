// The grid points of every tet as lines: of the lattice (hex vertices), or of the lattice shifted
// by one half (cell centres).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <hexhex/types.hpp>

#include <base/parallel.hpp>
#include <lattice/tet_rasterizer.hpp>

namespace hexhex {

/// Tets are worked on in blocks of this many.
inline constexpr std::size_t kSweepBlock = 256;

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

  void store(std::size_t block, const BlockLines& lines) {
    blocks_[block].assign(lines.all().begin(), lines.all().end());
    const auto place = lineBegin_.begin() + static_cast<std::ptrdiff_t>(block * (kSweepBlock + 1));
    *std::copy(lines.begins().begin(), lines.begins().end(), place) =
        static_cast<Index>(lines.all().size());
  }

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
