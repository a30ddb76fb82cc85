// Cells of one brick that cuts may meet.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include <atlas/jumps.hpp>

#include <lattice/cell_corners.hpp>

namespace hexhex {

/// Points in a brick.
inline constexpr std::size_t kBrickPoints = 512;

/// What cuts may come between the centre of a cell and its corners: a jump for each corner, in
/// terms of the chart.
class CutCell {
 public:
  constexpr CutCell() = default;
  /// A cut in front of some corners.
  constexpr CutCell(CellCornerSet corners, JumpId jump) noexcept
      : jumps_(bytesOf(corners) & (kOnes * jump)) {}

  [[nodiscard]] constexpr bool isCut() const noexcept { return jumps_ != 0; }
  /// The corners with a cut in front of them.
  [[nodiscard]] constexpr CellCornerSet corners() const noexcept {
    // The highest bits of all bytes, moved together by a product.
    return static_cast<CellCornerSet>(
        ((nonzeroBytes(jumps_) & (kOnes << 7)) * 0x0002'0408'1020'4081) >> 56);
  }
  /// The jump across all cut faces that the way from the centre to a corner may meet; kNoJump if
  /// there are none, kManyJumps if they have no jump in common.
  [[nodiscard]] constexpr JumpId jump(std::size_t corner) const noexcept {
    return static_cast<JumpId>(jumps_ >> (8 * corner));
  }

  [[nodiscard]] constexpr bool operator==(const CutCell&) const = default;

  /// What is in front of the corners with both cuts.
  friend constexpr CutCell operator|(const CutCell& a, const CutCell& b) noexcept {
    const std::uint64_t differ =
        nonzeroBytes(a.jumps_) & nonzeroBytes(b.jumps_) & nonzeroBytes(a.jumps_ ^ b.jumps_);
    CutCell both;
    both.jumps_ = a.jumps_ | b.jumps_ | differ;  // where they differ, all bits: kManyJumps
    return both;
  }

 private:
  static constexpr std::uint64_t kOnes = 0x0101'0101'0101'0101;

  /// 255 in each byte that is not 0.
  [[nodiscard]] static constexpr std::uint64_t nonzeroBytes(std::uint64_t x) noexcept {
    constexpr std::uint64_t kLow = 0x7f * kOnes;
    return ((((x & kLow) + kLow) | x) >> 7 & kOnes) * 255;
  }
  /// 255 in the byte of each corner of a set.
  [[nodiscard]] static constexpr std::uint64_t bytesOf(CellCornerSet corners) noexcept {
    // Bit i of the copy in byte i alone.
    return nonzeroBytes(corners * kOnes & 0x8040'2010'0804'0201);
  }

  std::uint64_t jumps_ = 0;  ///< a byte for each corner
};

/// The cells of a brick, named by their smallest corners.
struct CutCells {
  std::array<CutCell, kBrickPoints> cells{};

  /// Adds a cut face. Thread-safe.
  void add(std::size_t place, const CutCell& cut) noexcept {
    const std::atomic_ref cell(cells[place]);
    CutCell before = cell.load(std::memory_order_relaxed);
    for (;;) {
      const CutCell after = before | cut;
      if (after == before || cell.compare_exchange_weak(before, after, std::memory_order_relaxed)) {
        return;
      }
    }
  }
};

}  // namespace hexhex
