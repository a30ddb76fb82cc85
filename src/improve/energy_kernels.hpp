// Energy terms, four at a time: those of up to four cells at the same place.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <base/lanes.hpp>
#include <improve/vertex_energy.hpp>

namespace hexhex::improvement {

struct EnergyKernels {
  /// Compute the 4 terms of corners, or the 20 of Bezier coefficients, of one to four cells.
  void (*cornerTerms)(std::span<const MovingCell> cells, TermLanes* terms);
  void (*bezierTerms)(std::span<const MovingCell> cells, TermLanes* terms);
  double (*energy)(std::span<const TermLanes> terms, const EnergyKind& kind, const Vec3& step);
  void (*slope)(std::span<const TermLanes> terms, const EnergyKind& kind, EnergySlope& slope);
};

inline constexpr std::size_t kCornerTerms = 4;
inline constexpr std::size_t kBezierTerms = 20;

/// The kernels for each register width that the processor supports, the widest last. Their results
/// are bitwise identical.
[[nodiscard]] std::span<const EnergyKernels> energyKernels() noexcept;

}  // namespace hexhex::improvement
