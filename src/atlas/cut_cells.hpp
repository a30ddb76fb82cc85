// What the cells of a brick remember of cuts.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <atlas/bricks.hpp>
#include <lattice/cell_corners.hpp>

namespace hexhex::atlas {

/// Names a transition across a cut (CutTransitions).
using CutTransitionId = std::uint8_t;
/// No cut.
inline constexpr CutTransitionId kNoCut = 0;
/// Several cuts with different transitions, or a cut whose transition has no name.
inline constexpr CutTransitionId kAnyCuts = std::numeric_limits<CutTransitionId>::max();

/// The cuts that the half diagonals of a cell may meet: for each corner, in terms of the chart, the
/// transition across them. A cell remembers two different transitions: with one, whole extractions
/// of s17c_sphere_r0.1 take 6 % longer, of s17c_sphere_r10 5 %.
class alignas(4) CutCell {
 public:
  [[nodiscard]] constexpr bool isCut() const noexcept { return transitions_[0] != kNoCut; }
  /// The corners with a cut in front of them.
  [[nodiscard]] constexpr lattice::CellCornerSet corners() const noexcept {
    lattice::CellCornerSet all = 0;
    for (const std::uint8_t set : corners_) all |= set;
    return all;
  }
  /// The transition across all cuts in front of a corner: kNoCut if there are none, kAnyCuts if
  /// they have none in common.
  [[nodiscard]] constexpr CutTransitionId transition(std::size_t corner) const noexcept {
    CutTransitionId common = kNoCut;
    for (std::size_t i = 0; i < kMost; ++i) {
      if (((corners_[i] >> corner) & 1U) == 0) continue;
      common = common == kNoCut ? transitions_[i] : kAnyCuts;
    }
    return common;
  }

  /// With one more cut in front of some corners.
  [[nodiscard]] constexpr CutCell with(lattice::CellCornerSet corners,
                                       CutTransitionId transition) const noexcept {
    CutCell after = *this;
    std::size_t i = 0;
    while (i < kMost && transitions_[i] != kNoCut && transitions_[i] != transition) ++i;
    if (i == kMost) {
      // Which one the last was is forgotten.
      i = kMost - 1;
      transition = kAnyCuts;
    }
    after.transitions_[i] = transition;
    after.corners_[i] = static_cast<std::uint8_t>(corners_[i] | corners);
    return after;
  }

  [[nodiscard]] constexpr bool operator==(const CutCell&) const = default;

 private:
  static constexpr std::size_t kMost = 2;

  std::array<std::uint8_t, kMost> corners_{};
  std::array<CutTransitionId, kMost> transitions_{};  ///< from the first on, then kNoCut
};

/// The cells of a brick, named by their smallest corners.
struct CutCells {
  std::array<CutCell, kBrickPoints> cells{};

  /// Adds a cut face. Thread-safe.
  void add(std::size_t place, lattice::CellCornerSet corners, CutTransitionId transition) noexcept {
    const std::atomic_ref cell(cells[place]);
    CutCell before = cell.load(std::memory_order_relaxed);
    for (;;) {
      const CutCell after = before.with(corners, transition);
      if (after == before || cell.compare_exchange_weak(before, after, std::memory_order_relaxed)) {
        return;
      }
    }
  }
};

}  // namespace hexhex::atlas
