// Shared by subcommands that run long: threads, progress, signals, and timing of the steps.
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

/// For its lifetime, SIGINT, SIGTERM and SIGHUP cancel the context. A second signal ends the
/// process at once.
class CancelOnSignal {
 public:
  explicit CancelOnSignal(Context& context);
  ~CancelOnSignal();
  CancelOnSignal(const CancelOnSignal&) = delete;
  CancelOnSignal& operator=(const CancelOnSignal&) = delete;
};

/// The message of an error; if a signal cancelled the run, that signal's ("Terminated.").
[[nodiscard]] std::string_view sentenceOf(const Error& error) noexcept;

/// Progress on standard error: a bar for the whole run, or a line per stage.
class ProgressDisplay {
 public:
  /// Shows a bar after one second if standard error is a terminal; otherwise nothing.
  /// @param quiet    print nothing at all
  /// @param verbose  print a line per stage instead, on any output
  explicit ProgressDisplay(bool quiet, bool verbose = false);
  /// Removes the bar.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// The callback for a context. Refers to this display.
  [[nodiscard]] Context::Progress callback();

  /// Removes the bar, so that other output can be printed.
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
  std::vector<std::string> printed_;  ///< stages already printed
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
  /// @param steps  the library functions that will be called, with weights by duration
  LongRun(const RunOptions& options, std::vector<WorkStep> steps);

  [[nodiscard]] Context& context() noexcept { return context_; }

  /// Runs work() and measures its time as that of the part.
  template <class Work>
  std::invoke_result_t<Work> part(std::string_view name, const Work& work) {
    const Watch watch(*this, name);
    return work();
  }

  /// To be called before results are printed.
  void finish() { progress_.clear(); }

  /// In the order of the run.
  [[nodiscard]] const std::vector<StageTime>& parts() const noexcept { return parts_; }
  /// "7.72 s: reading 0.01, extraction 3.85, writing 0.80"
  [[nodiscard]] std::string partsAsText() const;

 private:
  using Clock = std::chrono::steady_clock;

  /// Adds its lifetime to the time of a part.
  class Watch {
   public:
    /// Allocates all memory here, since the destructor must not fail.
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
