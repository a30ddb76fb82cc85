// `hexhex quantize`: turns a seamless map into an integer-grid map.
#include <memory>
#include <string>

#include <fmt/core.h>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/quantize.hpp>

#include "command.hpp"
#include "expected_words.hpp"
#include "json.hpp"
#include "long_run.hpp"
#include "output.hpp"
#include "quantize_options.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

struct QuantizeArguments {
  MapSource input;
  std::string output;
  OutputChoice choice;
  std::string report;
  QuantizeOptions options;
  RunOptions run;
};

void printQuantized(const QuantizeReport& report) {
  printLine("quantization", quantizeSummary(report));
  printLine("motorcycle complex", counted(report.blocks, "block"));
  const bool isRounded = report.integersBy == "rounding";
  printLine(
      "integers",
      "by " + report.integersBy +
          (isRounded ? "; the library HiGHS finds better ones (docs/user/quantize.md, 'HiGHS')"
                     : ""));
  printLine("moved to be seamless", fmt::format("at most {:.3g}", report.displacement));
  printLine("scaled Jacobian",
            fmt::format("{:.3f} (worst) and {:.3f} (median) of the map; {:.3f} and {:.3f} before",
                        report.distortionAfter.worst, report.distortionAfter.median,
                        report.distortionBefore.worst, report.distortionBefore.median));
}

int run(const QuantizeArguments& arguments) {
  const WriteOptions writing = arguments.choice.options();
  requireMapFormat(arguments.output, writing);
  requireAllDifferent(arguments.input.files(), {arguments.output, arguments.report});
  LongRun longRun(arguments.run,
                  {{"readMap", 1}, {"readMapPair", 1}, {"quantize", 20}, {"writeMap", 0.5}});
  Context& context = longRun.context();
  requireWritable(arguments.output);
  Report reportFile(arguments.report);
  const TetMap map = readMap(arguments.input, context);
  const QuantizedMap result = quantize(map, arguments.options, context);
  writeMap(result.map, arguments.output, writing, context);
  longRun.finish();
  if (reportFile.isWanted()) {
    Json json = quantizeAsJson(result.report);
    json["seconds"] = secondsAsJson(context.stageTimes());
    reportFile.write(jsonText(json));
  }
  if (arguments.run.quiet || reportFile.isOnOutput()) return kSuccess;
  printFiles(arguments.input.description(), arguments.output);
  printQuantized(result.report);
  return kSuccess;
}

}  // namespace

Command addQuantize(CLI::App& app) {
  const auto arguments = std::make_shared<QuantizeArguments>();
  CLI::App* const parser =
      app.add_subcommand("quantize", "Turn a seamless map into an integer-grid map");
  addMapSource(*parser, arguments->input);
  addKeepWalls(*parser, arguments->input);
  addMapOutput(*parser, arguments->output);
  addOutputChoice(*parser, arguments->choice);
  addQuantizeOptions(*parser, arguments->options, "--scale");
  addValue(*parser, "--tolerance", arguments->options.tolerance, "NUMBER [1e-5]",
           "How far the map may be from a seamless one, as a share of\nits size")
      ->check(CLI::Range(0.0, 0.01));
  addReport(*parser, arguments->report, "Write in JSON what was made, and how long each step took");
  addRunOptions(*parser, arguments->run);
  parser->footer(
      "One of --cells, --scale and --edge-length sets the resolution of the mesh. Exit code 1: "
      "the\n"
      "map is not seamless, or cannot be bent onto so few cells (--densify); nothing is written.\n"
      "docs/user/quantize.md explains what happens.\n\n"
      "Example:\n"
      "  hexhex quantize seamless.hexex -o integer.hexex --cells 50000\n"
      "  hexhex extract integer.hexex -o mesh.vtu\n"
      "  hexhex extract seamless.hexex -o mesh.vtu --quantize --cells 50000     in one go");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
