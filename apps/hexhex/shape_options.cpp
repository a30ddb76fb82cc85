#include "shape_options.hpp"

#include <map>

#include <fmt/core.h>

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

void addPart(CLI::App& parser, std::string& part) {
  parser.add_option("PART", part, "A mesh of tets, " + extensionsThat(&FileFormat::readsTets))
      ->required()
      ->option_text("FILE REQUIRED");
}

void addShapeOptions(CLI::App& parser, ShapeOptions& options) {
  std::map<std::string, ShapeMethod> methods;
  for (const auto& [name, kind] : kShapeMethods) methods.emplace(name, kind);
  parser
      .add_option("--method", options.method,
                  "How to make a map: frames (along a smooth field: good\n"
                  "cells, where there is a map), polycube (the part becomes\n"
                  "one of axis-aligned boxes), auto: what fits best")
      ->transform(CLI::CheckedTransformer(methods).description(""))
      ->option_text("NAME [auto]");
  parser
      .add_option("--seed", options.seed,
                  "Of random decisions: another one may find a map where\nthis one does not")
      ->option_text("INTEGER [1]");
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
}

}  // namespace hexhex::command
