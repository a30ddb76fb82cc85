#include "map_text.hpp"

#include <algorithm>
#include <string>

#include <fmt/core.h>

#include "json.hpp"
#include "output.hpp"

namespace hexhex::command {
namespace {

std::string genusAsText(const std::vector<std::int64_t>& genus) {
  std::string text;
  for (const std::int64_t entry : genus) text += (text.empty() ? "" : ", ") + std::to_string(entry);
  return text.empty() ? "no boundary" : text;
}

std::string orientationAsText(const CheckReport& report) {
  std::string text =
      report.mirrored ? "reversed by the map (it will be mirrored)" : "kept by the map";
  if (report.cornersReversed) text += "; tets list their corners in negative order";
  return text;
}

}  // namespace

void printMap(const CheckReport& report) {
  fmt::print("Map\n");
  printLine("points", std::to_string(report.points));
  printLine("tets", std::to_string(report.tets));
  printLine("edges", std::to_string(report.edges));
  printLine("faces", fmt::format("{} ({} inner, {} boundary)", report.faces, report.innerFaces,
                                 report.boundaryFaces));
  printLine("chart jumps",
            fmt::format("{} of {} inner faces", report.chartJumps, report.innerFaces));
  printLine("orientation", orientationAsText(report));
  printLine("genus of the boundary", genusAsText(report.boundaryGenus));
  printLine("transition residual", fmt::format("at most {:.3g}", report.maxTransitionResidual));
  printLine("displacement", fmt::format("at most {:.3g}", report.maxDisplacement));
  if (report.isolatedVertices > 0) {
    printLine("points without a tet", fmt::format("{} (ignored)", report.isolatedVertices));
  }
  if (report.tetsInvertedInSpace > 0) {
    printLine("tets inverted in space",
              fmt::format("{} (cells there may be inverted, too)", report.tetsInvertedInSpace));
  }
  fmt::print("Singular edges of the tets\n");
  printLine("inner", valencesAsText(report.innerSingularTetEdges));
  printLine("boundary", valencesAsText(report.boundarySingularTetEdges));
  printLine("singular nodes", std::to_string(report.singularNodes));
}

void printDefects(const CheckReport& report) {
  fmt::print("Defects\n");
  for (const Defect& defect : report.defects) {
    fmt::print("  {}, {}: {}\n", name(defect.code),
               defect.count == 1 ? "once" : fmt::format("{} times", defect.count), defect.sentence);
    for (const Defect::Occurrence& occurrence : defect.worst) {
      fmt::print("    {:<20} {:.6g}\n", toString(occurrence.place), occurrence.amount);
    }
  }
}

void printExpectation(const Expectation& expected) {
  printLine("cells", std::to_string(expected.cells));
  printLine("boundary quads", std::to_string(expected.boundaryQuads));
  printLine("inner singular edges", valencesAsText(expected.innerSingularEdges));
  printLine("boundary singular edges", valencesAsText(expected.boundarySingularEdges));
  printLine("Euler characteristic", std::to_string(expected.eulerCharacteristic));
  printLine("components", std::to_string(expected.components));
  printLine("boundary components", std::to_string(expected.boundaryComponents));
}

std::string repairNotice(const RepairReport& report) {
  std::string text = fmt::format(
      "The map had {} in {}. It was repaired: parameters of {} were moved, by up to {:.3g}",
      counted(report.badTets, "flipped or flat tet"), counted(report.regions.size(), "place"),
      counted(report.movedVertices, "vertex"), report.largestMove);
  if (report.roundedVertices > 0) {
    text += fmt::format(", {} of them off integers before", report.roundedVertices);
  }
  if (report.splitEdges > 0) {
    text += fmt::format(
        "; {} of the tet mesh split, which added {}",
        report.splitEdges == 1 ? "1 edge was" : fmt::format("{} edges were", report.splitEdges),
        counted(report.addedTets, "tet"));
  }
  return text + ".";
}

void printRegions(const RepairReport& report) {
  for (const RepairedRegion& region : report.regions) {
    printLine(
        toString(region.place),
        fmt::format("{} near ({:.4g}, {:.4g}, {:.4g}): {} of a patch of {} moved by up to "
                    "{:.3g}",
                    counted(region.badTets, "bad tet"), region.position[0], region.position[1],
                    region.position[2], counted(region.movedVertices, "vertex"),
                    counted(region.tets, "tet"), region.largestMove));
  }
}

Json repairAsJson(const RepairReport& report) {
  if (!report.changed) return nullptr;
  Json regions = Json::array();
  for (const RepairedRegion& region : report.regions) {
    regions.push_back({{"place", toString(region.place)},
                       {"position", region.position},
                       {"bad_tets", region.badTets},
                       {"tets", region.tets},
                       {"moved_vertices", region.movedVertices},
                       {"largest_move", region.largestMove}});
  }
  Json json = fieldsAsJson(report);
  json["regions"] = std::move(regions);
  return json;
}

}  // namespace hexhex::command
