// What subcommands with long work have in common: threads, progress, Ctrl-C, and how long each part
// took.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>

namespace hexhex::command {

/// While it lives, SIGINT, SIGTERM and SIGHUP cancel the context. A second signal ends the process
/// at once.
class CancelOnSignal {
 public:
  explicit CancelOnSignal(Context& context);
  ~CancelOnSignal();
  CancelOnSignal(const CancelOnSignal&) = delete;
  CancelOnSignal& operator=(const CancelOnSignal&) = delete;
};

/// What to tell of an error: where a signal cancelled the run, what that means ("Terminated.").
[[nodiscard]] std::string_view sentenceOf(const Error& error) noexcept;

/// Progress on the standard error output: one bar for a whole run on a terminal, or a line per
/// stage.
class ProgressDisplay {
 public:
  /// A bar if the standard error output is a terminal, from the second second on; elsewhere
  /// nothing.
  /// @param quiet    nothing at all
  /// @param verbose  a line per stage instead, everywhere
  explicit ProgressDisplay(bool quiet, bool verbose = false);
  /// Removes the bar.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// What a context calls. Refers to this display.
  [[nodiscard]] Context::Progress callback();

  /// Removes the bar, so that something else can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  enum class Style { Nothing, Bar, Lines };

  void show(std::string_view stage, double share);
  void showBar(std::string_view stage, double share);

  Style style_ = Style::Nothing;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point drawn_;
  bool barIsVisible_ = false;
  std::vector<std::string> printed_;  ///< stages that had their line
};

struct RunOptions {
  int threads = 0;
  bool quiet = false;
  bool verbose = false;
};

/// Adds --threads, --verbose and --quiet.
void addRunOptions(CLI::App& parser, RunOptions& options,
                   const std::string& quiet = "Print nothing but errors");

class LongRun {
 public:
  /// @param steps  the functions of the library that are going to be called, and how long they take
  LongRun(const RunOptions& options, std::vector<WorkStep> steps);

  [[nodiscard]] Context& context() noexcept { return context_; }

  /// Runs work(), whose time is that of the part.
  template <class Work>
  std::invoke_result_t<Work> part(std::string_view name, const Work& work) {
    const Watch watch(*this, name);
    return work();
  }

  /// The work is over; results may be printed.
  void finish() { progress_.clear(); }

  /// In order.
  [[nodiscard]] const std::vector<StageTime>& parts() const noexcept { return parts_; }
  /// "7.72 s: reading 0.01, extraction 3.85, writing 0.80"
  [[nodiscard]] std::string partsAsText() const;

 private:
  using Clock = std::chrono::steady_clock;

  /// Adds the time that it lives to a part.
  class Watch {
   public:
    /// Whatever takes memory is done here: destructors must not fail.
    Watch(LongRun& run, std::string_view name);
    ~Watch();
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

   private:
    LongRun& run_;
    std::size_t part_ = 0;
    Clock::time_point begin_ = Clock::now();
  };

  ProgressDisplay progress_;
  Context context_;
  CancelOnSignal cancelOnSignal_{context_};
  std::vector<WorkStep> names_;
  WorkSteps steps_;
  std::vector<StageTime> parts_;
};

}  // namespace hexhex::command
