// Two doubles that are worked with at once. Each behaves as it would alone.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>

namespace hexhex {

using Pair = double __attribute__((vector_size(16)));
/// One truth value for each: 0 or -1.
using PairMask = std::int64_t __attribute__((vector_size(16)));

using PairBits = std::uint64_t __attribute__((vector_size(16)));

using IntPair = std::int32_t __attribute__((vector_size(8)));

/// Two numbers in a row.
[[nodiscard]] inline Pair loadPair(const double* first) noexcept {
  Pair pair;
  std::memcpy(&pair, first, sizeof pair);
  return pair;
}

[[nodiscard]] inline Pair magnitudeOf(Pair x) noexcept {
  constexpr std::int64_t kAllButSign = 0x7fffffffffffffff;
  return reinterpret_cast<Pair>(reinterpret_cast<PairMask>(x) & PairMask{kAllButSign, kAllButSign});
}

/// 1 for negative numbers, 0 for others.
[[nodiscard]] inline PairBits signBits(Pair x) noexcept {
  return reinterpret_cast<PairBits>(x) >> 63;
}

/// The first where the mask is set, elsewhere the second.
[[nodiscard]] inline Pair chosen(PairMask mask, Pair first, Pair second) noexcept {
  return reinterpret_cast<Pair>((mask & reinterpret_cast<PairMask>(first)) |
                                (~mask & reinterpret_cast<PairMask>(second)));
}

/// Nearest multiples (even if there are two) of 2^-52 times `large`, which are powers of two, of
/// numbers below `large` in magnitude; where that is 0, the numbers themselves.
[[nodiscard]] inline Pair nearestMultiples(Pair x, Pair large) noexcept {
  constexpr std::int64_t kSign = std::numeric_limits<std::int64_t>::min();
  const PairMask sign = reinterpret_cast<PairMask>(x) & PairMask{kSign, kSign};
  const Pair signedLarge = reinterpret_cast<Pair>(reinterpret_cast<PairMask>(large) | sign);
  return (x + signedLarge) - signedLarge;
}

/// Largest integers that are not larger, of numbers below 2^51 in magnitude.
[[nodiscard]] inline Pair floorOf(Pair x) noexcept {
  constexpr Pair kLarge = {0x1.8p52, 0x1.8p52};
  constexpr Pair kOne = {1, 1};
  const Pair nearest = (x + kLarge) - kLarge;
  const PairMask above = nearest > x;
  return nearest - reinterpret_cast<Pair>(above & reinterpret_cast<PairMask>(kOne));
}

/// As std::max.
[[nodiscard]] inline Pair larger(Pair a, Pair b) noexcept { return a < b ? b : a; }

/// As std::min.
[[nodiscard]] inline Pair smaller(Pair a, Pair b) noexcept { return a < b ? a : b; }

}  // namespace hexhex
