// Reads a whole file into memory, which is the fastest way to parse it.
#pragma once

#include <filesystem>
#include <string_view>

#include <hexhex/types.hpp>

namespace hexhex {

/// The bytes of a file.
/// @throws Error FileNotFound if it does not exist, is a folder, or cannot be read to its end
[[nodiscard]] Array<char> readWholeFile(const std::filesystem::path& file);

/// The same bytes as text.
[[nodiscard]] inline std::string_view asText(const Array<char>& bytes) noexcept {
  return {bytes.data(), bytes.size()};
}

}  // namespace hexhex
