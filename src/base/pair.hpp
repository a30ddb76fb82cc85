// Two doubles that are worked with at once. Each behaves as it would alone.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>

#include <base/lanes.hpp>

namespace hexhex {

using Pair = Lanes<double, 2>;
/// One truth value for each: 0 or -1.
using PairMask = Lanes<std::int64_t, 2>;

using PairBits = Lanes<std::uint64_t, 2>;

using IntPair = Lanes<std::int32_t, 2>;

/// Two numbers in a row.
[[nodiscard]] inline Pair loadPair(const double* first) noexcept {
  Pair pair;
  std::memcpy(&pair, first, sizeof pair);
  return pair;
}

[[nodiscard]] inline Pair magnitudeOf(Pair x) noexcept {
  constexpr std::int64_t kAllButSign = 0x7fffffffffffffff;
  return bitsAs<Pair>(bitsAs<PairMask>(x) & PairMask{kAllButSign, kAllButSign});
}

/// 1 for negative numbers, 0 for others.
[[nodiscard]] inline PairBits signBits(Pair x) noexcept { return bitsAs<PairBits>(x) >> 63; }

/// The first where the mask is set, elsewhere the second.
[[nodiscard]] inline Pair chosen(PairMask mask, Pair first, Pair second) noexcept {
  return bitsAs<Pair>((mask & bitsAs<PairMask>(first)) | (~mask & bitsAs<PairMask>(second)));
}

/// Nearest multiples (even if there are two) of 2^-52 times `large`, which are powers of two, of
/// numbers below `large` in magnitude; where that is 0, the numbers themselves.
[[nodiscard]] inline Pair nearestMultiples(Pair x, Pair large) noexcept {
  constexpr std::int64_t kSign = std::numeric_limits<std::int64_t>::min();
  const PairMask sign = bitsAs<PairMask>(x) & PairMask{kSign, kSign};
  const Pair signedLarge = bitsAs<Pair>(bitsAs<PairMask>(large) | sign);
  return (x + signedLarge) - signedLarge;
}

/// Largest integers that are not larger, of numbers below 2^51 in magnitude.
[[nodiscard]] inline Pair floorOf(Pair x) noexcept {
  constexpr Pair kLarge = {0x1.8p52, 0x1.8p52};
  constexpr Pair kOne = {1, 1};
  const Pair nearest = (x + kLarge) - kLarge;
  const PairMask above = nearest > x;
  return nearest - bitsAs<Pair>(above & bitsAs<PairMask>(kOne));
}

}  // namespace hexhex
