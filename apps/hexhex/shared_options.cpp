#include "shared_options.hpp"

#include <charconv>

#include <fmt/core.h>

namespace hexhex::command {

CLI::Validator wholeNumberFrom(int minimum) {
  const auto check = [minimum](const std::string& text) -> std::string {
    int value = 0;
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec == std::errc{} && result.ptr == end && value >= minimum) return {};
    return fmt::format("expected a whole number from {}, found \"{}\"", minimum, text);
  };
  return CLI::Validator(check, fmt::format("from {}", minimum));
}

std::string mapDescription() { return "The map, .hexex, .ovm or .ovmb"; }

void addScale(CLI::App& parser, int& scale, const std::string& description) {
  parser.add_option("--scale", scale, description)
      ->check(wholeNumberFrom(1))
      ->option_text("INTEGER [1]");
}

void addThreads(CLI::App& parser, int& threads) {
  parser.add_option("--threads", threads, "Number of threads; 0 = all cores")
      ->check(wholeNumberFrom(0))
      ->option_text("INTEGER [0]");
}

void addTolerance(CLI::App& parser, double& tolerance) {
  parser
      .add_option("--tolerance", tolerance,
                  "How far the map may be from fulfilling its\n"
                  "integer conditions, in parameter units; below 0.25")
      ->option_text("NUMBER [0.01]");
}

void addRound(CLI::App& parser, bool& round) {
  parser.add_flag("--round", round,
                  "Move boundary and singularities that are off integers by\n"
                  "less than 0.1 onto them, and repair what that flips");
}

}  // namespace hexhex::command
