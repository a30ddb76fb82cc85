#include <algorithm>
#include <new>
#include <utility>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>

namespace hexhex {

void Context::throwIfCancelled() const {
  if (cancelled()) throw Error(ErrorCode::Cancelled, "Cancelled on request.");
}

void Context::report(std::string_view stage, double share) {
  if (!progress_) return;
  // Whoever comes while another thread reports is late by definition: drop the report.
  if (reporting_.exchange(true, std::memory_order_acquire)) return;
  struct Release {
    std::atomic<bool>& flag;
    ~Release() { flag.store(false, std::memory_order_release); }
  } const release{reporting_};
  progress_(stage, std::clamp(share, 0.0, 1.0));
}

void Context::addStageTime(std::string_view stage, double seconds) {
  for (StageTime& time : stageTimes_) {
    if (time.stage == stage) {
      time.seconds += seconds;
      return;
    }
  }
  try {
    stageTimes_.push_back({std::string(stage), seconds});
  } catch (const std::bad_alloc&) {
    // Stages end while exceptions pass, also those about memory; nobody will miss this time then.
  }
}

}  // namespace hexhex
