// Cells of one brick that cuts may meet.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include <atlas/jumps.hpp>

#include <lattice/cell_corners.hpp>

namespace hexhex {

/// Points in a brick.
inline constexpr std::size_t kBrickPoints = 512;

/// What cuts may come between the centre of a cell and its corners.
struct alignas(4) CutCell {
  /// The corners to which the way from the centre may meet a cut face, in terms of the chart: a
  /// CellCornerSet.
  std::uint16_t corners = 0;
  /// The jump across these faces.
  JumpId jump = kNoJump;

  [[nodiscard]] bool operator==(const CutCell&) const = default;
};

/// The cells of a brick, named by their smallest corners.
struct CutCells {
  std::array<CutCell, kBrickPoints> cells{};

  /// Adds a cut face. Thread-safe.
  void add(std::size_t place, CellCornerSet corners, JumpId jump) noexcept {
    const std::atomic_ref cell(cells[place]);
    CutCell before = cell.load(std::memory_order_relaxed);
    for (;;) {
      const bool isOnly = before.jump == kNoJump || before.jump == jump;
      const CutCell after{static_cast<std::uint16_t>(before.corners | corners),
                          isOnly ? jump : kManyJumps};
      if (after == before || cell.compare_exchange_weak(before, after, std::memory_order_relaxed)) {
        return;
      }
    }
  }
};

}  // namespace hexhex
