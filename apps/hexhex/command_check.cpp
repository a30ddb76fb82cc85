// `hexhex check`: what a map is and what is wrong with it.
#include <memory>
#include <optional>
#include <string>

#include <fmt/core.h>

#include <hexhex/check.hpp>
#include <hexhex/quantize.hpp>

#include "check_text.hpp"
#include "command.hpp"
#include "exit_codes.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "quantize_options.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

struct Arguments {
  MapSource input;
  CheckOptions options;
  int threads = 0;
  bool json = false;
  bool quiet = false;
};

/// What a map is, and whether it is seamless if it is not integer.
struct Examination {
  CheckReport report;
  std::optional<SeamlessReport> seamless;
};

Examination examine(const Arguments& arguments) {
  ProgressDisplay progress(arguments.quiet || arguments.json);
  Context context(arguments.threads, progress.callback());
  const CancelOnSignal cancelOnSignal(context);
  const TetMap map = readMap(arguments.input, context);
  Examination result{check(map, arguments.options, context), std::nullopt};
  if (!result.report.valid() && canQuantize() &&
      mayBeSeamless(result.report.defects.front().code)) {
    result.seamless = examineSeamless(map, context);
  }
  return result;
}

int run(const Arguments& arguments) {
  const auto [report, seamless] = examine(arguments);
  if (arguments.json) {
    const char* kind = seamless ? kindName(seamless->kind) : "neither";
    fmt::print("{}",
               checkAsJson(report, arguments.options.scale, report.valid() ? "integer" : kind));
  } else if (!arguments.quiet) {
    printCheck(report, arguments.options.scale);
    const std::string advice = seamless ? adviceFor(*seamless, arguments.input) : "";
    if (!advice.empty()) fmt::print("{}\n", advice);
  }
  return report.valid() ? kSuccess : kInvalidMap;
}

}  // namespace

Command addCheck(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const parser =
      app.add_subcommand("check", "Tell what a map is, and every condition that it violates");
  addMapSource(*parser, arguments->input);
  addTolerance(*parser, arguments->options.tolerance);
  addScale(*parser, arguments->options.scale, "Tell what to expect at this scale");
  addThreads(*parser, arguments->threads);
  parser->add_flag("--json", arguments->json, "Print JSON instead of text");
  addQuiet(*parser, arguments->quiet, "Print no text: the exit code tells");
  parser->footer(
      "Exit code 0: the map is valid; 1: it is not.\n\nExample:\n"
      "  hexhex check sphere.hexex");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
