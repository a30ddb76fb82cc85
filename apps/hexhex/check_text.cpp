#include "check_text.hpp"

#include <algorithm>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "output.hpp"

namespace hexhex::command {
namespace {

using Json = nlohmann::ordered_json;

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
  fmt::print("The map is not valid:\n");
  for (const Defect& defect : report.defects) {
    fmt::print("  {}, {}: {}\n", name(defect.code),
               defect.count == 1 ? "once" : fmt::format("{} times", defect.count), defect.sentence);
    for (const Defect::Occurrence& occurrence : defect.worst) {
      fmt::print("    {:<20} {:.6g}\n", toString(occurrence.place), occurrence.amount);
    }
  }
}

Json valencesAsJson(const std::map<int, std::uint64_t>& countByValence) {
  Json object = Json::object();
  for (const auto& [valence, count] : countByValence) object[std::to_string(valence)] = count;
  return object;
}

Json expectationAsJson(const Expectation& expected) {
  return {{"cells", expected.cells},
          {"boundary_quads", expected.boundaryQuads},
          {"inner_singular_edges", valencesAsJson(expected.innerSingularEdges)},
          {"boundary_singular_edges", valencesAsJson(expected.boundarySingularEdges)},
          {"euler_characteristic", expected.eulerCharacteristic},
          {"components", expected.components},
          {"boundary_components", expected.boundaryComponents}};
}

Json defectsAsJson(const std::vector<Defect>& defects) {
  Json list = Json::array();
  for (const Defect& defect : defects) {
    Json worst = Json::array();
    for (const Defect::Occurrence& occurrence : defect.worst) {
      worst.push_back({{"place", toString(occurrence.place)}, {"amount", occurrence.amount}});
    }
    list.push_back({{"code", name(defect.code)},
                    {"sentence", defect.sentence},
                    {"count", defect.count},
                    {"worst", std::move(worst)}});
  }
  return list;
}

}  // namespace

void printExpectation(const Expectation& expected) {
  printLine("cells", std::to_string(expected.cells));
  printLine("boundary quads", std::to_string(expected.boundaryQuads));
  printLine("inner singular edges", valencesAsText(expected.innerSingularEdges));
  printLine("boundary singular edges", valencesAsText(expected.boundarySingularEdges));
  printLine("Euler characteristic", std::to_string(expected.eulerCharacteristic));
  printLine("components", std::to_string(expected.components));
  printLine("boundary components", std::to_string(expected.boundaryComponents));
}

void printCheck(const CheckReport& report, int scale) {
  printMap(report);
  if (!report.valid()) {
    printDefects(report);
    return;
  }
  fmt::print("Mesh to expect at scale {}\n", scale);
  printExpectation(report.expected);
  fmt::print("The map is valid.\n");
}

std::string checkAsJson(const CheckReport& report, int scale, const std::string& kind) {
  const Json json = {
      {"valid", report.valid()},
      {"kind", kind},
      {"points", report.points},
      {"tets", report.tets},
      {"edges", report.edges},
      {"faces", report.faces},
      {"inner_faces", report.innerFaces},
      {"boundary_faces", report.boundaryFaces},
      {"chart_jumps", report.chartJumps},
      {"isolated_vertices", report.isolatedVertices},
      {"tets_inverted_in_space", report.tetsInvertedInSpace},
      {"mirrored", report.mirrored},
      {"corners_reversed", report.cornersReversed},
      {"max_transition_residual", report.maxTransitionResidual},
      {"max_displacement", report.maxDisplacement},
      {"inner_singular_tet_edges", valencesAsJson(report.innerSingularTetEdges)},
      {"boundary_singular_tet_edges", valencesAsJson(report.boundarySingularTetEdges)},
      {"singular_nodes", report.singularNodes},
      {"boundary_genus", report.boundaryGenus},
      {"defects", defectsAsJson(report.defects)},
      {"scale", scale},
      {"expected", report.valid() ? expectationAsJson(report.expected) : Json(nullptr)}};
  return json.dump(2) + "\n";
}

}  // namespace hexhex::command
