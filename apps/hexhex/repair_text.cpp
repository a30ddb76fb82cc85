#include "repair_text.hpp"

#include <string>

#include <fmt/core.h>

#include "json.hpp"
#include "output.hpp"

namespace hexhex::command {

std::string repairNotice(const RepairReport& report) {
  std::string text = fmt::format(
      "The map had {} in {}. It was repaired: parameters of {} were moved, by up to {:.3g}",
      counted(report.badTets, "flipped or flat tet"), counted(report.regions.size(), "place"),
      report.movedVertices == 1 ? "1 vertex" : fmt::format("{} vertices", report.movedVertices),
      report.largestMove);
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
                    region.position[2],
                    region.movedVertices == 1 ? "1 vertex"
                                              : fmt::format("{} vertices", region.movedVertices),
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
  return {{"bad_tets", report.badTets},         {"moved_vertices", report.movedVertices},
          {"largest_move", report.largestMove}, {"rounded_vertices", report.roundedVertices},
          {"split_edges", report.splitEdges},   {"added_tets", report.addedTets},
          {"seconds", report.seconds},          {"regions", std::move(regions)}};
}

}  // namespace hexhex::command
