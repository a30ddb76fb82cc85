#include <algorithm>
#include <new>
#include <utility>

#include <hexhex/context.hpp>
#include <hexhex/error.hpp>

namespace hexhex {

void Context::throwIfCancelled() const {
  if (cancelled()) throw Error(ErrorCode::Cancelled, "Cancelled on request.");
}

void Context::begin(std::string_view step) {
  if (steps_ != nullptr) {
    steps_->begin(step);
  } else {
    step_ = {};
    reported_ = 0;
  }
  stage_ = step;
  report(step, 0);
}

void Context::report(std::string_view stage, double share) {
  if (!progress_) return;
  // Another thread is reporting: drop this report, which would be late anyway.
  if (reporting_.exchange(true, std::memory_order_acquire)) return;
  struct Release {
    std::atomic<bool>& flag;
    ~Release() { flag.store(false, std::memory_order_release); }
  } const release{reporting_};
  const double whole = step_.begin + std::clamp(share, 0.0, 1.0) * (step_.end - step_.begin);
  reported_ = std::max(reported_, whole);
  progress_(stage, reported_);
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
    // Stages also end during unwinding, after std::bad_alloc too; nobody will miss this time then.
  }
}

WorkSteps::WorkSteps(Context& context, std::string_view name, std::span<const WorkStep> steps)
    : context_(context), outer_(context.steps_), steps_(steps) {
  if (outer_ != nullptr) {
    outer_->begin(name);
    range_ = context.step_;
  } else {
    context.reported_ = 0;
  }
  for (const WorkStep& step : steps_) total_ += step.weight;
  context.step_ = {range_.begin, range_.begin};
  context.steps_ = this;
}

WorkSteps::~WorkSteps() {
  context_.steps_ = outer_;
  if (outer_ != nullptr) return;
  context_.step_ = {};
  context_.reported_ = 0;
}

void WorkSteps::begin(std::string_view step) {
  const auto hasName = [step](const WorkStep& other) { return other.name == step; };
  const auto rest = steps_.subspan(next_);
  const auto found = std::find_if(rest.begin(), rest.end(), hasName);
  if (found == rest.end()) {
    // Either the last step once more, which keeps its range, or one of unknown length.
    const bool isRepeated = next_ > 0 && hasName(steps_[next_ - 1]);
    if (!isRepeated) context_.step_.begin = context_.step_.end;
    return;
  }
  double skipped = 0;
  for (auto other = rest.begin(); other != found; ++other) skipped += other->weight;
  // Progress starts at 0, whichever step comes first.
  if (next_ == 0) {
    total_ -= skipped;
  } else {
    before_ += skipped;
  }
  const auto at = [this](double weight) {
    return range_.begin + (range_.end - range_.begin) * weight / total_;
  };
  context_.step_ = {at(before_), at(before_ + found->weight)};
  before_ += found->weight;
  next_ += static_cast<std::size_t>(found - rest.begin()) + 1;
}

void WorkSteps::finish() {
  context_.step_ = {range_.end, range_.end};
  if (outer_ == nullptr) context_.report(context_.stage_, 1);
}

}  // namespace hexhex
