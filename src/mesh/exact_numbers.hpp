// Exact numbers beyond doubles, for signs and conversions that doubles cannot decide.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace hexhex::mesh {

/// An unevaluated sum of two doubles; high is the double nearest to it. Sums of products of numbers
/// around 1 are accurate to within 2^-98 of the sum of magnitudes per product.
struct Twofold {
  double high = 0;
  double low = 0;
};

/// a + b, exactly (Knuth).
[[nodiscard]] inline Twofold exactSum(double a, double b) noexcept {
  const double sum = a + b;
  const double part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// a b, exactly (Dekker), unless the halves leave the range of doubles.
[[nodiscard]] inline Twofold exactProduct(double a, double b) noexcept {
  constexpr double kSplitter = 0x1p27 + 1;
  const double aTop = kSplitter * a - (kSplitter * a - a);
  const double bTop = kSplitter * b - (kSplitter * b - b);
  const double aRest = a - aTop;
  const double bRest = b - bTop;
  const double product = a * b;
  return {product, ((aTop * bTop - product) + aTop * bRest + aRest * bTop) + aRest * bRest};
}

/// The difference of two doubles.
[[nodiscard]] inline Twofold operator-(const Twofold& a, const Twofold& b) noexcept {
  return exactSum(a.high, -b.high);
}

inline void addProduct(Twofold& sum, const Twofold& a, const Twofold& b) noexcept {
  const Twofold product = exactProduct(a.high, b.high);
  const Twofold high = exactSum(sum.high, product.high);
  const double low = sum.low + (high.low + (product.low + (a.high * b.low + a.low * b.high)));
  sum = exactSum(high.high, low);
}

// Integers of any size, for signs that nothing smaller decides. Simple rather than fast.

/// Two's complement in 32-bit digits, least significant first; 0 has none.
class BigInteger {
 public:
  BigInteger() = default;

  /// value * 2^shift, an integer.
  BigInteger(double value, int shift) {
    if (value == 0) return;  // whatever the shift, which is undefined for a cell of zeros
    constexpr int kBits = std::numeric_limits<double>::digits;
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);  // value = fraction 2^exponent
    auto mantissa = static_cast<std::int64_t>(std::ldexp(fraction, kBits));
    int rest = exponent - kBits + shift;
    for (; rest < 0; ++rest) {
      assert(mantissa % 2 == 0);
      mantissa /= 2;
    }
    const auto bits = static_cast<std::uint64_t>(mantissa);
    digits_ = {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32U)};
    trim();
    *this = shifted(rest);
  }

  [[nodiscard]] static BigInteger of(std::int64_t value) {
    const BigInteger high(static_cast<double>(value >> 32), 0);
    return high.shifted(32) + BigInteger(static_cast<double>(value & 0xffffffff), 0);
  }

  [[nodiscard]] int sign() const noexcept {
    return digits_.empty() ? 0 : (extension() != 0 ? -1 : 1);
  }

  [[nodiscard]] BigInteger shifted(int bits) const {
    assert(bits >= 0);
    if (digits_.empty()) return *this;
    BigInteger result;
    const auto whole = static_cast<std::size_t>(bits / 32);
    const int part = bits % 32;
    result.digits_.assign(whole, 0);
    std::uint32_t below = 0;
    for (std::size_t i = 0; i <= digits_.size(); ++i) {
      const std::uint64_t both = (std::uint64_t{digit(i)} << 32U) | below;
      result.digits_.push_back(static_cast<std::uint32_t>(both >> (32 - part)));
      below = digit(i);
    }
    result.trim();
    return result;
  }

  friend BigInteger operator+(const BigInteger& a, const BigInteger& b) { return sum(a, b, 0); }
  friend BigInteger operator-(const BigInteger& a, const BigInteger& b) { return sum(a, b, ~0U); }

  friend BigInteger operator*(const BigInteger& a, const BigInteger& b) {
    BigInteger result;  // modulo a power of two greater than twice the product
    result.digits_.resize(a.digits_.size() + b.digits_.size());
    for (std::size_t i = 0; i < result.digits_.size(); ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; i + j < result.digits_.size(); ++j) {
        carry += std::uint64_t{a.digit(i)} * b.digit(j) + result.digits_[i + j];
        result.digits_[i + j] = static_cast<std::uint32_t>(carry);
        carry >>= 32U;
      }
    }
    result.trim();
    return result;
  }

 private:
  /// a + b, or a - b = a + ~b + 1 with the mask ~0.
  static BigInteger sum(const BigInteger& a, const BigInteger& b, std::uint32_t mask) {
    BigInteger result;
    result.digits_.resize(std::max(a.digits_.size(), b.digits_.size()) + 1);
    std::uint64_t carry = mask & 1U;
    for (std::size_t i = 0; i < result.digits_.size(); ++i) {
      carry += std::uint64_t{a.digit(i)} + (b.digit(i) ^ mask);
      result.digits_[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32U;
    }
    result.trim();
    return result;
  }

  /// All higher digits.
  [[nodiscard]] std::uint32_t extension() const noexcept {
    return !digits_.empty() && (digits_.back() >> 31U) != 0 ? ~0U : 0U;
  }
  [[nodiscard]] std::uint32_t digit(std::size_t i) const noexcept {
    return i < digits_.size() ? digits_[i] : extension();
  }

  /// Removes digits that only repeat the sign.
  void trim() {
    while (!digits_.empty()) {
      const std::uint32_t last = digits_.back();
      digits_.pop_back();
      if (extension() == last) continue;
      digits_.push_back(last);
      return;
    }
  }

  std::vector<std::uint32_t> digits_;
};

}  // namespace hexhex::mesh
