// What long work gets from its caller: number of threads, progress, cancellation; and what it
// gives back: how long each stage took.
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

/// A step of longer work, and how long it takes compared with the other steps, about.
struct WorkStep {
  std::string_view name;
  double weight = 1;
};

class WorkSteps;

/// Passed by reference into long functions. One context serves one call at a time.
class Context {
 public:
  /// Called with the name of the running stage and the finished share of the whole call, which
  /// grows from 0 to 1 and never falls; at most a hundred times a loop, from one thread at a time.
  /// An exception thrown here ends the work.
  using Progress = std::function<void(std::string_view stage, double share)>;

  Context() = default;
  /// @param threads  number of threads, 0 = all cores of this machine; more than 64 are used only
  /// on
  ///                 machines with more cores
  explicit Context(int threads, Progress progress = {})
      : threads_(threads), progress_(std::move(progress)) {}

  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  [[nodiscard]] int threads() const noexcept { return threads_; }

  /// Asks running work to end soon with ErrorCode::Cancelled. May be called from any thread and
  /// from a signal handler.
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool cancelled() const noexcept {
    return cancelled_.load(std::memory_order_relaxed);
  }
  /// Throws ErrorCode::Cancelled if cancel() was called.
  void throwIfCancelled() const;

  /// A step of this name begins. Outside of any WorkSteps, it is work of its own.
  void begin(std::string_view step);
  /// Reports the finished share of the step that has begun last. Thread-safe.
  void report(std::string_view stage, double share);

  /// The stages that have run through this context so far, in order.
  [[nodiscard]] const std::vector<StageTime>& stageTimes() const noexcept { return stageTimes_; }
  void addStageTime(std::string_view stage, double seconds);

 private:
  friend class WorkSteps;
  /// A part of the whole work, from 0 to 1.
  struct Range {
    double begin = 0;
    double end = 1;
  };

  int threads_ = 0;
  Progress progress_;
  std::atomic<bool> cancelled_{false};
  std::atomic<bool> reporting_{false};
  WorkSteps* steps_ = nullptr;  ///< the innermost ones
  Range step_;                  ///< what has begun last
  double reported_ = 0;
  std::string stage_;  ///< that has begun last
  std::vector<StageTime> stageTimes_;
};

/// Work in several steps, whose progress is reported as one. Every function of the library is one
/// of these under its own name, in steps that are its stages; so that a sequence of calls reports
/// as one if it is another, in steps that are names of functions:
///
///     const std::array<WorkStep, 2> names = {{{"readMap", 1}, {"extract", 9}}};
///     WorkSteps steps(context, "all", names);
///     const TetMap map = readMap("sphere.hexex", context);       // reports from 0 to 0.1
///     const HexMesh mesh = extract(map, {}, context);            // ... to 1
///     steps.finish();
///
/// A step that does not occur is skipped; one that is not in the list does not move the share.
class WorkSteps {
 public:
  /// @param name   of the work, by which an outer one knows it
  /// @param steps  in the order in which they occur; live as long as this
  WorkSteps(Context& context, std::string_view name, std::span<const WorkStep> steps);
  ~WorkSteps();
  WorkSteps(const WorkSteps&) = delete;
  WorkSteps& operator=(const WorkSteps&) = delete;

  /// All is done: reports 1, unless this is a step of other work.
  void finish();

 private:
  friend class Context;
  void begin(std::string_view step);

  Context& context_;
  WorkSteps* outer_;
  std::span<const WorkStep> steps_;
  Context::Range range_;
  double total_ = 0;      ///< of all weights
  double before_ = 0;     ///< the weights of steps_[0, next_)
  std::size_t next_ = 0;  ///< behind the step that has begun last
};

}  // namespace HEXHEX_API_NAMESPACE
