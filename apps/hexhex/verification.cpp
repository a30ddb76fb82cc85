#include "verification.hpp"

#include <string>

#include <fmt/core.h>

#include <hexhex/error.hpp>

namespace hexhex::command {

void requirePassed(const VerifyReport& report, std::string_view problem, std::string_view advice) {
  if (report.passed()) return;
  if (report.ambiguous) {
    throw Error(ErrorCode::AmbiguousMesh,
                "The map is so coarse that different edges or faces of the mesh have the same "
                "vertices, and vertices are all that names them. Use --scale 2 or 3. (--no-verify "
                "writes the mesh regardless.)");
  }
  std::string items;
  for (const VerifyItem& item : report.items) {
    if (item.passed) continue;
    items += fmt::format("{} {}: expected {}, found {}", items.empty() ? "" : ";", item.name,
                         item.expected, item.found);
  }
  throw Error(ErrorCode::VerificationFailed, fmt::format("{}:{}. {}", problem, items, advice));
}

}  // namespace hexhex::command
