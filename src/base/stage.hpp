// A stage of the pipeline as the caller sees it: a name, progress, cancellation, and its time.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>

#include <hexhex/context.hpp>

namespace hexhex {

/// Measures the time between construction and destruction and adds it to the context.
class Stage {
 public:
  Stage(Context& context, std::string_view name)
      : context_(context), name_(name), begin_(std::chrono::steady_clock::now()) {
    context_.throwIfCancelled();
    context_.begin(name_);
  }
  /// Work that other threads do beside this one, all within another stage: without progress and
  /// time of its own.
  static constexpr struct Inner {
  } kInner{};
  Stage(Context& context, Inner /*tag*/) : context_(context), isInner_(true), finished_(true) {
    context_.throwIfCancelled();
  }
  ~Stage() { finish(); }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Ends the stage before its scope does.
  void finish() {
    if (finished_) return;
    finished_ = true;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin_;
    context_.addStageTime(name_, seconds.count());
  }

  /// Approximate number of elements that all loops of this stage process together; progress then
  /// refers to the stage. Otherwise only the first loop's progress is visible.
  void setTotal(std::size_t total) { total_ = total; }

  [[nodiscard]] Context& context() const noexcept { return context_; }
  [[nodiscard]] std::string_view name() const noexcept { return name_; }

 private:
  friend class LoopProgress;
  Context& context_;
  std::string_view name_;
  std::chrono::steady_clock::time_point begin_;
  bool isInner_ = false;
  bool finished_ = false;
  std::size_t total_ = 0;  ///< 0: each loop has its own total
  std::atomic<std::size_t> done_{0};
};

/// Runs the work of a public function and reports its progress from 0 to 1.
/// @param name   of the function
/// @param steps  its stages, and other public functions that it calls; weights are their seconds on
///               a map of the evaluation with millions of cells
template <class Work>
std::invoke_result_t<Work> inSteps(Context& context, std::string_view name,
                                   std::span<const WorkStep> steps, const Work& work) {
  WorkSteps all(context, name, steps);
  if constexpr (std::is_void_v<std::invoke_result_t<Work>>) {
    work();
    all.finish();
  } else {
    auto result = work();
    all.finish();
    return result;
  }
}

/// The same for a function with one stage: work(stage).
template <class Work>
std::invoke_result_t<Work, Stage&> inStage(Context& context, std::string_view name,
                                           std::string_view stageName, const Work& work) {
  const WorkStep only{stageName, 1};
  return inSteps(context, name, {&only, 1}, [&] {
    Stage stage(context, stageName);
    return work(stage);
  });
}

/// Progress of a loop over `total` elements, reported at most a hundred times. Cancellation takes
/// effect here, too.
class LoopProgress {
 public:
  LoopProgress(Stage& stage, std::size_t total)
      : stage_(stage),
        total_(stage.isInner_ ? 0 : (stage.total_ != 0 ? stage.total_ : total)),
        done_(stage.total_ != 0 ? stage.done_ : own_) {}

  /// Counts `count` more elements as done. Thread-safe.
  void advance(std::size_t count) {
    stage_.context().throwIfCancelled();
    const std::size_t before = done_.fetch_add(count, std::memory_order_relaxed);
    const std::size_t after = before + count;
    if (total_ == 0 || before * 100 / total_ == after * 100 / total_) return;
    stage_.context().report(stage_.name(),
                            static_cast<double>(after) / static_cast<double>(total_));
  }

 private:
  Stage& stage_;
  std::size_t total_;  ///< 0: nothing to report
  std::atomic<std::size_t> own_{0};
  std::atomic<std::size_t>& done_;
};

}  // namespace hexhex
