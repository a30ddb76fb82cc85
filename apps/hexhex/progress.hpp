// Progress on the standard error output: a bar on a terminal, a line per stage elsewhere.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <hexhex/context.hpp>

namespace hexhex::command {

class ProgressDisplay {
 public:
  /// @param quiet  show nothing
  explicit ProgressDisplay(bool quiet);
  /// Removes the bar.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// What a context calls. Refers to this display.
  [[nodiscard]] Context::Progress callback();

  /// Removes the bar, so that something else can be printed.
  void clear();

 private:
  void show(std::string_view stage, double share);

  bool quiet_;
  bool onTerminal_;
  bool barIsVisible_ = false;
  std::vector<std::string> printed_;  ///< stages that had their line
};

}  // namespace hexhex::command
