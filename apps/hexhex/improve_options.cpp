#include "improve_options.hpp"

#include <algorithm>
#include <string>

#include <fmt/core.h>

#include "expected_words.hpp"
#include "extract_report.hpp"
#include "output.hpp"
#include "shared_options.hpp"

namespace hexhex::command {

std::vector<CLI::Option*> addImproveOptions(CLI::App& parser, ImproveOptions& options) {
  return {
      addValue(parser, "--target", options.target, "NUMBER [0.3]",
               "Improve cells whose scaled Jacobian is below this until\n"
               "none are left, or nothing helps; 0: only untangle")
          ->check(CLI::Range(0.0, 1.0)),
      addValue(parser, "--passes", options.passes, "N [2]",
               "Then smooth the whole mesh this many times")
          ->check(CLI::Range(0, 1000)),
      parser.add_flag("--fix-boundary", options.fixBoundary, "Do not move vertices on the surface"),
      addValue(parser, "--feature-angle", options.featureAngle, "ANGLE [40]",
               "Keep vertices on edges where the surface turns by more\n"
               "than this, in degrees, and on tagged edges")
          ->check(CLI::Range(0.0, 180.0)),
      addValue(parser, "--slack", options.slack, "NUMBER [1e-3]",
               "Where nothing else helps, let vertices without tags leave\n"
               "the surface by up to this share of the diagonal of its\n"
               "bounding box; 0: nor to bring a coarse mesh nearer")
          ->check(CLI::Range(0.0, 0.1)),
      addChoice<PillowMode>(parser, "--pillow", options.pillow,
                            options.pillow == PillowMode::Never ? "MODE [never]" : "MODE [auto]",
                            {{"auto", PillowMode::Auto},
                             {"always", PillowMode::Always},
                             {"never", PillowMode::Never}},
                            "Add a layer of cells under the boundary. auto: if that\n"
                            "leaves fewer cells that are not positive, raises the\n"
                            "minimum by at least 0.02, or is better overall"),
      parser.add_flag("--snap-curves,!--no-snap-curves", options.snapCurves,
                      "Where edges of the mesh do not follow sharp and tagged\n"
                      "edges of the object, move some onto them, with a pillow,\n"
                      "if that improves minimum, distance and curves")};
}

namespace {

/// Describes vertices that do not move at all: "8 at corners, 2 with a tag".
std::string heldAsText(const ImproveReport& report) {
  const std::uint64_t corners =
      report.vertices[3] - report.taggedVertices - report.boundaryVertices - report.pairedVertices;
  std::string text;
  const auto add = [&](std::uint64_t count, const char* why) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, why);
  };
  add(corners, "at corners");
  add(report.taggedVertices, "with a tag");
  add(report.boundaryVertices, "on the boundary");
  add(report.pairedVertices, "of cells that cannot be positive");
  return text;
}

/// Describes the worst cell: "cell 812 at vertex 93: a corner of the object, of 15 degrees".
std::string worstAsText(const WorstCell& worst) {
  const auto holder = [&]() -> std::string {
    switch (worst.holder) {
      case CellHolder::Surface:
        return "two of its faces are on the surface";
      case CellHolder::Curve:
        return worst.isTagged ? "a tagged edge" : "an edge of the object";
      case CellHolder::Corner:
        return worst.isTagged ? "a tagged vertex" : "a corner of the object";
      case CellHolder::Held:
        return "a vertex that is held";
      case CellHolder::SharedFaces:
        return "another cell shares two of its faces";
      default:
        return "its neighbours";
    }
  };
  std::string text = fmt::format("cell {} at vertex {}: {}", worst.cell, worst.vertex, holder());
  if (worst.angle > 0) text += fmt::format(", {:.3g} degrees between them", worst.angle);
  return text;
}

