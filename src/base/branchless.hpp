// Conditions that are all evaluated, as a processor could not foretell where to stop.
#pragma once

namespace hexhex {

template <class... Bools>
[[nodiscard]] constexpr bool allOf(Bools... conditions) noexcept {
  return (static_cast<unsigned>(conditions) & ...) != 0;
}

}  // namespace hexhex
