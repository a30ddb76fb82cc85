// `hexhex map`: computes a seamless map of a part, given as tets, a surface or a STEP file.
#include <memory>
#include <string>

#include <hexhex/fill.hpp>
#include <hexhex/io.hpp>
#include <hexhex/shape.hpp>

#include "command.hpp"
#include "expected_words.hpp"
#include "json.hpp"
#include "long_run.hpp"
#include "output.hpp"
#include "shape_options.hpp"
#include "shared_options.hpp"

namespace hexhex::command {
namespace {

struct MapArguments {
  std::string part;
  std::string output;
  OutputChoice choice;
  std::string report;
  ShapeOptions options;
  FillOptions fill;
  RunOptions run;
};

int run(const MapArguments& arguments) {
  const WriteOptions writing = arguments.choice.options();
  requireMapFormat(arguments.output, writing);
  requireAllDifferent({arguments.part}, {arguments.output, arguments.report});
  LongRun longRun(arguments.run, {{"readPart", 3}, {"mapFromTets", 20}, {"writeMap", 0.5}});
  Context& context = longRun.context();
  requireWritable(arguments.output);
  Report reportFile(arguments.report);
  FillOptions fill = arguments.fill;
  fill.featureAngle = arguments.options.featureAngle;
  const FilledPart part = readPart(arguments.part, fill, context);
  const ShapedMap result = mapFromTets(part.tets, arguments.options, context);
  writeMap(result.map, arguments.output, writing, context);
  longRun.finish();
  if (reportFile.isWanted()) {
    Json json = shapeAsJson(result.report);
    json["part"] = filledAsJson(arguments.part, part);
    json["seconds"] = secondsAsJson(context.stageTimes());
    reportFile.write(jsonText(json));
  }
  if (arguments.run.quiet || reportFile.isOnOutput()) return kSuccess;
  printFiles(arguments.part, arguments.output);
  printFill(part);
  printShape(result.report);
  return kSuccess;
}

}  // namespace

Command addMap(CLI::App& app) {
  const auto arguments = std::make_shared<MapArguments>();
  CLI::App* const parser = app.add_subcommand("map", "Make a seamless map of a part that has none");
  addPart(*parser, arguments->part, arguments->fill);
  addMapOutput(*parser, arguments->output);
  addOutputChoice(*parser, arguments->choice);
  addShapeOptions(*parser, arguments->options);
  addValue(*parser, "--feature-angle", arguments->options.featureAngle, "ANGLE [40]",
           "Tag edges where the surface turns by more than this, in\n"
           "degrees, if they are edges of the map")
      ->check(CLI::Range(0.0, 180.0));
  addReport(*parser, arguments->report, "Write in JSON what was made, and how long each step took");
  addRunOptions(*parser, arguments->run);
  parser->footer(
      "Exit code 1: no map was found, or the part is not a solid; nothing is written.\n"
      "docs/user/making-maps.md explains what happens.\n\n"
      "Example:\n"
      "  hexhex map part.stl -o seamless.hexex\n"
      "  hexhex quantize seamless.hexex -o integer.hexex --cells 50000\n"
      "  hexhex mesh part.stl -o mesh.vtu --cells 50000     all in one go");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
