// Text and numbers as one text, for messages.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

namespace hexhex {

/// The parts one after the other: texts, paths, characters, and numbers as std::to_string() has
/// them. By value, so that literals of different lengths share their code, and no variable of a
/// loop has its address taken for an error.
template <class... Parts>
[[nodiscard]] std::string concat(Parts... parts) {
  std::string text;
  const auto add = [&text]<class Part>(const Part& part) {
    static_assert(!std::is_same_v<Part, bool>);
    if constexpr (std::is_convertible_v<const Part&, std::string_view>) {
      text += std::string_view(part);
    } else if constexpr (std::is_same_v<Part, char>) {
      text += part;
    } else if constexpr (requires { part.string(); }) {
      text += part.string();
    } else {
      text += std::to_string(part);
    }
  };
  (add(parts), ...);
  return text;
}

}  // namespace hexhex
