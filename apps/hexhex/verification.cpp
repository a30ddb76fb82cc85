#include "verification.hpp"

#include <string>

#include <fmt/core.h>

#include <hexhex/error.hpp>

namespace hexhex::command {

void requirePassed(const VerifyReport& report, std::string_view problem, std::string_view advice) {
  if (report.passed()) return;
  std::string items;
  for (const VerifyItem& item : report.items) {
    if (item.passed) continue;
    items += fmt::format("{} {}: expected {}, found {}", items.empty() ? "" : ";", item.name,
                         item.expected, item.found);
  }
  throw Error(ErrorCode::VerificationFailed, fmt::format("{}:{}. {}", problem, items, advice));
}

}  // namespace hexhex::command
