// Execution context for long-running functions: number of threads, progress, cancellation, and the
// time that each stage took.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hexhex/export.h>

namespace hexhex HEXHEX_API_NAMESPACE {

/// Wall-clock time of one stage.
struct StageTime {
  std::string stage;
  double seconds = 0;
};

/// A step of a larger task, with its approximate duration relative to the other steps.
struct WorkStep {
  std::string_view name;
  double weight = 1;
};

class WorkSteps;

/// Passed by reference to long-running functions. A context serves one call at a time.
class Context {
 public:
  /// Called with the name of the current stage and the completed fraction of the whole call, which
  /// grows monotonically from 0 to 1; at most a hundred times per loop, from one thread at a time.
  /// An exception thrown here ends the work.
  using Progress = std::function<void(std::string_view stage, double share)>;

  Context() = default;
  /// @param threads  number of threads, 0 = all cores of this machine; more than 64 are only used
  ///                 on machines with more cores
  explicit Context(int threads, Progress progress = {})
      : threads_(threads), progress_(std::move(progress)) {}

  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  [[nodiscard]] int threads() const noexcept { return threads_; }

  /// Requests that running work end soon with ErrorCode::Cancelled. Safe to call from any thread
  /// and from a signal handler.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool cancelled() const noexcept {
    return cancelled_.load(std::memory_order_relaxed);
  }
  /// Throws ErrorCode::Cancelled if cancel() was called.
  void throwIfCancelled() const;

  /// Begins the step of this name. Outside any WorkSteps, the step is a task of its own.
  void begin(std::string_view step);
  /// Reports the completed fraction of the current step. Thread-safe.
  void report(std::string_view stage, double share);

  /// The stages completed in this context so far, in order.
  [[nodiscard]] const std::vector<StageTime>& stageTimes() const noexcept { return stageTimes_; }
  void addStageTime(std::string_view stage, double seconds);

 private:
  friend class WorkSteps;
  /// A section of the whole task, within 0 to 1.
  struct Range {
    double begin = 0;
    double end = 1;
  };

  int threads_ = 0;
  Progress progress_;
  std::atomic<bool> cancelled_{false};
  std::atomic<bool> reporting_{false};
  WorkSteps* steps_ = nullptr;  ///< the innermost one
  Range step_;                  ///< range of the current step
  double reported_ = 0;
  std::string stage_;  ///< the current stage
  std::vector<StageTime> stageTimes_;
};

/// A task in several steps whose progress is reported as one. Every function of the library is such
/// a task under its own name, and its steps are its stages. To report a sequence of calls as one,
/// make it a task whose steps are named after the functions:
///
///     const std::array<WorkStep, 2> names = {{{"readMap", 1}, {"extract", 9}}};
///     WorkSteps steps(context, "all", names);
///     const TetMap map = readMap("sphere.hexex", context);       // reports from 0 to 0.1
///     const HexMesh mesh = extract(map, {}, context);            // ... to 1
///     steps.finish();
///
/// Steps that do not occur are skipped; steps that are not listed do not advance the progress.
class WorkSteps {
 public:
  /// @param name   name of the task, by which an enclosing task refers to it
  /// @param steps  in order of execution; must outlive this object
  WorkSteps(Context& context, std::string_view name, std::span<const WorkStep> steps);
  ~WorkSteps();
  WorkSteps(const WorkSteps&) = delete;
  WorkSteps& operator=(const WorkSteps&) = delete;

  /// Marks the task as complete: reports 1, unless it is a step of an enclosing task.
  void finish();

 private:
  friend class Context;
  void begin(std::string_view step);

  Context& context_;
  WorkSteps* outer_;
  std::span<const WorkStep> steps_;
  Context::Range range_;
  double total_ = 0;      ///< sum of all weights
  double before_ = 0;     ///< sum of the weights of steps_[0, next_)
  std::size_t next_ = 0;  ///< index after that of the current step
};

}  // namespace HEXHEX_API_NAMESPACE
