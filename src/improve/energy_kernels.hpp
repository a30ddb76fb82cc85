// Energy terms, four at a time: those of up to four cells at the same place.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <base/lanes.hpp>
#include <improve/vertex_energy.hpp>

namespace hexhex::improvement {

struct EnergyKernels {
  /// Per TermKind: computes the terms of one to four cells.
  std::array<void (*)(std::span<const MovingCell> cells, TermLanes* terms), 3> terms;
  double (*energy)(std::span<const TermLanes> terms, const EnergyKind& kind, const Vec3& step);
  void (*slope)(std::span<const TermLanes> terms, const EnergyKind& kind, EnergySlope& slope);
};

/// The kernels for each register width that the processor supports, the widest last. Their results
/// are bitwise identical.
[[nodiscard]] std::span<const EnergyKernels> energyKernels() noexcept;

}  // namespace hexhex::improvement
