// What long work gets from its caller: number of threads, progress, cancellation; and what it
// gives back: how long each stage took.
#pragma once

#include <atomic>
#include <functional>
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

/// Passed by reference into long functions. One context serves one call at a time.
class Context {
 public:
  /// Called with the stage's name and the finished share of the stage in [0, 1]; at most a hundred
  /// times a stage, from one thread at a time. An exception thrown here ends the work.
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

  /// Reports progress of the running stage. Thread-safe.
  void report(std::string_view stage, double share);

  /// The stages that have run through this context so far, in order.
  [[nodiscard]] const std::vector<StageTime>& stageTimes() const noexcept { return stageTimes_; }
  void addStageTime(std::string_view stage, double seconds);

 private:
  int threads_ = 0;
  Progress progress_;
  std::atomic<bool> cancelled_{false};
  std::atomic<bool> reporting_{false};
  std::vector<StageTime> stageTimes_;
};

}  // namespace HEXHEX_API_NAMESPACE
