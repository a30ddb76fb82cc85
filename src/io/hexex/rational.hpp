// Correctly rounded quotients of decimal integers of any length, as exact maps store them.
#pragma once

#include <string_view>

namespace hexhex {

/// The double nearest to numerator / denominator, ties to even; infinity if it exceeds the largest
/// double; subnormal or 0 if it is that small.
///
/// Both are decimal digits only, at least one, without a sign; the denominator is not 0. Time grows
/// with the square of the number of digits.
[[nodiscard]] double nearestQuotient(std::string_view numerator, std::string_view denominator);

}  // namespace hexhex
