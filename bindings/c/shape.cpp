#include <algorithm>
#include <optional>
#include <utility>

#include <hexhex/fill.hpp>
#include <hexhex/mesh.hpp>
#include <hexhex/shape.hpp>

#include "options.hpp"

using hexhex::Error;
using hexhex::ErrorCode;

namespace {

using namespace hexhex::c;

hexhex::ShapeOptions shapeOptions(const hexhex_shape_options* options) {
  const hexhex_shape_options o = readStruct(options, HEXHEX_SHAPE_OPTIONS_INIT, "options");
  if (o.method < HEXHEX_METHOD_AUTO || o.method > HEXHEX_METHOD_FRAMES) {
    throw Error(ErrorCode::InvalidArgument, "There is no such method.");
  }
  return {.method = static_cast<hexhex::ShapeMethod>(o.method),
          .featureAngle = o.feature_angle,
          .seed = o.seed};
}

void writeReport(const hexhex::ShapeReport& r, hexhex_shape_report* out) {
  if (out == nullptr) return;
  const hexhex::LabelReport& labels = r.labels;
  hexhex_shape_report result = {.size = sizeof(hexhex_shape_report),
                                .method = static_cast<hexhex_shape_method>(r.method),
                                .rotation = {},
                                .charts = labels.charts,
                                .corners = labels.corners,
                                .bad_loops = labels.badLoops,
                                .bad_corners = labels.badCorners,
                                .opposite_edges = labels.oppositeEdges,
                                .turning_points = labels.turningPoints,
                                .wrong_turns = labels.wrongTurns,
                                .deviation = labels.deviation,
                                .label_moves = r.labelMoves,
                                .added_tets = r.addedTets,
                                .feature_edges = r.featureEdges,
                                .tagged_edges = r.taggedEdges,
                                .worst = r.distortion.worst,
                                .median = r.distortion.median,
                                .inner_faces = r.innerFaces,
                                .aligned_faces = r.alignedFaces,
                                .flat_charts = labels.flatCharts,
                                .aligned_area = r.alignedArea};
  for (std::size_t i = 0; i < 9; ++i) result.rotation[i] = r.rotation[i / 3][i % 3];
  writeStruct(result, *out, "report");
}

hexhex::FillOptions fillOptions(const hexhex_fill_options* options) {
  const hexhex_fill_options o = readStruct(options, HEXHEX_FILL_OPTIONS_INIT, "options");
  if (o.mesher < HEXHEX_MESHER_AUTO || o.mesher > HEXHEX_MESHER_TETGEN) {
    throw Error(ErrorCode::InvalidArgument, "There is no such mesher.");
  }
  return {.mesher = static_cast<hexhex::Mesher>(o.mesher),
          .tetSize = o.tet_size,
          .cells = o.cells,
          .featureAngle = o.feature_angle};
}

void writeReport(const std::optional<hexhex::FillReport>& given, hexhex_fill_report* out) {
  if (out == nullptr) return;
  const hexhex::FillReport r = given.value_or(hexhex::FillReport{});
  hexhex_fill_report result = {.size = sizeof(hexhex_fill_report),
                               .mesher = {},
                               .tet_size = r.tetSize,
                               .tets = r.tets,
                               .triangles = r.triangles,
                               .bodies = r.bodies,
                               .voids = r.voids,
                               .volume = r.volume,
                               .filled_volume = r.filledVolume,
                               .flat_triangles = r.flatTriangles};
  r.mesher.copy(result.mesher, sizeof result.mesher - 1);
  writeStruct(result, *out, "report");
}

}  // namespace

hexhex_status hexhex_map_read_part(const char* file, const hexhex_fill_options* options,
                                   hexhex_context* context, hexhex_map** map,
                                   hexhex_fill_report* report, hexhex_error* error) {
  return guarded(error, [&] {
    require(map, "map");
    const hexhex::FillOptions chosen = fillOptions(options);
    requireStruct(report, "report");
    ContextOrDefault used(context);
    hexhex::FilledPart part = hexhex::readPart(&require(file, "file"), chosen, *used);
    writeReport(part.report, report);
    give(std::move(part.tets), map);
  });
}

hexhex_status hexhex_map_from_tets(const hexhex_map_arrays* tets,
                                   const hexhex_shape_options* options, hexhex_context* context,
                                   hexhex_map** map, hexhex_shape_report* report,
                                   hexhex_error* error) {
  return guarded(error, [&] {
    require(map, "map");
    const hexhex::TetMesh mesh = tetMeshOf(tets, "tets");
    const hexhex::ShapeOptions chosen = shapeOptions(options);
    requireStruct(report, "report");
    ContextOrDefault used(context);
    hexhex::ShapedMap made = hexhex::mapFromTets(mesh, chosen, *used);
    writeReport(made.report, report);
    give(std::move(made.map), map);
  });
}

hexhex_status hexhex_mesh_from_tets(const hexhex_map_arrays* tets,
                                    const hexhex_mesh_options* options, hexhex_context* context,
                                    hexhex_mesh** mesh, hexhex_map** map,
                                    hexhex_mesh_reports* reports, hexhex_error* error) {
  return guarded(error, [&] {
    require(mesh, "mesh");
    const hexhex::TetMesh given = tetMeshOf(tets, "tets");
    const hexhex_mesh_options o =
        readStruct(&require(options, "options"), HEXHEX_MESH_OPTIONS_INIT, "options");
    const hexhex::MeshOptions chosen = {.shape = shapeOptions(o.shape),
                                        .quantize = quantizeOptions(o.quantize),
                                        .improve = o.improve == nullptr
                                                       ? hexhex::MeshOptions{}.improve
                                                       : improveOptions(o.improve)};
    hexhex_mesh_reports wanted = readStruct(reports, HEXHEX_MESH_REPORTS_INIT, "reports");
    requireStruct(wanted.shape, "reports.shape");
    requireStruct(wanted.quantization, "reports.quantization");
    requireStruct(wanted.improvement, "reports.improvement");
    ContextOrDefault used(context);
    hexhex::MeshedPart made = hexhex::meshFromTets(given, chosen, *used);
    writeReport(made.shape, wanted.shape);
    writeReport(made.quantization, wanted.quantization);
    writeReport(made.improvement, wanted.improvement);
    wanted.tags_released = made.tagsReleased ? 1 : 0;
    wanted.missing_curves = made.missingCurves;
    wanted.missing_groups = made.missingGroups.size();
    wanted.why[made.whyThisWay.copy(wanted.why, sizeof wanted.why - 1)] = 0;
    if (reports != nullptr) writeStruct(wanted, *reports, "reports");
    hexhex_map* madeMap = nullptr;
    if (map != nullptr) give(std::move(made.map), &madeMap);
    give(std::move(made.mesh), mesh);
    if (map != nullptr) *map = madeMap;
  });
}
