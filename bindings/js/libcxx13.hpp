// What the C++ library of Debian's emscripten (libc++ 13) lacks of C++20 and the library uses. The
// wasm build includes this file before all others; nothing else does.
#pragma once

#include <version>
#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <compare>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include <fast_float/fast_float.h>
#define FMT_HEADER_ONLY 1
#include <fmt/format.h>

// NOLINTBEGIN(cert-dcl58-cpp): names that the standard puts here.
namespace std {

template <class To, class From>
[[nodiscard]] constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

template <class A, class B>
[[nodiscard]] constexpr auto compareElements(const A& a, const B& b) noexcept {
  auto order = strong_ordering::equal;
  for (size_t i = 0; i < a.size() && i < b.size() && order == 0; ++i) order = a[i] <=> b[i];
  return order != 0 ? order : a.size() <=> b.size();
}
template <class T, size_t n>
[[nodiscard]] constexpr auto operator<=>(const array<T, n>& a, const array<T, n>& b) noexcept {
  return compareElements(a, b);
}
template <class T, class A>
[[nodiscard]] auto operator<=>(const vector<T, A>& a, const vector<T, A>& b) noexcept {
  return compareElements(a, b);
}
template <class A, class B>
[[nodiscard]] constexpr auto operator<=>(const pair<A, B>& a, const pair<A, B>& b) noexcept {
  const strong_ordering order = a.first <=> b.first;
  return order != 0 ? order : a.second <=> b.second;
}

/// For one thread, which is all that the wasm build has.
template <class T>
class atomic_ref {
 public:
  explicit atomic_ref(T& value) noexcept : value_(&value) {}
  [[nodiscard]] T load(memory_order /*order*/ = memory_order_seq_cst) const noexcept {
    return *value_;
  }
  void store(T desired, memory_order /*order*/ = memory_order_seq_cst) const noexcept {
    *value_ = desired;
  }
  T exchange(T desired, memory_order /*order*/ = memory_order_seq_cst) const noexcept {
    return std::exchange(*value_, desired);
  }
  T fetch_add(T by, memory_order /*order*/ = memory_order_seq_cst) const noexcept {
    return std::exchange(*value_, static_cast<T>(*value_ + by));
  }
  T fetch_or(T bits, memory_order /*order*/ = memory_order_seq_cst) const noexcept {
    return std::exchange(*value_, static_cast<T>(*value_ | bits));
  }
  bool compare_exchange_strong(T& expected, T desired,
                               memory_order /*ifEqual*/ = memory_order_seq_cst,
                               memory_order /*otherwise*/ = memory_order_seq_cst) const noexcept {
    const bool equal = *value_ == expected;
    equal ? * value_ = desired : expected = *value_;
    return equal;
  }
  bool compare_exchange_weak(T& expected, T desired, memory_order ifEqual = memory_order_seq_cst,
                             memory_order otherwise = memory_order_seq_cst) const noexcept {
    return compare_exchange_strong(expected, desired, ifEqual, otherwise);
  }

 private:
  T* value_;
};

inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const auto result = fast_float::from_chars(first, last, value);
  // Where the standard leaves the value alone, fast_float gives infinity or zero and no error.
  if (result.ec == errc() && isinf(value) && first != last &&
      ((*first >= '0' && *first <= '9') || *first == '.' || *first == '-') &&
      string_view(first, static_cast<size_t>(result.ptr - first)).find_first_of("iI") ==
          string_view::npos) {
    return {result.ptr, errc::result_out_of_range};
  }
  return {result.ptr, result.ec};
}

/// With so many significant digits, as printf() does it.
inline to_chars_result to_chars(char* first, char* last, double value, chars_format /*general*/,
                                int precision) {
  array<char, 64> text{};
  const int length = snprintf(text.data(), text.size(), "%.*g", precision, value);
  if (length > last - first) return {last, errc::value_too_large};
  return {copy_n(text.data(), length, first), errc()};
}

/// The fewest digits that read back to the value, in the shorter one of both notations; fixed if
/// these are equally long. The digits are fmt's.
inline to_chars_result to_chars(char* first, char* last, double value) {
  // Room for 309 digits before the point.
  array<char, 400> text{};
  char* end = text.data();
  const auto done = [&]() -> to_chars_result {
    if (end - text.data() > last - first) return {last, errc::value_too_large};
    return {std::copy(text.data(), end, first), errc()};
  };
  if (signbit(value)) *end++ = '-';
  if (!isfinite(value) || value == 0) {
    const string_view word = isnan(value) ? "nan" : isinf(value) ? "inf" : "0";
    end = std::copy(word.begin(), word.end(), end);
    return done();
  }
  const auto decimal = fmt::detail::dragonbox::to_decimal(abs(value));
  array<char, 24> digits{};
  const int count = static_cast<int>(
      to_chars(digits.data(), digits.data() + digits.size(), decimal.significand).ptr -
      digits.data());
  const int point = count + decimal.exponent;  // digits before the decimal point
  const int exponent = point - 1;
  const int exponentDigits = abs(exponent) >= 100 ? 3 : 2;
  const int scientific = count + (count > 1 ? 1 : 0) + 2 + exponentDigits;
  const int fixed = point <= 0 ? 2 - point + count : point >= count ? point : count + 1;
  const auto put = [&](int from, int to) {
    end = std::copy(digits.data() + from, digits.data() + to, end);
  };
  if (fixed > scientific) {
    put(0, 1);
    if (count > 1) *end++ = '.';
    put(1, count);
    end += snprintf(end, 8, "e%+03d", exponent);
  } else if (point >= count) {
    // All digits of a whole number, also those that reading back does not need.
    end += snprintf(end, 330, "%.0f", abs(value));
  } else if (point > 0) {
    put(0, point);
    *end++ = '.';
    put(point, count);
  } else {
    end = std::copy_n("0.", 2, end);
    end = std::fill_n(end, -point, '0');
    put(0, count);
  }
  return done();
}

namespace ranges {

template <class In, class Out>
struct in_out_result {
  In in;
  Out out;
};

template <class Range, class Out>
constexpr auto copy(Range&& range, Out to) {
  return in_out_result<decltype(std::begin(range)), Out>{
      std::end(range), std::copy(std::begin(range), std::end(range), to)};
}
template <class Range, class T>
constexpr void fill(Range&& range, const T& value) {
  std::fill(std::begin(range), std::end(range), value);
}
template <class Range, class Condition>
constexpr auto find_if(Range&& range, Condition condition) {
  return std::find_if(std::begin(range), std::end(range), condition);
}
template <class Range, class Condition>
constexpr bool any_of(Range&& range, Condition condition) {
  return std::any_of(std::begin(range), std::end(range), condition);
}

}  // namespace ranges
}  // namespace std
// NOLINTEND(cert-dcl58-cpp)

#endif
