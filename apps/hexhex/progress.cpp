#include "progress.hpp"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

#include <fmt/core.h>

#include "output.hpp"

namespace hexhex::command {
namespace {

constexpr int kBarWidth = 30;  // with the longest stage name it fits in 80 columns

}  // namespace

ProgressDisplay::ProgressDisplay(bool quiet)
    : quiet_(quiet), onTerminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressDisplay::~ProgressDisplay() { clear(); }

Context::Progress ProgressDisplay::callback() {
  if (quiet_) return {};
  return [this](std::string_view stage, double share) { show(stage, share); };
}

void ProgressDisplay::clear() {
  if (barIsVisible_) printToStderr("\r\033[K");
  barIsVisible_ = false;
}

void ProgressDisplay::show(std::string_view stage, double share) {
  if (onTerminal_) {
    const int done = static_cast<int>(share * kBarWidth);
    printToStderr("\r\033[K[{}{}] {:3.0f} % {}", std::string(static_cast<std::size_t>(done), '#'),
                  std::string(static_cast<std::size_t>(kBarWidth - done), ' '), share * 100, stage);
    std::fflush(stderr);
    barIsVisible_ = true;
  } else if (std::find(printed_.begin(), printed_.end(), stage) == printed_.end()) {
    printToStderr("hexhex: {}\n", stage);
    printed_.emplace_back(stage);
  }
}

}  // namespace hexhex::command
