// Two doubles that are worked with at once. Each behaves as it would alone.
#pragma once

#include <cstdint>
#include <limits>

namespace hexhex {

using Pair = double __attribute__((vector_size(16)));
/// One truth value for each: 0 or -1.
using PairMask = std::int64_t __attribute__((vector_size(16)));

[[nodiscard]] inline Pair magnitudeOf(Pair x) noexcept {
  constexpr std::int64_t kAllButSign = 0x7fffffffffffffff;
  return reinterpret_cast<Pair>(reinterpret_cast<PairMask>(x) & PairMask{kAllButSign, kAllButSign});
}

/// The first where the mask is set, elsewhere the second.
[[nodiscard]] inline Pair chosen(PairMask mask, Pair first, Pair second) noexcept {
  return reinterpret_cast<Pair>((mask & reinterpret_cast<PairMask>(first)) |
                                (~mask & reinterpret_cast<PairMask>(second)));
}

/// As nearestInteger() of vector3.hpp.
[[nodiscard]] inline Pair nearestIntegers(Pair x) noexcept {
  constexpr std::int64_t kSign = std::numeric_limits<std::int64_t>::min();
  constexpr Pair kLarge = {0x1p52, 0x1p52};
  const PairMask sign = reinterpret_cast<PairMask>(x) & PairMask{kSign, kSign};
  const Pair large = reinterpret_cast<Pair>(reinterpret_cast<PairMask>(kLarge) | sign);
  return (x + large) - large;
}

/// As std::max.
[[nodiscard]] inline Pair larger(Pair a, Pair b) noexcept { return a < b ? b : a; }

}  // namespace hexhex
