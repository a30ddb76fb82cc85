// Words and file names whose letter case means nothing. ASCII only: no locale has a say.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace hexhex {

[[nodiscard]] constexpr char lowerCase(char c) noexcept {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

[[nodiscard]] inline std::string lowerCase(std::string_view word) {
  std::string result(word);
  for (char& c : result) c = lowerCase(c);
  return result;
}

/// With the dot; empty if the file's name has none.
[[nodiscard]] inline std::string lowerCaseExtension(const std::filesystem::path& file) {
  return lowerCase(file.extension().string());
}

}  // namespace hexhex
