// `hexhex check`: what a map is and what is wrong with it.
#include <memory>

#include <fmt/core.h>

#include <hexhex/check.hpp>

#include "check_text.hpp"
#include "command.hpp"
#include "exit_codes.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
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

CheckReport examine(const Arguments& arguments) {
  ProgressDisplay progress(arguments.quiet || arguments.json);
  Context context(arguments.threads, progress.callback());
  const CancelOnSignal cancelOnSignal(context);
  const TetMap map = readMap(arguments.input, context);
  return check(map, arguments.options, context);
}

int run(const Arguments& arguments) {
  const CheckReport report = examine(arguments);
  if (arguments.json) {
    fmt::print("{}", checkAsJson(report, arguments.options.scale));
  } else if (!arguments.quiet) {
    printCheck(report, arguments.options.scale);
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
