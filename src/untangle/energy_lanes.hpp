// The foldover-free energy of four elements at once, and their forces.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <base/lanes.hpp>

namespace hexhex::untangle {

inline constexpr std::size_t kLanes = 4;
using Number = Lanes<double, kLanes>;

/// Elements as in problem.hpp, at some point.
struct alignas(sizeof(Number)) ElementLanes {
  std::array<std::array<Number, 3>, 4> corners{};
  std::array<std::array<Number, 3>, 3> gradients{};
  std::array<std::array<Number, 3>, 3> offset{};  ///< rows
  std::array<std::array<Number, 3>, 3> target{};  ///< rows; used if there is a pull
  Number weight{};
};

struct alignas(sizeof(Number)) ForceLanes {
  Number determinant{};
  Number energy{};                                ///< not a number or infinite where it is infinite
  std::array<std::array<Number, 3>, 4> forces{};  ///< derivatives with respect to corners
};

using EnergyKernel = void (*)(const ElementLanes& elements, double epsilon, double pull,
                              ForceLanes& result);

/// For each register width that the processor supports, the widest last. Results are bitwise
/// identical.
[[nodiscard]] std::span<const EnergyKernel> energyKernels() noexcept;

}  // namespace hexhex::untangle
