#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <system_error>

#include <io/core/number_parsing.hpp>
#include <io/hexex/rational.hpp>

namespace hexhex {
namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Removes a leading sign and tells whether it was a minus.
bool takeSign(std::string_view& token) {
  if (token.empty() || (token.front() != '-' && token.front() != '+')) return false;
  const bool negative = token.front() == '-';
  token.remove_prefix(1);
  return negative;
}

bool allDigits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), isDigit);
}

NumberProblem parseRational(std::string_view numerator, std::string_view denominator,
                            double& value) {
  const bool negative = takeSign(denominator);
  if (!allDigits(numerator) || !allDigits(denominator)) return NumberProblem::NotANumber;
  if (std::max(numerator.size(), denominator.size()) > kMaxRationalDigits) {
    return NumberProblem::TooLong;
  }
  if (denominator.find_first_not_of('0') == std::string_view::npos) {
    return NumberProblem::ZeroDenominator;
  }
  const double quotient = nearestQuotient(numerator, denominator);
  if (std::isinf(quotient)) return NumberProblem::Overflow;
  value = negative ? -quotient : quotient;
  return NumberProblem::None;
}

/// Whether a decimal number, known to be outside of the range of doubles, is too large (not too
/// small): decided by the decimal exponent of its first digit that is not 0.
bool isTooLarge(std::string_view decimal) {
  const std::size_t mantissaEnd = std::min(decimal.find_first_of("eE"), decimal.size());
  const std::string_view mantissa = decimal.substr(0, mantissaEnd);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = mantissa.find_first_not_of("0.");
  if (first == std::string_view::npos) return false;
  std::int64_t exponent = 0;
  if (mantissaEnd < decimal.size()) {
    std::string_view digits = decimal.substr(mantissaEnd + 1);
    const bool negative = takeSign(digits);
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    if (result.ec == std::errc::result_out_of_range) return !negative;
    if (negative) exponent = -exponent;
  }
  // Half the range, so that adding the length of the mantissa cannot overflow.
  constexpr std::int64_t kLimit = std::numeric_limits<std::int64_t>::max() / 2;
  exponent = std::clamp(exponent, -kLimit, kLimit);
  return exponent + static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first) > 0;
}

NumberProblem parseDecimal(std::string_view decimal, double& value) {
  if (decimal.empty()) return NumberProblem::NotANumber;
  double parsed = 0;
  const char* const end = decimal.data() + decimal.size();
  const auto result = std::from_chars(decimal.data(), end, parsed);
  if (result.ec == std::errc::invalid_argument || result.ptr != end) {
    return NumberProblem::NotANumber;
  }
  const bool spelledOut = !isDigit(decimal.front()) && decimal.front() != '.';
  if (spelledOut) return NumberProblem::NotFinite;
  if (result.ec == std::errc::result_out_of_range || std::isinf(parsed)) {
    if (isTooLarge(decimal)) return NumberProblem::Overflow;
    parsed = 0;
  }
  value = parsed;
  return NumberProblem::None;
}

}  // namespace

NumberProblem parseNumber(std::string_view token, double& value) {
  const bool negative = takeSign(token);
  if (!token.empty() && (token.front() == '-' || token.front() == '+')) {
    return NumberProblem::NotANumber;
  }
  const std::size_t slash = token.find('/');
  double magnitude = 0;
  const NumberProblem problem =
      slash == std::string_view::npos
          ? parseDecimal(token, magnitude)
          : parseRational(token.substr(0, slash), token.substr(slash + 1), magnitude);
  if (problem == NumberProblem::None) value = negative ? -magnitude : magnitude;
  return problem;
}

}  // namespace hexhex
