// Integers wider than 64 bits, as far as the predicates need them.
#pragma once

#include <cstdint>

namespace hexhex::lattice {

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

[[nodiscard]] constexpr int sign(Int128 a) noexcept { return a > 0 ? 1 : (a < 0 ? -1 : 0); }

/// A non-negative number, rounded twice: to within 2^-52 of its value.
[[nodiscard]] constexpr double toDouble(Int128 value) noexcept {
  return static_cast<double>(static_cast<std::int64_t>(value >> 64)) * 0x1p64 +
         static_cast<double>(static_cast<std::uint64_t>(value));
}

/// The same for any number.
[[nodiscard]] constexpr double signedToDouble(Int128 value) noexcept {
  return value < 0 ? -toDouble(-value) : toDouble(value);
}

/// 192-bit two's complement accumulator of products of a 128-bit and a 64-bit integer: exact as
/// long as the sum stays below 2^191.
class Int192 {
 public:
  constexpr void addProduct(Int128 a, std::int64_t b) noexcept {
    // a = high * 2^64 + low, high signed and low not; low * b stays below 2^127.
    const auto low = static_cast<std::uint64_t>(a);
    const auto high = static_cast<std::int64_t>(a >> 64);
    UInt128 lowProduct = static_cast<UInt128>(low) * static_cast<std::uint64_t>(b);
    // As an unsigned factor, a negative b was 2^64 too large.
    if (b < 0) lowProduct -= static_cast<UInt128>(low) << 64;
    const Int128 carried = static_cast<Int128>(lowProduct) >> 64;
    const Int128 highProduct = static_cast<Int128>(high) * b + carried;
    *this += Int192(static_cast<std::uint64_t>(lowProduct), static_cast<UInt128>(highProduct));
  }

  constexpr Int192() = default;
  constexpr explicit Int192(Int128 value) noexcept
      : low_(static_cast<std::uint64_t>(value)), high_(static_cast<UInt128>(value >> 64)) {}

  constexpr Int192& operator+=(const Int192& other) noexcept {
    const std::uint64_t sum = low_ + other.low_;
    high_ += other.high_ + (sum < low_ ? 1U : 0U);
    low_ = sum;
    return *this;
  }
  [[nodiscard]] constexpr Int192 operator-() const noexcept {
    return Int192(~low_ + 1, ~high_ + (low_ == 0 ? 1U : 0U));
  }

  [[nodiscard]] constexpr int sign() const noexcept {
    if (static_cast<Int128>(high_) < 0) return -1;
    return low_ == 0 && high_ == 0 ? 0 : 1;
  }
  /// Nearest double, up to the rounding of its two halves.
  [[nodiscard]] constexpr double toDouble() const noexcept {
    if (sign() < 0) return -(-*this).toDouble();
    return static_cast<double>(high_) * 0x1p64 + static_cast<double>(low_);
  }
  /// this / 2^shift for non-negative values whose quotient fits 128 bits; `exact` becomes false if
  /// the division leaves a remainder.
  [[nodiscard]] constexpr UInt128 shiftedRight(int shift, bool& exact) const noexcept {
    std::uint64_t low = low_;
    UInt128 high = high_;
    for (; shift >= 64; shift -= 64) {
      exact = exact && low == 0;
      low = static_cast<std::uint64_t>(high);
      high >>= 64;
    }
    if (shift > 0) {
      exact = exact && (low & ((std::uint64_t{1} << shift) - 1)) == 0;
      low = (low >> shift) | (static_cast<std::uint64_t>(high) << (64 - shift));
      high >>= shift;
    }
    return (high << 64) | low;
  }

 private:
  constexpr Int192(std::uint64_t low, UInt128 high) noexcept : low_(low), high_(high) {}
  std::uint64_t low_ = 0;
  UInt128 high_ = 0;  // upper 128 bits
};

}  // namespace hexhex::lattice
