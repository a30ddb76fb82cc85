// Numbers of twice the digits of a double, as a sum of two: for conversions that lose many.
#pragma once

namespace hexhex::mesh {

/// high is the double nearest to the number. Sums of products of numbers around 1 are right to
/// within 2^-98 of the sum of magnitudes per product.
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

/// a b, exactly (Dekker), unless halves leave the range of doubles.
[[nodiscard]] inline Twofold exactProduct(double a, double b) noexcept {
  constexpr double kSplitter = 0x1p27 + 1;
  const double aTop = kSplitter * a - (kSplitter * a - a);
  const double bTop = kSplitter * b - (kSplitter * b - b);
  const double aRest = a - aTop;
  const double bRest = b - bTop;
  const double product = a * b;
  return {product, ((aTop * bTop - product) + aTop * bRest + aRest * bTop) + aRest * bRest};
}

/// Of doubles.
[[nodiscard]] inline Twofold operator-(const Twofold& a, const Twofold& b) noexcept {
  return exactSum(a.high, -b.high);
}

inline void addProduct(Twofold& sum, const Twofold& a, const Twofold& b) noexcept {
  const Twofold product = exactProduct(a.high, b.high);
  const Twofold high = exactSum(sum.high, product.high);
  const double low = sum.low + (high.low + (product.low + (a.high * b.low + a.low * b.high)));
  sum = exactSum(high.high, low);
}

}  // namespace hexhex::mesh
