// Quality of straight cells, and the least Bezier coefficient of their Jacobian determinants, for
// several cells at once: as many as the processor's registers hold.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hexhex/types.hpp>

namespace hexhex::mesh {

/// Corners in VTK order by their place (u, v, w): bit 0, 1, 2.
inline constexpr std::array<std::size_t, 8> kVtkCorner = {0, 1, 3, 2, 4, 5, 7, 6};

/// Measures of some cells.
struct CellMeasures {
  static constexpr std::size_t kMost = 32;  ///< cells

  std::array<double, kMost> scaled;  ///< scaled Jacobian
  std::array<double, kMost> corner;  ///< the least of the eight values at corners
  std::array<double, kMost> least;   ///< the least of the 27 coefficients
  std::array<double, kMost> volume;  ///< of the box of the longest edges along the three axes
  /// 0 for cells whose edges are too long or too short for squares; nothing else is known of these.
  std::array<std::int64_t, kMost> inRange;

  /// Error bound of `corner` and `least`. A product of three edges, each a difference rounded once,
  /// is off by less than 10 roundings of the sum of its six terms, which is less than 6 V, V the
  /// volume. 2 b of a w-edge takes as much as 10 such products, 4 b of an upright face 2 * 2 + 2 *
  /// 10 + 4 = 28, 8 b of the centre 4 * 28 + 4 * 10 = 152, and sums add fewer than 10 roundings of
  /// these: 20 * 6 * 152 / 8 * 2^-53 V < 2^-41 V. Doubled for safety.
  [[nodiscard]] double errorOf(std::size_t cell) const noexcept { return 0x1p-40 * volume[cell]; }
};

/// Measures up to kMost cells.
using MeasureCells = void (*)(const Vec3* points, std::span<const Hex> cells,
                              CellMeasures& measures);

/// One function per register width that the processor supports, the widest last. All give the same
/// results, bit for bit. (With two cells at once instead of four, quality takes 1.5 times as long.)
[[nodiscard]] std::span<const MeasureCells> measuresOfCells() noexcept;

}  // namespace hexhex::mesh
