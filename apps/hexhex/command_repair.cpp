// `hexhex repair`: turns a defective map into a valid one.
#include <memory>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <hexhex/error.hpp>
#include <hexhex/io.hpp>
#include <hexhex/repair.hpp>

#include "command.hpp"
#include "long_run.hpp"
#include "map_text.hpp"
#include "output.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

struct RepairArguments {
  MapSource input;
  std::string output;
  OutputChoice choice;
  std::string report;
  RepairOptions options;
  RunOptions run;
  bool noRefine = false;
};

int run(const RepairArguments& arguments) {
  const WriteOptions writing = arguments.choice.options();
  requireMapFormat(arguments.output, writing);
  requireAllDifferent(arguments.input.files(), {arguments.output, arguments.report});
  LongRun longRun(arguments.run,
                  {{"readMap", 1}, {"readMapPair", 1}, {"repair", 20}, {"writeMap", 0.5}});
  Context& context = longRun.context();
  requireWritable(arguments.output);
  Report reportFile(arguments.report);
  RepairOptions options = arguments.options;
  options.refine = !arguments.noRefine;
  RepairReport report;
  const TetMap map = repair(readMap(arguments.input, context), options, context, &report);
  writeMap(map, arguments.output, writing, context);
  longRun.finish();
  if (reportFile.isWanted()) reportFile.write(repairAsJson(report).dump(2) + "\n");
  if (arguments.run.quiet || reportFile.isOnOutput()) return kSuccess;
  printFiles(arguments.input.description(), arguments.output);
  if (!report.changed) {
    fmt::print("The map is valid; it was written as it is.\n");
    return kSuccess;
  }
  fmt::print("{}\n", repairNotice(report));
  printRegions(report);
  printLine("time", fmt::format("{:.3f} s", report.seconds));
  return kSuccess;
}

}  // namespace

Command addRepair(CLI::App& app) {
  const auto arguments = std::make_shared<RepairArguments>();
  CLI::App* const parser =
      app.add_subcommand("repair", "Repair flipped and flat tets of a map by moving parameters");
  addMapSource(*parser, arguments->input);
  addMapOutput(*parser, arguments->output);
  addOutputChoice(*parser, arguments->choice);
  addTolerance(*parser, arguments->options.tolerance);
  addScale(*parser, arguments->options.scale,
           "The largest scale at which the map will be extracted");
  addRound(*parser, arguments->options.round);
  parser->add_flag("--no-refine", arguments->noRefine,
                   "Never split edges of the tet mesh, even where moving\n"
                   "parameters is not enough");
  addReport(*parser, arguments->report, "Write in JSON what was moved, where, and by how much");
  addRunOptions(*parser, arguments->run);
  parser->footer(
      "A valid map is written as it is. Exit code 1: the map cannot be repaired; the message says\n"
      "why, and nothing is written. docs/user/defects.md explains what can be repaired and how.\n\n"
      "Example:\n"
      "  hexhex generate sphere --defects 10 --defect-kind singular -o broken.hexex\n"
      "  hexhex repair broken.hexex -o repaired.hexex");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
