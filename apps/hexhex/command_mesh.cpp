// `hexhex mesh`: makes a hexahedral mesh with certified cells of a part, given as tets, a surface
// or a STEP file.
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <hexhex/error.hpp>
#include <hexhex/fill.hpp>
#include <hexhex/io.hpp>
#include <hexhex/mesh.hpp>

#include "command.hpp"
#include "expected_words.hpp"
#include "extract_report.hpp"
#include "improve_options.hpp"
#include "json.hpp"
#include "long_run.hpp"
#include "output.hpp"
#include "quantize_options.hpp"
#include "shape_options.hpp"
#include "shared_options.hpp"
#include "view_page.hpp"

namespace hexhex::command {
namespace {

struct MeshArguments {
  std::string part;
  std::string output;
  std::string map;   ///< empty: not written
  std::string page;  ///< empty: none
  OutputChoice choice;
  std::string report;
  MeshOptions options;
  FillOptions fill;
  bool allowBad = false;
  RunOptions run;
};

void writeMeshPage(const MeshArguments& arguments, const MeshedPart& part, LongRun& longRun) {
  if (arguments.page.empty()) return;
  ViewOptions options;
  options.verification = &part.verification;
  options.mapName = std::filesystem::path(arguments.part).filename().string();
  options.scaledJacobians = part.improvement.after.scaledJacobians;
  longRun.part("page", [&] {
    writePage(part.mesh, arguments.page, arguments.output, options, longRun.context());
  });
}

/// The page shows the cells that are in the way.
void requireCertified(const MeshArguments& arguments, const MeshedPart& part, LongRun& longRun) {
  const Certificate& certificate = part.improvement.after;
  if (certificate.allPositive() || arguments.allowBad) return;
  tryPage([&] { writeMeshPage(arguments, part, longRun); }, longRun);
  const bool isRefuted = certificate.refuted > 0;
  throw Error(ErrorCode::NotMeshable,
              (isRefuted ? refutationAsText(certificate)
                         : counted(certificate.undecided, "cell") +
                               " could not be certified as positive.") +
                  " The mesh was not written. Try another number of cells, or a larger --slack; " +
                  (arguments.page.empty() ? "--view" : arguments.page) +
                  " shows these cells, and --allow-bad writes the mesh as it is.",
              isRefuted ? Place{PlaceKind::Cell, certificate.worst.front().cell} : Place{});
}

void writeAll(const MeshArguments& arguments, const MeshedPart& part, LongRun& longRun) {
  Context& context = longRun.context();
  if (!arguments.map.empty()) {
    longRun.part("writing", [&] { writeMap(part.map, arguments.map, {}, context); });
  }
  WriteOptions writing = arguments.choice.options();
  writing.scaledJacobians = part.improvement.after.scaledJacobians;
  longRun.part("writing", [&] { writeHexMesh(part.mesh, arguments.output, writing, context); });
  writeMeshPage(arguments, part, longRun);
}

/// Where there is no mesh, the page shows where the part is in the way.
MeshedPart meshOrShowWhy(const MeshArguments& arguments, const TetMesh& tets,
                         const MeshOptions& options, LongRun& longRun) {
  try {
    return longRun.part("meshing", [&] { return meshFromTets(tets, options, longRun.context()); });
  } catch (const Error& error) {
    writePartPage(tets, arguments.page, arguments.part, error, longRun);
    throw;
  }
}

Json reportAsJson(const MeshArguments& arguments, const MeshedPart& part, const FilledPart& filled,
                  Context& context) {
  Json json = {{"part", filledAsJson(arguments.part, filled)},
               {"mesh",
                {{"file", arguments.output},
                 {"cells", part.mesh.cells.size()},
                 {"vertices", part.mesh.points.size()}}}};
  json.update(partAsJson(part));
  json["seconds"] = secondsAsJson(context.stageTimes());
  json["peak_memory_bytes"] = peakMemory();
  return json;
}

/// Distance in diagonals beyond which a mesh lacks features of the part.
constexpr double kFar = 0.01;

void printPart(const MeshArguments& arguments, const MeshedPart& part, const FilledPart& filled,
               const LongRun& run) {
  printFiles(arguments.part, arguments.output);
  printFill(filled);
  printShape(part.shape);
  if (!part.whyThisWay.empty()) printLine("kept", part.whyThisWay);
  for (const WayReport& way : part.ways) {
    if (!way.refusal.empty()) printLine("no " + nameOf(way.method), way.refusal);
  }
  printLine("mesh", fmt::format("{} of {:.0f} asked for", counted(part.mesh.cells.size(), "cell"),
                                part.quantization.cellsWanted));
  printImprovement(part.improvement);
  if (part.tagsReleased) {
    printLine("sharp edges", "vertices left some of them: otherwise, cells would not be positive");
  }
  if (part.missingCurves > 0) {
    printLine("tagged curves",
              "no edges of the mesh follow " + counted(part.missingCurves, "piece"));
  }
  const double distance = part.improvement.distanceAfter.hausdorff();
  if (distance > kFar) {
    printWarning(fmt::format(
        "The mesh is {:.2g} of the diagonal from the part: small features of it may be lost. "
        "More --cells, finer tets, or another --seed may keep them.",
        distance));
  }
  for (const TagName& group : part.missingGroups) {
    const auto [element, kind] =
        group.dimension == 3 ? std::pair("cell", "region") : std::pair("quad", "surface");
    const std::string name =
        group.name.empty() ? std::to_string(group.tag) : "'" + group.name + "'";
    printWarning(fmt::format(
        "No {} of the mesh has the {} {}: it is too small for this number of cells. Ask for more.",
        element, kind, name));
  }
  printLine("time", run.partsAsText());
}

int run(const MeshArguments& arguments) {
  requireHexMeshFormat(arguments.output, arguments.choice.options());
  if (!arguments.map.empty()) requireMapFormat(arguments.map, WriteOptions{});
  requireAllDifferent({arguments.part},
                      {arguments.output, arguments.map, arguments.page, arguments.report});
  LongRun longRun(arguments.run, {{"readPart", 5},
                                  {"meshFromTets", 40},
                                  {"writeMap", 0.1},
                                  {"writeHexMesh", 0.3},
                                  {"writeViewPage", 0.3}});
  Context& context = longRun.context();
  requireWritable(arguments.output);
  if (!arguments.map.empty()) requireWritable(arguments.map);
  requirePage(arguments.page);
  Report reportFile(arguments.report);
  MeshOptions options = arguments.options;
  options.shape.featureAngle = options.improve.featureAngle;
  FillOptions fill = arguments.fill;
  fill.featureAngle = options.improve.featureAngle;
  fill.cells = options.quantize.cells;
  const FilledPart filled =
      longRun.part("reading", [&] { return readPart(arguments.part, fill, context); });
  const MeshedPart part = meshOrShowWhy(arguments, filled.tets, options, longRun);
  requireCertified(arguments, part, longRun);
  writeAll(arguments, part, longRun);
  longRun.finish();
  if (reportFile.isWanted()) {
    reportFile.write(jsonText(reportAsJson(arguments, part, filled, context)));
  }
  if (arguments.run.quiet || reportFile.isOnOutput()) return kSuccess;
  printPart(arguments, part, filled, longRun);
  return kSuccess;
}

void addOutputs(CLI::App& parser, MeshArguments& arguments) {
  addMeshOutput(parser, arguments.output);
  addMeshChoice(parser, arguments.choice, arguments.output);
  addValue(parser, "--keep-map", arguments.map, "FILE",
           "Write the integer-grid map, too, for `extract` and `verify`");
  addReport(parser, arguments.report,
            "Write in JSON: labels, map, quality, distances, and how\nlong each step took");
  addPage(parser, arguments.page,
          "Write a page that shows the mesh in any browser or, if\n"
          "there is none, where the part cannot be meshed");
  parser.add_flag("--allow-bad", arguments.allowBad,
                  "Write the mesh even if cells are not positive");
}

}  // namespace

Command addMesh(CLI::App& app) {
  const auto arguments = std::make_shared<MeshArguments>();
  CLI::App* const parser =
      app.add_subcommand("mesh", "Make a hexahedral mesh of a part that has no map");
  addPart(*parser, arguments->part, arguments->fill);
  addOutputs(*parser, *arguments);
  arguments->options.quantize.densify = true;
  addDensity(*parser, arguments->options.quantize);
  addShapeOptions(*parser, arguments->options.shape);
  addImproveOptions(*parser, arguments->options.improve);
  addRunOptions(*parser, arguments->run);
  parser->footer(
      "Runs map, quantize, extract, verify and improve in one go. The mesh is written only if all\n"
      "its cells are certified positive. Exit code 1: no map, or no such mesh, was found.\n"
      "docs/user/making-maps.md explains what happens.\n\n"
      "Example:\n"
      "  hexhex mesh part.stl -o mesh.vtu --cells 50000 --view mesh.html");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
