#include "long_run.hpp"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "shared_options.hpp"

namespace hexhex::command {

void addRunOptions(CLI::App& parser, RunOptions& options, const std::string& quiet) {
  parser.add_option("--threads", options.threads, "Number of threads; 0 = all cores")
      ->check(wholeNumberFrom(0))
      ->option_text("INTEGER [0]");
  parser.add_flag("--verbose", options.verbose, "Print a line per stage instead of a bar");
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
