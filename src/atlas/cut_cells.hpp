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
/// the chart, the jumps across all cut faces that the way from the centre to the corner may meet. A
/// cell remembers two different jumps: with one, s17c_sphere_r0.1 takes 6 % longer.
class alignas(4) CutCell {
 public:
  static constexpr std::size_t kMost = 2;

  [[nodiscard]] constexpr bool isCut() const noexcept { return jumps_[0] != kNoJump; }
  /// The corners with a cut in front of them.
  [[nodiscard]] constexpr CellCornerSet corners() const noexcept {
    CellCornerSet all = 0;
    for (const std::uint8_t set : corners_) all |= set;
    return all;
  }
  /// The jumps; kNoJump stands for none, and kManyJumps for any.
  [[nodiscard]] constexpr std::array<JumpId, kMost> jumps(std::size_t corner) const noexcept {
    std::array<JumpId, kMost> jumps{};
    for (std::size_t i = 0; i < kMost; ++i) {
      jumps[i] = ((corners_[i] >> corner) & 1U) != 0 ? jumps_[i] : kNoJump;
    }
    return jumps;
  }
  /// kNoJump if no cut face may be met, kManyJumps if they have no jump in common.
  [[nodiscard]] constexpr JumpId jump(std::size_t corner) const noexcept {
    JumpId common = kNoJump;
    for (const JumpId jump : jumps(corner)) {
      if (jump != kNoJump) common = common == kNoJump ? jump : kManyJumps;
    }
    return common;
  }

  /// With one more cut in front of some corners.
  [[nodiscard]] constexpr CutCell with(CellCornerSet corners, JumpId jump) const noexcept {
    CutCell after = *this;
    std::size_t i = 0;
    while (i < kMost && jumps_[i] != kNoJump && jumps_[i] != jump) ++i;
    if (i == kMost) {
      // What the last one was is forgotten.
      i = kMost - 1;
      jump = kManyJumps;
    }
    after.jumps_[i] = jump;
    after.corners_[i] = static_cast<std::uint8_t>(corners_[i] | corners);
    return after;
  }

  [[nodiscard]] constexpr bool operator==(const CutCell&) const = default;

 private:
  std::array<std::uint8_t, kMost> corners_{};
  std::array<JumpId, kMost> jumps_{};  ///< from the first on, then kNoJump
};

/// The cells of a brick, named by their smallest corners.
struct CutCells {
  std::array<CutCell, kBrickPoints> cells;

  void clear() noexcept { cells.fill({}); }

  /// Adds a cut face. Thread-safe.
  void add(std::size_t place, CellCornerSet corners, JumpId jump) noexcept {
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
