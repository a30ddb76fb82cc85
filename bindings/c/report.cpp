#include <string>
#include <utility>

#include "handles.hpp"

namespace {

using UsedReport = hexhex::c::Used<const hexhex_check_report>;

const std::map<int, std::uint64_t>* tableOf(const UsedReport& report, hexhex_valence_table table) {
  if (!report) return nullptr;
  const hexhex::CheckReport& r = report->report;
  switch (table) {
    case HEXHEX_INNER_HEX_EDGES:
      return &r.expected.innerSingularEdges;
    case HEXHEX_BOUNDARY_HEX_EDGES:
      return &r.expected.boundarySingularEdges;
    case HEXHEX_INNER_TET_EDGES:
      return &r.innerSingularTetEdges;
    case HEXHEX_BOUNDARY_TET_EDGES:
      return &r.boundarySingularTetEdges;
  }
  return nullptr;
}

}  // namespace

hexhex_status hexhex_check(const hexhex_map* map, double tolerance, int scale,
                           hexhex_context* context, hexhex_check_report** report,
                           hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(report, "report");
    ContextOrDefault used(context);
    auto made = std::make_unique<hexhex_check_report>();
    made->report =
        hexhex::check(Used(map, "map")->view, {.tolerance = tolerance, .scale = scale}, *used);
    *report = enter(std::move(made));
  });
}

void hexhex_check_report_destroy(hexhex_check_report* report) { hexhex::c::destroy(report); }

hexhex_status hexhex_check_get_summary(const hexhex_check_report* report,
                                       hexhex_check_summary* summary, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(report, "report");
    const hexhex::CheckReport& r = used->report;
    const hexhex_check_summary result = {.size = sizeof(hexhex_check_summary),
                                         .valid = r.valid() ? 1 : 0,
                                         .defect_count = r.defects.size(),
                                         .points = r.points,
                                         .tets = r.tets,
                                         .edges = r.edges,
                                         .faces = r.faces,
                                         .boundary_faces = r.boundaryFaces,
                                         .inner_faces = r.innerFaces,
                                         .chart_jumps = r.chartJumps,
                                         .isolated_vertices = r.isolatedVertices,
                                         .tets_inverted_in_space = r.tetsInvertedInSpace,
                                         .mirrored = r.mirrored ? 1 : 0,
                                         .corners_reversed = r.cornersReversed ? 1 : 0,
                                         .max_transition_residual = r.maxTransitionResidual,
                                         .max_displacement = r.maxDisplacement,
                                         .singular_nodes = r.singularNodes,
                                         .cells = r.expected.cells,
                                         .boundary_quads = r.expected.boundaryQuads,
                                         .euler_characteristic = r.expected.eulerCharacteristic,
                                         .components = r.expected.components,
                                         .boundary_components = r.expected.boundaryComponents};
    writeStruct(result, require(summary, "summary"), "summary");
  });
}

hexhex_status hexhex_check_get_defect(const hexhex_check_report* report, size_t defect,
                                      hexhex_defect* out, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(report, "report");
    const hexhex::Defect& d = at(used->report.defects, defect, "defects");
    const hexhex_defect result = {sizeof(hexhex_defect), statusOf(d.code), d.sentence.c_str(),
                                  d.count, d.worst.size()};
    writeStruct(result, require(out, "out"), "out");
  });
}

hexhex_status hexhex_check_get_occurrence(const hexhex_check_report* report, size_t defect,
                                          size_t occurrence, hexhex_place* place, double* amount,
                                          hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(report, "report");
    const hexhex::Defect& d = at(used->report.defects, defect, "defects");
    const hexhex::Defect::Occurrence& found = at(d.worst, occurrence, "places of that defect");
    if (place != nullptr) *place = placeOf(found.place);
    if (amount != nullptr) *amount = found.amount;
  });
}

void hexhex_check_boundary_genus(const hexhex_check_report* report, size_t component,
                                 int64_t* genus) {
  if (genus == nullptr) return;
  const UsedReport used(report, std::nothrow);
  const bool known = used && component < used->report.boundaryGenus.size();
  *genus = known ? used->report.boundaryGenus[component] : -1;
}

uint64_t hexhex_check_edges_of_valence(const hexhex_check_report* report,
                                       hexhex_valence_table table, int valence) {
  const UsedReport used(report, std::nothrow);
  const auto* const edges = tableOf(used, table);
  if (edges == nullptr) return 0;
  const auto found = edges->find(valence);
  return found != edges->end() ? found->second : 0;
}

int hexhex_check_next_valence(const hexhex_check_report* report, hexhex_valence_table table,
                              int valence) {
  const UsedReport used(report, std::nothrow);
  const auto* const edges = tableOf(used, table);
  if (edges == nullptr) return -1;
  const auto next = edges->upper_bound(valence);
  return next != edges->end() ? next->first : -1;
}

hexhex_status hexhex_verify(const hexhex_map* map, const hexhex_mesh* mesh, double tolerance,
                            int scale, hexhex_context* context, hexhex_verify_report** report,
                            hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(report, "report");
    ContextOrDefault used(context);
    auto made = std::make_unique<hexhex_verify_report>();
    made->report = hexhex::verify(Used(map, "map")->view, Used(mesh, "mesh")->mesh(),
                                  {.scale = scale, .tolerance = tolerance}, *used);
    *report = enter(std::move(made));
  });
}

void hexhex_verify_report_destroy(hexhex_verify_report* report) { hexhex::c::destroy(report); }

int hexhex_verify_passed(const hexhex_verify_report* report) {
  const hexhex::c::Used used(report, std::nothrow);
  return used && used->report.passed() ? 1 : 0;
}

size_t hexhex_verify_item_count(const hexhex_verify_report* report) {
  const hexhex::c::Used used(report, std::nothrow);
  return used ? used->report.items.size() : 0;
}

hexhex_status hexhex_verify_get_item(const hexhex_verify_report* report, size_t item,
                                     hexhex_verify_item* out, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(report, "report");
    const hexhex::VerifyItem& found = at(used->report.items, item, "items");
    const hexhex_verify_item result = {sizeof(hexhex_verify_item), found.name.c_str(),
                                       found.expected.c_str(), found.found.c_str(),
                                       found.passed ? 1 : 0};
    writeStruct(result, require(out, "out"), "out");
  });
}
