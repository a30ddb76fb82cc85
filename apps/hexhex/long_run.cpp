#include "long_run.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <unistd.h>
#include <utility>

#include <fmt/core.h>

#include "expected_words.hpp"
#include "output.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

std::atomic<Context*> contextToCancel{nullptr};
static_assert(std::atomic<Context*>::is_always_lock_free, "signal handlers may not lock");

std::atomic<int> signalThatCame{0};

extern "C" void cancelContext(int signal) {
  signalThatCame = signal;
  if (Context* const context = contextToCancel.load()) context->cancel();
  std::signal(signal, SIG_DFL);
}

}  // namespace

std::string_view sentenceOf(const Error& error) noexcept {
  const int signal = signalThatCame;
  if (error.code() != ErrorCode::Cancelled || signal == 0) return error.what();
  if (signal == SIGINT) return "Interrupted.";
  return signal == SIGTERM ? "Terminated." : "The terminal was closed.";
}

CancelOnSignal::CancelOnSignal(Context& context) {
  contextToCancel = &context;
  std::signal(SIGINT, cancelContext);
  std::signal(SIGTERM, cancelContext);
#ifdef SIGHUP
  std::signal(SIGHUP, cancelContext);
#endif
}

CancelOnSignal::~CancelOnSignal() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
#ifdef SIGHUP
  std::signal(SIGHUP, SIG_DFL);
#endif
  contextToCancel = nullptr;
}

namespace {

constexpr int kBarWidth = 30;  // fits in 80 columns with the longest stage name

// No bar for runs of less than a second; ten updates a second look smooth.
constexpr std::chrono::duration<double> kFirst{1.0};
constexpr std::chrono::duration<double> kNext{0.1};

// Below this share, an estimate of the time left would be a guess.
constexpr double kLeastShare = 0.02;

/// "12 s left", or empty.
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

void addRunOptions(CLI::App& parser, RunOptions& options, const std::string& quiet) {
  addValue(parser, "--threads", options.threads, "INTEGER [0]", "Number of threads; 0 = all cores")
      ->check(wholeNumberFrom(0));
  parser.add_flag("--verbose", options.verbose, "Print a line per stage instead of a progress bar");
  parser.add_flag("--quiet", options.quiet, quiet);
}

LongRun::LongRun(const RunOptions& options, std::vector<WorkStep> steps)
    : progress_(options.quiet, options.verbose),
      context_(options.threads, progress_.callback()),
      names_(std::move(steps)),
      steps_(context_, "hexhex", names_) {
  parts_.reserve(names_.size());
}

LongRun::Watch::Watch(LongRun& run, std::string_view name) : run_(run) {
  const auto isThis = [&](const StageTime& part) { return part.stage == name; };
  const auto part = std::find_if(run.parts_.begin(), run.parts_.end(), isThis);
  part_ = static_cast<std::size_t>(part - run.parts_.begin());
  if (part == run.parts_.end()) run.parts_.push_back({std::string(name), 0});
}

LongRun::Watch::~Watch() {
  const std::chrono::duration<double> seconds = Clock::now() - begin_;
  run_.parts_[part_].seconds += seconds.count();
}

std::string LongRun::partsAsText() const {
  double total = 0;
  std::string list;
  for (const StageTime& part : parts_) {
    total += part.seconds;
    list += fmt::format("{} {} {:.2f}", list.empty() ? ":" : ",", part.stage, part.seconds);
  }
  return fmt::format("{:.2f} s{}", total, list);
}

}  // namespace hexhex::command
