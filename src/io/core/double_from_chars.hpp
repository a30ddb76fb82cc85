// std::from_chars() for doubles, also where the standard library supports integers only (libc++
// before 20).
#pragma once

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#if defined(__APPLE__)
#include <xlocale.h>
#elif !defined(_WIN32)
#include <locale.h>  // NOLINT(modernize-deprecated-headers): POSIX has more in it than C++
#endif

namespace hexhex::io {

#if !defined(_WIN32)
namespace detail {

/// The same, based on strtod().
inline std::from_chars_result doubleByStrtod(const char* first, const char* last, double& value) {
  // from_chars() accepts neither leading spaces nor plus signs, and reads "0x1" as 0.
  constexpr std::string_view kCharacters = "+-.0123456789eEinfatyINFATY()";
  const std::string_view text(first, static_cast<std::size_t>(last - first));
  const std::string number(text.substr(0, text.find_first_not_of(kCharacters)));
  if (number.empty() || number.front() == '+') return {first, std::errc::invalid_argument};
  // The program may have set a locale with another decimal point.
  static const auto plain = newlocale(LC_ALL_MASK, "C", nullptr);
  char* end = nullptr;
  const double parsed = strtod_l(number.c_str(), &end, plain);
  const auto length = end - number.c_str();
  if (length == 0) return {first, std::errc::invalid_argument};
  const bool hasDigit = number.find_first_of("0123456789") < static_cast<std::size_t>(length);
  const bool hasNonzero = number.find_first_of("123456789") <
                          std::min(number.find_first_of("eE"), static_cast<std::size_t>(length));
  if (hasDigit && (std::isinf(parsed) || (parsed == 0 && hasNonzero))) {
    return {first + length, std::errc::result_out_of_range};
  }
  value = parsed;
  return {first + length, std::errc()};
}

}  // namespace detail
#endif

/// @tparam T  double; a template parameter, so that a missing overload is not a compile error
template <class T>
std::from_chars_result doubleFromChars(const char* first, const char* last, T& value) {
#if !defined(_WIN32)
  if constexpr (!requires { std::from_chars(first, last, value); }) {
    return detail::doubleByStrtod(first, last, value);
  } else
#endif
  {
    return std::from_chars(first, last, value);
  }
}

}  // namespace hexhex::io
