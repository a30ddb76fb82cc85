// Functions that are compiled twice: for registers that all processors have, and for wide ones. All
// that they call is inlined into them (HEXHEX_INLINE).
#pragma once

#include <array>
#include <span>

#include <base/lanes.hpp>

namespace hexhex {

/// Converts to a pointer to a function that does the same, compiled for wide registers where the
/// compiler can do that.
template <auto function>
class Wide {
 public:
  template <class Result, class... Arguments>
  using Pointer = Result (*)(Arguments...);

  template <class Result, class... Arguments>
  constexpr operator Pointer<Result, Arguments...>() const noexcept {
#if defined(HEXHEX_WIDE)
    return call<Result, Arguments...>;
#else
    return function;
#endif
  }

 private:
#if defined(HEXHEX_WIDE)
  template <class Result, class... Arguments>
  HEXHEX_WIDE static Result call(Arguments... arguments) {
    return function(arguments...);
  }
#endif
};
template <auto function>
inline constexpr Wide<function> kWide;

/// Of entry points for both widths, the plain one first: those that run on this machine.
template <class Entry>
[[nodiscard]] std::span<const Entry> runnable(const std::array<Entry, 2>& both) noexcept {
#if defined(HEXHEX_WIDE)
  return std::span(both).first(__builtin_cpu_supports("avx2") ? 2 : 1);
#else
  return std::span(both).first(1);
#endif
}

}  // namespace hexhex
