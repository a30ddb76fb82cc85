// Cells of one brick that cuts may meet.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include <atlas/jumps.hpp>

#include <lattice/cell_corners.hpp>

namespace hexhex {

/// Points along each side of a brick, and in all of it.
inline constexpr std::uint32_t kBrickSide = 8;
inline constexpr std::size_t kBrickPoints = std::size_t{kBrickSide} * kBrickSide * kBrickSide;

/// What cuts may come between the centre of a cell and its corners: for each corner, in terms of
/// the chart, the jump across all cut faces that the way from the centre to the corner may meet. A
/// cell remembers two different jumps, which is enough for nearly all.
class alignas(4) CutCell {
 public:
  [[nodiscard]] constexpr bool isCut() const noexcept { return jumps_[0] != kNoJump; }
  /// The corners with a cut in front of them.
  [[nodiscard]] constexpr CellCornerSet corners() const noexcept {
    return CellCornerSet{corners_[0]} | corners_[1];
  }
  /// kNoJump if no cut face may be met, kManyJumps if they have no jump in common.
  [[nodiscard]] constexpr JumpId jump(std::size_t corner) const noexcept {
    const bool first = ((corners_[0] >> corner) & 1U) != 0;
    const bool second = ((corners_[1] >> corner) & 1U) != 0;
    if (first) return second ? kManyJumps : jumps_[0];
    return second ? jumps_[1] : kNoJump;
  }

  /// With one more cut in front of some corners.
  [[nodiscard]] constexpr CutCell with(CellCornerSet corners, JumpId jump) const noexcept {
    CutCell after = *this;
    for (std::size_t i = 0; i < 2; ++i) {
      if (jumps_[i] != kNoJump && jumps_[i] != jump) continue;
      after.jumps_[i] = jump;
      after.corners_[i] = static_cast<std::uint8_t>(corners_[i] | corners);
      return after;
    }
    // Corners with two jumps have many.
    for (std::uint8_t& set : after.corners_) set = static_cast<std::uint8_t>(set | corners);
    return after;
  }

  [[nodiscard]] constexpr bool operator==(const CutCell&) const = default;

 private:
  std::array<std::uint8_t, 2> corners_{};
  std::array<JumpId, 2> jumps_{};
};

/// The cells of a brick, named by their smallest corners.
struct CutCells {
  std::array<CutCell, kBrickPoints> cells;

  void clear() noexcept { cells.fill({}); }

  /// Adds a cut face.
  void add(std::size_t place, CellCornerSet corners, JumpId jump) noexcept {
    cells[place] = cells[place].with(corners, jump);
  }
  /// The same. Thread-safe, which takes longer.
  void addShared(std::size_t place, CellCornerSet corners, JumpId jump) noexcept {
    const std::atomic_ref cell(cells[place]);
    CutCell before = cell.load(std::memory_order_relaxed);
    for (;;) {
      const CutCell after = before.with(corners, jump);
      if (after == before || cell.compare_exchange_weak(before, after, std::memory_order_relaxed)) {
        return;
      }
    }
  }
};

}  // namespace hexhex
