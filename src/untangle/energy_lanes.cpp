// Compiled for several register widths: the entry points for each width inline everything that they
// call.
#include <cstdint>

#include <untangle/energy_lanes.hpp>
#include <untangle/regularized.hpp>

#include <base/register_widths.hpp>

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace hexhex::untangle {

namespace {

using LaneMatrix = std::array<LaneVector<Number>, 3>;  // rows

/// The cube root of 1 / x for positive x: a third of the exponent, right to 4 %, then Newton's
/// method, each step of which doubles the number of right digits. (std::cbrt takes as long as a
/// third of an element's energy.)
HEXHEX_INLINE Number inverseCubeRoot(const Number& x) noexcept {
  using Bits = Lanes<std::uint64_t, kLanes>;
  constexpr std::uint64_t kThird = 0x55555556;   // 2^32 / 3, rounded up
  constexpr std::uint64_t kMiddle = 0x553EF0FF;  // such that the largest errors are equal
  constexpr int kSteps = 4;
  const Bits high = bitsAs<Bits>(x) >> 32;
  auto y = bitsAs<Number>((kMiddle - ((high * kThird) >> 32)) << 32);
  for (int i = 0; i < kSteps; ++i) y = y * (4 - x * y * y * y) * (1.0 / 3);
  return y;
}

HEXHEX_INLINE LaneMatrix jacobianOf(const ElementLanes& elements) noexcept {
  LaneMatrix j = elements.offset;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t row = 0; row < 3; ++row) {
      // Differences keep small elements accurate far from the origin.
      const Number edge = elements.corners[i + 1][row] - elements.corners[0][row];
      for (std::size_t k = 0; k < 3; ++k) j[row][k] += edge * elements.gradients[i][k];
    }
  }
  return j;
}

HEXHEX_INLINE void energyOf(const ElementLanes& elements, double epsilon, double pull,
                            ForceLanes& result) noexcept {
  const LaneMatrix j = jacobianOf(elements);
  const LaneMatrix cofactors = {cross(j[1], j[2]), cross(j[2], j[0]), cross(j[0], j[1])};
  const Number det = dot(j[0], cofactors[0]);
  const Regularized<Number> regularized(epsilon, det);
  const Number chi = regularized.chi();
  const Number slope = 0.5 * (1 + det / regularized.root);  // of chi
  const Number share = inverseCubeRoot(chi * chi);
  const Number shape = (dot(j[0], j[0]) + dot(j[1], j[1]) + dot(j[2], j[2])) * share;
  const Number volume = (det * det + 1) / chi;
  // The derivative along a change dJ is power (J : dJ) + along (cofactors : dJ).
  const Number power = 2 * share;
  const Number along = ((-2.0 / 3) * shape * slope + 2 * det - volume * slope) / chi;
  Number energy = shape + volume;
  LaneMatrix byMatrix;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Number away = j[row][k] - elements.target[row][k];
      energy += 0.5 * pull * away * away;
      byMatrix[row][k] =
          elements.weight * (power * j[row][k] + along * cofactors[row][k] + pull * away);
    }
  }
  result.determinant = det;
  result.energy = elements.weight * energy;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t i = 0; i < 3; ++i) {
      result.forces[i + 1][row] = dot(byMatrix[row], elements.gradients[i]);
    }
    result.forces[0][row] =
        -(result.forces[1][row] + result.forces[2][row] + result.forces[3][row]);
  }
}

}  // namespace

std::span<const EnergyKernel> energyKernels() noexcept {
  static constexpr std::array<EnergyKernel, 2> kBoth = {energyOf, kWide<energyOf>};
  return runnable(kBoth);
}

}  // namespace hexhex::untangle
