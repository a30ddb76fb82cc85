#include "shape_options.hpp"

#include <map>

#include <fmt/core.h>

#include "expected_words.hpp"
#include "output.hpp"
#include "shared_options.hpp"

namespace hexhex::command {

namespace {

bool isTurned(const ShapeReport& report) { return report.rotation != ShapeReport{}.rotation; }

void printLabels(const ShapeReport& report) {
  const LabelReport& labels = report.labels;
  printLine("polycube", fmt::format("{}, {}{}{}", counted(labels.charts, "face"),
                                    counted(labels.corners, "corner"),
                                    isTurned(report) ? "; the part was turned" : "",
                                    labels.isValid() ? "" : "; labels are not quite valid"));
  printLine("faces off their axes",
            fmt::format("{:.3g} on average, as 1 minus the cosine", labels.deviation));
}

}  // namespace

void addPart(CLI::App& parser, std::string& part, FillOptions& options) {
  addValue(parser, "PART", part, "FILE REQUIRED",
           "A mesh of tets (" + extensionsThat(&FileFormat::readsTets) +
               "); or a closed surface (" + extensionsThat(&FileFormat::readsSurfaces) +
               ") or a .step file, which a mesher fills with tets")
      ->required();
  addChoice<Mesher>(parser, "--mesher", options.mesher, "NAME [auto]",
                    {{"auto", Mesher::Auto},
                     {"tetwild", Mesher::TetWild},
                     {"netgen", Mesher::Netgen},
                     {"gmsh", Mesher::Gmsh},
                     {"tetgen", Mesher::TetGen}},
                    "What fills a surface or STEP file: tetwild (pip install\n"
                    "pytetwild), netgen (netgen-mesher), gmsh, tetgen; auto: the\n"
                    "first that is installed. HEXHEX_PYTHON names the Python");
  addValue(parser, "--tet-size", options.tetSize, "LENGTH",
           "Length of the edges of these tets; by default that of the\n"
           "cells, within about 3,000 to 20,000 tets")
      ->check(CLI::PositiveNumber);
}

void addShapeOptions(CLI::App& parser, ShapeOptions& options) {
  std::map<std::string, ShapeMethod> methods;
  for (const auto& [name, kind] : kShapeMethods) methods.emplace(name, kind);
  addChoice(parser, "--method", options.method, "NAME [auto]", methods,
            "How to make the map: frames (along a smooth frame field:\n"
            "good cells, but not every field has a map), polycube\n"
            "(deforms the part into axis-aligned boxes), or auto: what\n"
            "fits best");
  addValue(parser, "--seed", options.seed, "INTEGER [1]",
           "Seed of random decisions: another one may find a map where\nthis one does not");
}

void printFill(const FilledPart& part) {
  for (const std::string& warning : part.warnings) printWarning(warning);
  if (!part.report) return;
  const FillReport& report = *part.report;
  std::string text = fmt::format("{} by {}", counted(report.tets, "tet"), report.mesher);
  if (report.bodies == 0) text += ", in millimetres";  // as meshers convert the units of STEP
  if (report.bodies > 1) text += fmt::format(", in {} bodies", report.bodies);
  if (report.voids > 0) text += fmt::format(", around {}", counted(report.voids, "void"));
  if (report.flatTriangles > 0) {
    text +=
        fmt::format(", without {} that have no area", counted(report.flatTriangles, "triangle"));
  }
  printLine("filled with", text);
}

void printShape(const ShapeReport& report) {
  printLine("map", "by " + nameOf(report.method));
  if (report.method == ShapeMethod::Polycube) printLabels(report);
  printLine("scaled Jacobian", fmt::format("{:.3f} (worst) and {:.3f} (median) of the map",
                                           report.distortion.worst, report.distortion.median));
  if (report.featureEdges > 0) {
    printLine("sharp edges", fmt::format("{} of {} are edges of the map", report.taggedEdges,
                                         report.featureEdges));
  }
  if (report.innerFaces > 0) {
    const std::uint64_t others = report.innerFaces - report.alignedFaces;
    printLine("faces inside",
              others == 0
                  ? fmt::format("all {} with a tag or between regions are planes of the map",
                                report.innerFaces)
                  : fmt::format("{} of {} with a tag or between regions are not followed ({:.3g} % "
                                "of their area): each cell is in the region of its centre",
                                others, report.innerFaces, 100 * (1 - report.alignedArea)));
  }
}

Json filledAsJson(const std::string& file, const FilledPart& part) {
  Json json = {{"file", file}, {"tets", part.tets.tets.size()}};
  if (!part.warnings.empty()) json["warnings"] = part.warnings;
  if (!part.report) return json;
  json["filled"] = fieldsAsJson(*part.report);
  return json;
}

}  // namespace hexhex::command
