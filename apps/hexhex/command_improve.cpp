// `hexhex improve`: a mesh whose cells are positive, and better.
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <hexhex/curved.hpp>
#include <hexhex/improve.hpp>
#include <hexhex/io.hpp>

#include "command.hpp"
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

/// Positions that a page is to show, taken before they change.
Array<Vec3> pointsForPage(const ImproveArguments& arguments, const Array<Vec3>& points) {
  return arguments.page.empty() ? Array<Vec3>() : points;
}

/// @param mesh    straight or curved
/// @param before  its points before
void writeComparison(const ImproveArguments& arguments, const auto& mesh, const Array<Vec3>& before,
                     const ImproveReport& report, LongRun& longRun) {
  if (arguments.page.empty()) return;
  ViewOptions options;
  options.scaledJacobians = report.after.scaledJacobians;
  options.pointsBefore = before;
  longRun.part("page", [&] {
    writePage(mesh, arguments.page, arguments.output, options, longRun.context());
  });
}

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

ImproveReport improveStraight(const ImproveArguments& arguments, LongRun& longRun) {
  Context& context = longRun.context();
  std::vector<CellCount> counts;
  HexMesh mesh = longRun.part("reading", [&] {
    return readHexMesh(arguments.mesh, {.hexesOnly = arguments.hexesOnly, .cellCounts = &counts},
                       context);
  });
  if (arguments.hexesOnly) warnOfOtherCells(counts);
  const Array<Vec3> before = pointsForPage(arguments, mesh.points);
  ImproveReport report = improveMesh(arguments, mesh, longRun);
  WriteOptions writing = arguments.choice.options();
  writing.scaledJacobians = report.after.scaledJacobians;
  writing.patchAngle = arguments.patchAngle.degrees;
  arguments.names.apply(mesh, writing.patchAngle, context);
  longRun.part("writing", [&] { writeHexMesh(mesh, arguments.output, writing, context); });
  arguments.names.warnOfAngle(arguments.patchAngle, mesh, arguments.output, writing, context);
  writeComparison(arguments, mesh, pointsBefore(before, report), report, longRun);
  return report;
}

ImproveReport improveCurved(const ImproveArguments& arguments, LongRun& longRun) {
  Context& context = longRun.context();
  LagrangeMesh mesh =
      longRun.part("reading", [&] { return readLagrangeMesh(arguments.mesh, context); });
  const Array<Vec3> before = pointsForPage(arguments, mesh.points);
  ImproveReport report = improveMesh(arguments, mesh, longRun);
  WriteOptions writing = arguments.choice.options();
  writing.scaledJacobians = report.after.scaledJacobians;
  writing.patchAngle = arguments.patchAngle.degrees;
  arguments.names.apply(mesh, writing.patchAngle, context);
  longRun.part("writing", [&] { writeLagrangeMesh(mesh, arguments.output, writing, context); });
  arguments.names.warnOfAngle(arguments.patchAngle, mesh, arguments.output, writing, context);
  writeComparison(arguments, mesh, before, report, longRun);
  return report;
}

/// @return whether the mesh is curved
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
  const ImproveReport report = (isCurved ? improveCurved : improveStraight)(arguments, longRun);
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
  parser->add_option("MESH", arguments->mesh, "The mesh, in any format that is read")
      ->required()
      ->option_text("FILE REQUIRED");
  addMeshOutput(*parser, arguments->output);
  CLI::Option* const map =
      parser
          ->add_option("--map", arguments->map,
                       "The map that the mesh was extracted from: its surface\n"
                       "is the one to stay on. MESH is .vtu, .ovm or .ovmb, which\n"
                       "tell where vertices lie. Else: the boundary of the mesh")
          ->option_text("FILE");
  parser
      ->add_option("--surface", arguments->surface,
                   "The surface that the boundary of the mesh approximates:\n"
                   "triangles (" +
                       extensionsThat(&FileFormat::readsSurfaces) +
                       ")\n"
                       "or tets, whose boundary it is. Vertices are pulled onto it;\n"
                       "edges beyond --feature-angle are kept")
      ->excludes(map)
      ->option_text("FILE");
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
      "surface slide on it. A mesh of which cells stay that are not positive is written, with a\n"
      "warning; --report lists them. docs/user/improve.md explains what happens.\n\nExample:\n"
      "  hexhex improve mesh.vtu --map map.hexex -o better.vtu\n"
      "  hexhex extract map.hexex -o better.vtu --improve     in one go");
  return {parser, [arguments] { return run(*arguments); }};
}

}  // namespace hexhex::command
