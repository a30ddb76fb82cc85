#include <algorithm>
#include <utility>

#include <hexhex/partial.hpp>
#include <hexhex/repair.hpp>

#include "options.hpp"

using hexhex::Error;
using hexhex::ErrorCode;

int hexhex_can_repair(void) { return hexhex::canRepair() ? 1 : 0; }

hexhex_status hexhex_repair(const hexhex_map* map, const hexhex_repair_options* options,
                            hexhex_context* context, hexhex_map** repaired,
                            hexhex_repair_report** report, hexhex_error* error) {
  using namespace hexhex::c;
  if (report != nullptr) *report = nullptr;
  return guarded(error, [&] {
    require(repaired, "repaired");
    const Used given(map, "map");
    const hexhex_repair_options o = readStruct(options, HEXHEX_REPAIR_OPTIONS_INIT, "options");
    ContextOrDefault used(context);
    auto made = std::make_unique<hexhex_repair_report>();
    const auto run = [&] {
      return hexhex::repair(given->owned ? *given->owned : copyOf(*given),
                            {.tolerance = o.tolerance,
                             .scale = o.scale,
                             .round = o.round != 0,
                             .refine = o.refine != 0},
                            *used, &made->report);
    };
    try {
      give(run(), repaired);
    } catch (const Error& failure) {
      const bool worked = failure.code() != ErrorCode::InvalidArgument;
      if (report != nullptr && worked) *report = enter(std::move(made));
      throw;
    }
    if (report != nullptr) *report = enter(std::move(made));
  });
}

void hexhex_repair_report_destroy(hexhex_repair_report* report) { hexhex::c::destroy(report); }

hexhex_status hexhex_repair_get_summary(const hexhex_repair_report* report,
                                        hexhex_repair_summary* summary, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(report, "report");
    const hexhex::RepairReport& r = used->report;
    const hexhex_repair_summary result = {.size = sizeof(hexhex_repair_summary),
                                          .changed = r.changed ? 1 : 0,
                                          .region_count = r.regions.size(),
                                          .bad_tets = r.badTets,
                                          .moved_vertices = r.movedVertices,
                                          .largest_move = r.largestMove,
                                          .split_edges = r.splitEdges,
                                          .added_tets = r.addedTets,
                                          .rounded_vertices = r.roundedVertices,
                                          .seconds = r.seconds};
    writeStruct(result, require(summary, "summary"), "summary");
  });
}

hexhex_status hexhex_repair_get_region(const hexhex_repair_report* report, size_t number,
                                       hexhex_repaired_region* region, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(report, "report");
    const hexhex::RepairedRegion& r = at(used->report.regions, number, "regions");
    hexhex_repaired_region result = HEXHEX_REPAIRED_REGION_INIT;
    result.place = placeOf(r.place);
    std::copy(r.position.begin(), r.position.end(), result.position);
    result.bad_tets = r.badTets;
    result.tets = r.tets;
    result.moved_vertices = r.movedVertices;
    result.largest_move = r.largestMove;
    writeStruct(result, require(region, "region"), "region");
  });
}

namespace hexhex::c {

void giveRepair(const RepairedMap& repaired, hexhex_map** map, hexhex_repair_report** report) {
  hexhex_map* madeMap = nullptr;
  hexhex_repair_report* madeReport = nullptr;
  if (repaired.map) {
    if (report != nullptr) {
      auto made = std::make_unique<hexhex_repair_report>();
      made->report = repaired.report;
      madeReport = enter(std::move(made));
    }
    if (map != nullptr) give(repaired.map, &madeMap);
  }
  if (map != nullptr) *map = madeMap;
  if (report != nullptr) *report = madeReport;
}

}  // namespace hexhex::c

hexhex_status hexhex_mesh_get_repair(const hexhex_mesh* mesh, hexhex_map** map,
                                     hexhex_repair_report** report, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] { giveRepair(Used(mesh, "mesh")->repaired, map, report); });
}

hexhex_status hexhex_lagrange_mesh_get_repair(const hexhex_lagrange_mesh* mesh, hexhex_map** map,
                                              hexhex_repair_report** report, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] { giveRepair(Used(mesh, "mesh")->repaired, map, report); });
}

hexhex_status hexhex_context_get_repair(const hexhex_context* context, hexhex_map** map,
                                        hexhex_repair_report** report, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] { giveRepair(Used(context, "context")->repaired, map, report); });
}

hexhex_status hexhex_extract_partial(const hexhex_map* map, const hexhex_partial_options* options,
                                     hexhex_context* context, hexhex_mesh** mesh,
                                     hexhex_holes** holes, hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    require(mesh, "mesh");
    const hexhex_partial_options o = readStruct(options, HEXHEX_PARTIAL_OPTIONS_INIT, "options");
    ContextOrDefault used(context);
    hexhex::PartialMesh found = hexhex::extractPartial(
        Used(map, "map")->view, {.scale = o.scale, .tolerance = o.tolerance}, *used);
    auto made = std::make_unique<hexhex_holes>();
    made->holes = std::move(found.holes);
    made->invalidTets = found.invalidTets;
    made->missingCells = found.missingCells;
    made->faceConflicts = found.faceConflicts;
    give(std::move(found.mesh), mesh);
    if (holes != nullptr) *holes = enter(std::move(made));
  });
}

void hexhex_holes_destroy(hexhex_holes* holes) { hexhex::c::destroy(holes); }

hexhex_status hexhex_holes_get_summary(const hexhex_holes* holes, hexhex_holes_summary* summary,
                                       hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(holes, "holes");
    const hexhex_holes& h = *used;
    const hexhex_holes_summary result = {sizeof(hexhex_holes_summary), h.holes.size(),
                                         h.invalidTets, h.missingCells, h.faceConflicts};
    writeStruct(result, require(summary, "summary"), "summary");
  });
}

hexhex_status hexhex_holes_get(const hexhex_holes* holes, size_t number, hexhex_hole* hole,
                               hexhex_error* error) {
  using namespace hexhex::c;
  return guarded(error, [&] {
    const Used used(holes, "holes");
    const hexhex::Hole& h = at(used->holes, number, "holes");
    hexhex_hole result = HEXHEX_HOLE_INIT;
    result.tet = h.tet;
    result.tets = h.tets;
    result.invalid_tets = h.invalidTets;
    std::copy(h.position.begin(), h.position.end(), result.position);
    result.missing_cells = h.missingCells;
    writeStruct(result, require(hole, "hole"), "hole");
  });
}
