// Numbers as files spell them: decimals of any length, and rationals p/q.
#pragma once

#include <string_view>

namespace hexhex {

enum class NumberProblem {
  None,
  NotANumber,
  NotFinite,        ///< infinity or NaN, spelled out
  Overflow,         ///< beyond the largest double
  ZeroDenominator,  ///< p/0
  TooLong           ///< a rational with more digits than kMaxRationalDigits
};

/// The longest numerator or denominator that is accepted. Far beyond what exact maps hold (some
/// hundred digits); it keeps a file of nothing but digits from taking hours.
inline constexpr std::size_t kMaxRationalDigits = std::size_t{1} << 16;

/// Parses one whole token: an optional sign; then a decimal number with or without a point and an
/// exponent, or two integers with '/' between them. The result is the nearest double, ties to even;
/// numbers too small for a double become 0.
/// @param[out] value  set if the result is None
[[nodiscard]] NumberProblem parseNumber(std::string_view token, double& value);

/// The double nearest to numerator / denominator, ties to even; infinity if it exceeds the largest
/// double; subnormal or 0 if it is that small.
///
/// Both are decimal digits only, at least one, without a sign; the denominator is not 0. Time grows
/// with the square of the number of digits.
[[nodiscard]] double nearestQuotient(std::string_view numerator, std::string_view denominator);

}  // namespace hexhex
