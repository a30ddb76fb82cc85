// `hexhex improve`: improves the quality of a mesh.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <hexhex/curved.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/io.hpp>

#include "command.hpp"
#include "expected_words.hpp"
#include "improve_options.hpp"
#include "json.hpp"
#include "long_run.hpp"
#include "output.hpp"
#include "patch_names.hpp"
#include "shared_options.hpp"
#include "view_page.hpp"

namespace hexhex::command {
namespace {

struct ImproveArguments {
  std::string mesh;
  std::string output;
  std::string map;
  std::string surface;
  std::string page;  ///< empty: none
  OutputChoice choice;
  std::string report;
  PatchAngle patchAngle;
  PatchNames names;
  ImproveOptions options;
  RunOptions run;
  bool hexesOnly = false;
};

/// @param mesh  straight or curved
ImproveReport improveMesh(const ImproveArguments& arguments, auto& mesh, LongRun& longRun) {
  Context& context = longRun.context();
  if (!arguments.surface.empty()) {
    const TriangleMesh surface =
        longRun.part("reading", [&] { return readSurfaceOf(arguments.surface, context); });
    return longRun.part("improvement",
                        [&] { return improve(mesh, surface, arguments.options, context); });
  }
  if (arguments.map.empty()) {
    return longRun.part("improvement", [&] { return improve(mesh, arguments.options, context); });
  }
  const TetMap map = longRun.part("reading", [&] { return readMap(arguments.map, {}, context); });
  return longRun.part("improvement",
                      [&] { return improve(mesh, map, arguments.options, context); });
}

/// Improves and writes a mesh, and a page that shows it before and after.
/// @param mesh  straight or curved
ImproveReport improveAndWrite(const ImproveArguments& arguments, auto mesh, LongRun& longRun) {
  Context& context = longRun.context();
  Array<Vec3> before = arguments.page.empty() ? Array<Vec3>() : mesh.points;
  ImproveReport report = improveMesh(arguments, mesh, longRun);
  before = pointsBefore(std::move(before), report);
  WriteOptions writing = arguments.choice.options();
  writing.scaledJacobians = report.after.scaledJacobians;
  writing.patchAngle = arguments.patchAngle.degrees;
  longRun.part("writing",
               [&] { writeNamed(arguments.names, mesh, arguments.output, writing, context); });
  arguments.names.warnOfAngle(arguments.patchAngle, mesh, arguments.output, writing, context);
  if (arguments.page.empty()) return report;
  ViewOptions options;
  options.scaledJacobians = report.after.scaledJacobians;
  options.pointsBefore = before;
  longRun.part("page",
               [&] { writePage(mesh, arguments.page, arguments.output, options, context); });
  return report;
}

HexMesh readStraight(const ImproveArguments& arguments, Context& context) {
  std::vector<CellCount> counts;
  HexMesh mesh = readHexMesh(arguments.mesh,
                             {.hexesOnly = arguments.hexesOnly, .cellCounts = &counts}, context);
  if (arguments.hexesOnly) warnOfOtherCells(counts);
  return mesh;
}

/// Checks that the output can be written. @return whether the mesh is curved
bool requireFormats(const ImproveArguments& arguments, Context& context) {
  if (!holdsLagrangeCells(arguments.mesh, context)) {
    requireHexMeshFormat(arguments.output, arguments.choice.options());
    return false;
  }
  arguments.choice.requireForCurved(arguments.output);
  return true;
}

int run(const ImproveArguments& arguments) {
  requireAllDifferent({arguments.mesh, arguments.map, arguments.surface, arguments.names.file()},
                      {arguments.output, arguments.report, arguments.page});
  LongRun longRun(arguments.run, {{"readHexMesh", 1},
                                  {"readLagrangeMesh", 1},
                                  {"readMap", 0.5},
                                  {"certify", 0.2},
                                  {"improve", 20},
                                  {"writeHexMesh", 0.5},
                                  {"writeLagrangeMesh", 1},
                                  {"writeViewPage", 1}});
  const bool isCurved = requireFormats(arguments, longRun.context());
  requireWritable(arguments.output);
  requirePage(arguments.page);
  Report reportFile(arguments.report);
  Context& context = longRun.context();
  const auto reading = [&](const auto& read) { return longRun.part("reading", read); };
  const ImproveReport report =
      isCurved ? improveAndWrite(arguments,
                                 reading([&] { return readLagrangeMesh(arguments.mesh, context); }),
                                 longRun)
               : improveAndWrite(
                     arguments, reading([&] { return readStraight(arguments, context); }), longRun);
  longRun.finish();
  if (reportFile.isWanted()) reportFile.write(jsonText(improvementAsJson(report)));
  if (arguments.run.quiet || reportFile.isOnOutput()) return kSuccess;
  printFiles(arguments.mesh, arguments.output);
  if (!arguments.page.empty()) printLine("page", arguments.page);
  printImprovement(report);
  return kSuccess;
}

}  // namespace

Command addImprove(CLI::App& app) {
  const auto arguments = std::make_shared<ImproveArguments>();
  CLI::App* const parser =
      app.add_subcommand("improve", "Make all cells of a mesh positive, and better");
  addValue(*parser, "MESH", arguments->mesh, "FILE REQUIRED",
           "The mesh, in any format that is read")
      ->required();
  addMeshOutput(*parser, arguments->output);
  CLI::Option* const map = addValue(*parser, "--map", arguments->map, "FILE",
                                    "The map that the mesh was extracted from, whose surface\n"
                                    "vertices stay on; MESH is then .vtu, .ovm or .ovmb, which\n"
                                    "say where vertices lie. Otherwise they stay on the boundary\n"
                                    "of the mesh");
  addValue(*parser, "--surface", arguments->surface, "FILE",
           "The surface that the boundary of the mesh approximates,\n"
           "triangles (" +
               extensionsThat(&FileFormat::readsSurfaces) +
               ")\n"
               "or the boundary of tets. Vertices are pulled onto it; edges\n"
               "beyond --feature-angle are kept")
      ->excludes(map);
  addImproveOptions(*parser, arguments->options);
  addHexesOnly(*parser, arguments->hexesOnly);
  addMeshChoice(*parser, arguments->choice, arguments->output);
  addPatchAngle(*parser, arguments->patchAngle);
  addPatchNames(*parser, arguments->names);
  addReport(*parser, arguments->report,
            "Write in JSON: quality and certificates before and after,\n"
            "distances to the surface, how far vertices moved");
  addPage(*parser, arguments->page,
          "Write a page that shows the mesh in any browser, before\nand after");
  addRunOptions(*parser, arguments->run);
  parser->footer(
      "Cells that are not positive come first, then those below --target, then all. Vertices on "
      "the\n"
      "surface slide on it. If cells remain that are not positive, the mesh is written with a\n"
      "warning; --report lists them. docs/user/improve.md explains what happens.\n\nExample:\n"
      "  hexhex improve mesh.vtu --map map.hexex -o better.vtu\n"
      "  hexhex extract map.hexex -o better.vtu --improve     in one go");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
