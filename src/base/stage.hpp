// A stage of the pipeline as the caller sees it: a name, progress, cancellation, and its time.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string_view>

#include <hexhex/context.hpp>

namespace hexhex {

/// Measures the time between construction and destruction and adds it to the context.
class Stage {
 public:
  Stage(Context& context, std::string_view name)
      : context_(context), name_(name), begin_(std::chrono::steady_clock::now()) {
    context_.throwIfCancelled();
    context_.report(name_, 0.0);
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

  [[nodiscard]] Context& context() const noexcept { return context_; }
  [[nodiscard]] std::string_view name() const noexcept { return name_; }

 private:
  Context& context_;
  std::string_view name_;
  std::chrono::steady_clock::time_point begin_;
  bool finished_ = false;
};

/// Progress of a loop over `total` elements, reported at most a hundred times; also the place where
/// cancellation takes effect.
class LoopProgress {
 public:
  LoopProgress(Stage& stage, std::size_t total) : stage_(stage), total_(total) {}

  /// `count` more elements are done. Thread-safe.
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
  std::size_t total_;
  std::atomic<std::size_t> done_{0};
};

}  // namespace hexhex
