// `hexhex check`: diagnoses a map.
#include <memory>
#include <optional>
#include <string>

#include <fmt/core.h>

#include <hexhex/check.hpp>
#include <hexhex/quantize.hpp>

#include "command.hpp"
#include "json.hpp"
#include "long_run.hpp"
#include "map_text.hpp"
#include "output.hpp"
#include "quantize_options.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

struct CheckArguments {
  MapSource input;
  CheckOptions options;
  RunOptions run;
  bool json = false;
};

/// Diagnosis of a map, including seamlessness if it is not an integer-grid map.
struct Examination {
  CheckReport report;
  std::optional<SeamlessReport> seamless;
};

Examination examine(const CheckArguments& arguments) {
  LongRun longRun(arguments.run,
                  {{"readMap", 1}, {"readMapPair", 1}, {"check", 4}, {"examineSeamless", 8}});
  Context& context = longRun.context();
  const TetMap map = readMap(arguments.input, context);
  Examination result{check(map, arguments.options, context), std::nullopt};
  if (!result.report.valid() && canQuantize() &&
      mayBeSeamless(result.report.defects.front().code)) {
    result.seamless = examineSeamless(map, context);
  }
  return result;
}

/// The kind of map in a sentence, and what to do with it.
std::string classify(const Examination& found, const MapSource& input) {
  if (found.report.valid()) return "The map is valid.";
  std::string advice = found.seamless ? adviceFor(*found.seamless, quantizationOf(input)) : "";
  if (!advice.empty()) return advice;
  std::string text =
      fmt::format("The map is defective: {} of {}.", counted(found.report.defects.size(), "kind"),
                  found.report.defects.size() == 1 ? "defect" : "defects");
  if (found.seamless) text += "\nNor can it be quantized: " + found.seamless->problem;
  return text;
}

int run(const CheckArguments& arguments) {
  const Examination found = examine(arguments);
  const CheckReport& report = found.report;
  if (arguments.json) {
    fmt::print("{}", jsonText(checkAsJson(report, arguments.options.scale, found.seamless)));
  } else if (!arguments.run.quiet) {
    fmt::print("{}\n", classify(found, arguments.input));
    printMap(report);
    if (report.valid()) {
      fmt::print("Mesh to expect at scale {}\n", arguments.options.scale);
      printExpectation(report.expected);
    } else if (!found.seamless || found.seamless->kind == SeamlessKind::Neither) {
      printDefects(report);
    }
  }
  return report.valid() ? kSuccess : kInvalidMap;
}

}  // namespace

Command addCheck(CLI::App& app) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* const parser =
      app.add_subcommand("check", "Say what kind of map it is, and which conditions it violates");
  addMapSource(*parser, arguments->input);
  addTolerance(*parser, arguments->options.tolerance);
  addScale(*parser, arguments->options.scale, "Print what to expect at this scale");
  addJson(*parser, arguments->json);
  addRunOptions(*parser, arguments->run, "Print no text: the exit code is the answer");
  parser->footer(
      "Exit code 0: the map is valid; 1: it is not.\n\nExample:\n"
      "  hexhex check sphere.hexex");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
