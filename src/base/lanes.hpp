// Short vectors of numbers (SIMD). Each lane behaves as a scalar would. Compilers like GCC and
// Clang have types for vector registers; elsewhere, or with HEXHEX_PLAIN_VECTORS, a class stands in
// for them, which optimizers see through to varying degrees.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#if !defined(__GNUC__) && !defined(HEXHEX_PLAIN_VECTORS)
#define HEXHEX_PLAIN_VECTORS 1
#endif

// Code for lanes is compiled for several register widths: all of it is inlined into one entry point
// for each width.
#if defined(__GNUC__)
#define HEXHEX_INLINE [[gnu::always_inline]] inline
#else
#define HEXHEX_INLINE inline
#endif
// For entry points; undefined where there is one width. Windows aligns stacks too little for wide
// registers.
#if defined(__x86_64__) && !defined(_WIN32) && !defined(HEXHEX_PLAIN_VECTORS)
#define HEXHEX_WIDE [[gnu::target("avx2"), gnu::flatten]]
#endif

namespace hexhex {

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // all is inline
#endif

/// Reinterprets the bits as another type of the same size.
template <class To, class From>
#if defined(__GNUC__)
[[gnu::always_inline]]
#endif
[[nodiscard]] inline To
bitsAs(const From& x) noexcept {
  static_assert(sizeof(To) == sizeof(From));
  To bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

#if defined(HEXHEX_PLAIN_VECTORS)

/// @tparam T  double or an integer; masks are integers of its size, 0 or -1
template <class T, std::size_t n>
struct Lanes {
  using Mask =
      Lanes<std::conditional_t<sizeof(T) == sizeof(std::int64_t), std::int64_t, std::int32_t>, n>;

  Lanes() = default;
  // As with the compilers' own types, a number converts to lanes that all hold it.
  constexpr Lanes(T all) noexcept {
    for (T& each : lanes) each = all;
  }
  template <std::convertible_to<T>... Numbers>
  requires(sizeof...(Numbers) == n) constexpr Lanes(Numbers... numbers) noexcept
      : lanes{static_cast<T>(numbers)...} {}

  [[nodiscard]] constexpr T& operator[](std::size_t i) noexcept { return lanes[i]; }
  [[nodiscard]] constexpr const T& operator[](std::size_t i) const noexcept { return lanes[i]; }

#define HEXHEX_LANES_OPERATOR(symbol)                                                 \
  friend constexpr Lanes operator symbol(const Lanes& a, const Lanes& b) noexcept {   \
    Lanes result;                                                                     \
    for (std::size_t i = 0; i < n; ++i) result[i] = static_cast<T>(a[i] symbol b[i]); \
    return result;                                                                    \
  }                                                                                   \
  constexpr Lanes& operator symbol##=(const Lanes& b) noexcept { return *this = *this symbol b; }
  HEXHEX_LANES_OPERATOR(+)
  HEXHEX_LANES_OPERATOR(-)
  HEXHEX_LANES_OPERATOR(*)
  HEXHEX_LANES_OPERATOR(/)
  HEXHEX_LANES_OPERATOR(&)
  HEXHEX_LANES_OPERATOR(|)
  HEXHEX_LANES_OPERATOR(^)
  HEXHEX_LANES_OPERATOR(<<)
  HEXHEX_LANES_OPERATOR(>>)
#undef HEXHEX_LANES_OPERATOR
#define HEXHEX_LANES_COMPARISON(symbol)                                            \
  friend constexpr Mask operator symbol(const Lanes& a, const Lanes& b) noexcept { \
    Mask result;                                                                   \
    for (std::size_t i = 0; i < n; ++i) result[i] = a[i] symbol b[i] ? -1 : 0;     \
    return result;                                                                 \
  }
  HEXHEX_LANES_COMPARISON(<)
  HEXHEX_LANES_COMPARISON(>)
  HEXHEX_LANES_COMPARISON(<=)
  HEXHEX_LANES_COMPARISON(>=)
  HEXHEX_LANES_COMPARISON(==)
  HEXHEX_LANES_COMPARISON(!=)
#undef HEXHEX_LANES_COMPARISON
  constexpr Lanes operator-() const noexcept {
    Lanes result;
    for (std::size_t i = 0; i < n; ++i) result[i] = -lanes[i];
    return result;
  }
  constexpr Lanes operator~() const noexcept {
    Lanes result;
    for (std::size_t i = 0; i < n; ++i) result[i] = ~lanes[i];
    return result;
  }

  /// Per lane: `a` where the mask is set, otherwise `b`.
  [[nodiscard]] static constexpr Lanes choose(const Mask& first, const Lanes& a,
                                              const Lanes& b) noexcept {
    Lanes result;
    for (std::size_t i = 0; i < n; ++i) result[i] = first[i] != 0 ? a[i] : b[i];
    return result;
  }

  T lanes[n];  // NOLINT: no std::array, whose element functions are not inlined in debug builds
};

/// Rounds each lane towards zero.
template <class To, class T, std::size_t n>
[[nodiscard]] constexpr To truncated(const Lanes<T, n>& x) noexcept {
  To result;
  for (std::size_t i = 0; i < n; ++i) {
    result[i] = static_cast<std::remove_cvref_t<decltype(result[i])>>(x[i]);
  }
  return result;
}
template <class T, std::size_t n>
[[nodiscard]] constexpr Lanes<T, n> larger(const Lanes<T, n>& a, const Lanes<T, n>& b) noexcept {
  return Lanes<T, n>::choose(a < b, b, a);
}
template <class T, std::size_t n>
[[nodiscard]] constexpr Lanes<T, n> smaller(const Lanes<T, n>& a, const Lanes<T, n>& b) noexcept {
  return Lanes<T, n>::choose(a < b, a, b);
}

#else

/// In programs for narrower registers, GCC aligns these like narrower ones, yet functions for wide
/// registers rely on more: variables in memory there need alignas.
template <class T, std::size_t n>
struct LanesOf {
  using Type __attribute__((vector_size(n * sizeof(T)))) = T;
};
template <class T, std::size_t n>
using Lanes = typename LanesOf<T, n>::Type;

/// Rounds each lane towards zero.
template <class To, class From>
[[nodiscard]] inline To truncated(const From& x) noexcept {
  return __builtin_convertvector(x, To);
}
/// std::max per lane.
template <class V>
[[nodiscard, gnu::always_inline]] inline V larger(const V& a, const V& b) noexcept {
  return a < b ? b : a;
}
/// std::min per lane.
template <class V>
[[nodiscard, gnu::always_inline]] inline V smaller(const V& a, const V& b) noexcept {
  return a < b ? a : b;
}

#endif

/// Per-lane square root of doubles.
template <class V>
#if defined(__GNUC__)
[[gnu::always_inline]]
#endif
[[nodiscard]] inline V
rootOf(const V& x) noexcept {
  V roots;
#if defined(__SSE2__) && !defined(HEXHEX_PLAIN_VECTORS)
  // Compilers would add a call for each negative lane, so that it can report an error.
  for (std::size_t i = 0; i < sizeof x / sizeof(__m128d); ++i) {  // NOLINT: of one size, perhaps
    __m128d two;
    std::memcpy(&two, reinterpret_cast<const char*>(&x) + i * sizeof two, sizeof two);
    two = _mm_sqrt_pd(two);
    std::memcpy(reinterpret_cast<char*>(&roots) + i * sizeof two, &two, sizeof two);
  }
#else
  for (std::size_t i = 0; i < sizeof x / sizeof(double); ++i) roots[i] = std::sqrt(x[i]);
#endif
  return roots;
}

/// Per lane of doubles: `a` where the condition is positive, otherwise `b`.
template <class V>
HEXHEX_INLINE V wherePositive(const V& condition, const V& a, const V& b) noexcept {
#if defined(HEXHEX_PLAIN_VECTORS)
  return V::choose(condition > 0.0, a, b);
#else
  return condition > 0 ? a : b;
#endif
}

/// @tparam V  Lanes of double
template <class V>
using LaneVector = std::array<V, 3>;

template <class V>
HEXHEX_INLINE V dot(const LaneVector<V>& a, const LaneVector<V>& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class V>
HEXHEX_INLINE LaneVector<V> cross(const LaneVector<V>& a, const LaneVector<V>& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

// Two doubles at a time. Each lane behaves as a scalar would.

using Pair = Lanes<double, 2>;
/// One mask per lane: 0 or -1.
using PairMask = Lanes<std::int64_t, 2>;

using PairBits = Lanes<std::uint64_t, 2>;

using IntPair = Lanes<std::int32_t, 2>;

/// Loads two consecutive numbers.
[[nodiscard]] inline Pair loadPair(const double* first) noexcept {
  Pair pair;
  std::memcpy(&pair, first, sizeof pair);
  return pair;
}

[[nodiscard]] inline Pair magnitudeOf(Pair x) noexcept {
  constexpr std::int64_t kAllButSign = 0x7fffffffffffffff;
  return bitsAs<Pair>(bitsAs<PairMask>(x) & PairMask{kAllButSign, kAllButSign});
}

/// The sign bit of each lane: 1 for negative numbers and -0, otherwise 0.
[[nodiscard]] inline PairBits signBits(Pair x) noexcept { return bitsAs<PairBits>(x) >> 63; }

/// Per lane: `first` where the mask is set, otherwise `second`.
[[nodiscard]] inline Pair chosen(PairMask mask, Pair first, Pair second) noexcept {
  return bitsAs<Pair>((mask & bitsAs<PairMask>(first)) | (~mask & bitsAs<PairMask>(second)));
}

/// Rounds numbers below `large` in magnitude to the nearest multiple of 2^-52 `large`, ties to
/// even. `large` is a power of two, or 0, which leaves the number unchanged.
[[nodiscard]] inline Pair nearestMultiples(Pair x, Pair large) noexcept {
  constexpr std::int64_t kSign = std::numeric_limits<std::int64_t>::min();
  const PairMask sign = bitsAs<PairMask>(x) & PairMask{kSign, kSign};
  const Pair signedLarge = bitsAs<Pair>(bitsAs<PairMask>(large) | sign);
  return (x + signedLarge) - signedLarge;
}

/// Per-lane floor of numbers below 2^51 in magnitude.
[[nodiscard]] inline Pair floorOf(Pair x) noexcept {
  constexpr Pair kLarge = {0x1.8p52, 0x1.8p52};
  constexpr Pair kOne = {1, 1};
  const Pair nearest = (x + kLarge) - kLarge;
  const PairMask above = nearest > x;
  return nearest - bitsAs<Pair>(above & bitsAs<PairMask>(kOne));
}

}  // namespace hexhex
