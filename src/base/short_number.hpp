// Numbers for messages.
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace hexhex {

/// "0.0123": three significant digits.
[[nodiscard]] inline std::string shortNumber(double value) {
  std::array<char, 32> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), "%.3g", value));
  return text.data();
}

}  // namespace hexhex
