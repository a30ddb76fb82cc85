// Faults of labels and fields in sentences.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace hexhex::shape {

/// For example "corners without room (2), points where borders turn back (1)": the kinds of faults
/// that occur, and how often.
[[nodiscard]] inline std::string countedFaults(
    const std::vector<std::pair<const char*, std::uint64_t>>& kinds) {
  std::string text;
  for (const auto& [kind, count] : kinds) {
    if (count == 0) continue;
    if (!text.empty()) text += ", ";
    text.append(kind).append(" (").append(std::to_string(count)).append(")");
  }
  return text;
}

}  // namespace hexhex::shape
