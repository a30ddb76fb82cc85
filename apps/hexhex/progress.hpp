// Progress on the standard error output: one bar for a whole run on a terminal, or a line per
// stage.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include <hexhex/context.hpp>

namespace hexhex::command {

class ProgressDisplay {
 public:
  /// A bar if the standard error output is a terminal, from the second second on; elsewhere
  /// nothing.
  /// @param quiet    nothing at all
  /// @param verbose  a line per stage instead, everywhere
  explicit ProgressDisplay(bool quiet, bool verbose = false);
  /// Removes the bar.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// What a context calls. Refers to this display.
  [[nodiscard]] Context::Progress callback();

  /// Removes the bar, so that something else can be printed.
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
  std::vector<std::string> printed_;  ///< stages that had their line
};

}  // namespace hexhex::command