/// Warns of possibly unwanted effects.
void warnOfImprovement(const ImproveReport& report) {
  // Tolerate rounding errors.
  const double limit = 1.00001 * std::max(report.distanceBefore.hausdorff(), kSurfaceTolerance);
  if (report.distanceAfter.hausdorff() > limit) {
    printWarning(
        "The mesh is farther from the surface than before, where cells could not be good nearer to "
        "it; "
        "--report lists what is far from it.");
  }
  const double mean = report.before.quality.mean;
  if (report.addedCells == 0 && report.after.quality.mean < mean - 1e-6) {
    printWarning(fmt::format(
        "The mean scaled Jacobian fell from {:.4g} to {:.4g}: some cells got worse so that those "
        "below "
        "--target could improve, or the mesh could come nearer to the surface. Only cells beside "
        "untangled ones fell below --target.",
        mean, report.after.quality.mean));
  }
  if (report.notPositive.empty()) return;
  printWarning(refutationAsText(report.after));
  if (!report.cannotBePositive.empty()) {
    printWarning(fmt::format(
        "{} cannot be made positive: each shares two faces that meet at an edge with another cell, "
        "such as cell {}, and wherever the vertices are, one of the two is not positive. Merge "
        "them, or mesh that place again.",
        counted(report.cannotBePositive.size(), "cell"), report.cannotBePositive.front()));
    if (report.cannotBePositive.size() == report.notPositive.size()) return;
  }
  if (report.vertices[2] + report.vertices[3] > 0) {
    printWarning(
        "Vertices were kept on curves and at corners. Where these are not features of the object, "
        "--feature-angle 180 ignores those found by angle, and a larger --slack lets vertices "
        "leave the surface farther.");
  }
}

}  // namespace

Array<Vec3> pointsBefore(Array<Vec3> points, const ImproveReport& report) {
  if (!points.empty()) {
    points.insert(points.end(), report.addedPoints.begin(), report.addedPoints.end());
  }
  return points;
}

void printImprovement(const ImproveReport& report) {
  const std::uint64_t bad = report.before.refuted + report.before.undecided;
  const std::uint64_t left = report.notPositive.size();
  printLine("untangled", bad == 0 ? "all cells were positive"
                                  : fmt::format("{} of {} that were not positive", bad - left,
                                                counted(bad, "cell")));
  printLine("scaled Jacobian before",
            fmt::format("at least {:.4g}, {:.4g} on average", report.before.quality.minimum,
                        report.before.quality.mean));
  printQuality(report.after);
  constexpr double kPerfect = 0.99995;  // printed as 1
  if (report.after.quality.minimum < kPerfect) {
    printLine("worst held by", worstAsText(report.worst));
  }
  if (report.addedCells > 0) {
    printLine("pillow",
              fmt::format("{} added under the boundary, {} in all",
                          counted(report.addedCells, "cell"), report.after.validity.size()));
  }
  printLine("moved",
            fmt::format("{} vertices, by {:.2g} of the diagonal on average, at most {:.2g}",
                        report.movedVertices, report.meanMove, report.largestMove));
  const auto& [free, onPatches, onCurves, held] = report.vertices;
  printLine("vertices", fmt::format("{} free, {} on the surface, {} on curves, {} held", free,
                                    onPatches, onCurves, held) +
                            (held > 0 ? ": " + heldAsText(report) : ""));
  printLine(
      "distance to the surface",
      fmt::format("{:.2g} of the diagonal ({:.2g} from it to the mesh); before {:.2g} ({:.2g})",
                  report.distanceAfter.fromMesh, report.distanceAfter.fromSurface,
                  report.distanceBefore.fromMesh, report.distanceBefore.fromSurface));
  if (report.curveLength > 0) {
    printLine("curves", fmt::format("edges of the mesh follow {:.3g} % of {:.3g} diagonals of the "
                                    "object's curves",
                                    100 * report.curvesFollowed, report.curveLength));
  }
  if (report.snappedCurves > 0) {
    printLine("snapped", counted(report.snappedCurves, "piece") +
                             " of curves, onto which edges of the mesh were moved");
  }
  if (report.innerDistanceBefore > 0 || report.innerDistanceAfter > 0) {
    printLine("faces inside", fmt::format("at most {:.2g} of the diagonal off; before {:.2g}",
                                          report.innerDistanceAfter, report.innerDistanceBefore));
  }
  if (!report.farCells.empty() || report.farCellsBefore > 0) {
    printLine("far from the surface",
              fmt::format("{}, by more than {:g} of the diagonal; before {}",
                          counted(report.farCells.size(), "cell"), kSurfaceTolerance,
                          report.farCellsBefore));
  }
  if (report.offSurface > 0) {
    printLine("off the surface",
              fmt::format("{} vertices, to get nearer to it or for good cells", report.offSurface));
  }
  if (report.offCreases > 0) {
    printLine("off creases",
              fmt::format("{} vertices, where nothing else made cells good", report.offCreases));
  }
  warnOfImprovement(report);
}

}  // namespace hexhex::command
