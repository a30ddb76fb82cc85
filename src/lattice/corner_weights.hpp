// Barycentric coordinates in floating point, two at a time.
#pragma once

#include <array>

#include <base/pair.hpp>

namespace hexhex {

/// A number for each corner of a tet.
struct CornerWeights {
  Pair of01;
  Pair of23;

  [[nodiscard]] CornerWeights plus(const CornerWeights& gradient, double steps) const noexcept {
    const Pair factor = {steps, steps};
    return {of01 + gradient.of01 * factor, of23 + gradient.of23 * factor};
  }
  [[nodiscard]] double least() const noexcept {
    const Pair lower = smaller(of01, of23);
    return lower[0] < lower[1] ? lower[0] : lower[1];
  }
  [[nodiscard]] std::array<double, 4> byCorner() const noexcept {
    return {of01[0], of01[1], of23[0], of23[1]};
  }
};

}  // namespace hexhex
