#include "progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unistd.h>

#include <fmt/core.h>

#include "output.hpp"

namespace hexhex::command {
namespace {

constexpr int kBarWidth = 30;  // with the longest stage name it fits in 80 columns

// What ends within a second needs no bar; ten pictures a second look smooth.
constexpr std::chrono::duration<double> kFirst{1.0};
constexpr std::chrono::duration<double> kNext{0.1};

// Below this share, the time that is left would be a guess.
constexpr double kLeastShare = 0.02;

/// "12 s left", or nothing.
std::string timeLeft(double seconds, double share) {
  if (share < kLeastShare) return {};
  const double left = std::ceil(seconds * (1 - share) / share);
  constexpr double kMinute = 60;
  constexpr double kHour = 60 * kMinute;
  if (left < 2 * kMinute) return fmt::format("{:.0f} s left", left);
  if (left < 2 * kHour) return fmt::format("{:.0f} min left", left / kMinute);
  return fmt::format("{:.0f} h left", left / kHour);
}

}  // namespace

ProgressDisplay::ProgressDisplay(bool quiet, bool verbose) {
  if (quiet) return;
  if (verbose) {
    style_ = Style::Lines;
  } else if (::isatty(STDERR_FILENO) == 1) {
    style_ = Style::Bar;
  }
}

ProgressDisplay::~ProgressDisplay() { clear(); }

Context::Progress ProgressDisplay::callback() {
  if (style_ == Style::Nothing) return {};
  return [this](std::string_view stage, double share) { show(stage, share); };
}

void ProgressDisplay::clear() {
  if (barIsVisible_) printToStderr("\r\033[K");
  barIsVisible_ = false;
}

void ProgressDisplay::show(std::string_view stage, double share) {
  if (style_ == Style::Bar) return showBar(stage, share);
  if (std::find(printed_.begin(), printed_.end(), stage) != printed_.end()) return;
  printToStderr("hexhex: {}\n", stage);
  printed_.emplace_back(stage);
}

void ProgressDisplay::showBar(std::string_view stage, double share) {
  const Clock::time_point now = Clock::now();
  const std::chrono::duration<double> elapsed = now - begin_;
  if (elapsed < kFirst || (barIsVisible_ && now - drawn_ < kNext)) return;
  drawn_ = now;
  barIsVisible_ = true;
  const auto done = static_cast<std::size_t>(share * kBarWidth);
  printToStderr("\r\033[K[{}{}] {:3.0f} %  {:>11}  {}", std::string(done, '#'),
                std::string(kBarWidth - done, ' '), std::floor(share * 100),
                timeLeft(elapsed.count(), share), stage.substr(0, stage.find(':')));
  std::fflush(stderr);
}

}  // namespace hexhex::command
